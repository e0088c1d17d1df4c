"""What a run has come to so far, in figures and words."""

from __future__ import annotations

from geswarm.sim import World


def score(world: World) -> list[tuple[str, str]]:
    """Name and figure of what a run is worth, and of everything that is measured in it."""
    objective = world.scenario.objective.expression
    figures = {objective: world.fitness, **world.measures}
    return [(name.replace("_", " "), figure(value)) for name, value in figures.items()]


def figure(value: float) -> str:
    """A number as people read it: whole, or with three digits."""
    if value == round(value) or abs(value) >= 1000.0:
        return f"{value:.0f}"
    return f"{value:.3g}"
