"""The foot-bot (paper, section 3.1.1) as ARGoS models it: what no scenario changes."""

RADIUS = 0.085
"""Radius of the body (m)."""

WHEEL_BASE = 0.14
"""Distance between the wheels (m)."""
