"""Scenarios that come with GESwarm, as YAML files."""
