"""GESwarm: evolve, read and change the rules of a robot swarm (Ferrante et al., GECCO 2013)."""

__version__ = "0.1.0"
