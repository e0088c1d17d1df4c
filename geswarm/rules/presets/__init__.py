"""Rule sets that come with GESwarm, as YAML files."""
