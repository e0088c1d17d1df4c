"""What the dashboard shows, without a display: session, rules being edited, background work."""
