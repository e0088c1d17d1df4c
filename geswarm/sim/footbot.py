"""The foot-bot as ARGoS models it (paper, section 3.1.1): the constants that no scenario changes."""

RADIUS = 0.085
"""Radius of the body (m)."""

WHEEL_BASE = 0.14
"""Distance between the wheels (m)."""

CONTROL_STEP = 0.1
"""Length of a control step (s)."""
