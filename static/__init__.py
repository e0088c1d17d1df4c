"""The rule table page, served by the dashboard."""
