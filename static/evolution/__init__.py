"""The evolution page."""
