"""The components that scenarios are composed of, one subject a file."""
