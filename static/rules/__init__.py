"""The rule table page."""
