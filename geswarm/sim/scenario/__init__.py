"""Scenarios: what they are, how files say it, and what is wrong with one."""
