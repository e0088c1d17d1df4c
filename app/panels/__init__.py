"""The panels around the arena and the rule table page: each is built once and kept in sync."""
