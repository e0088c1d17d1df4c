"""AutoMoDe's neighbour counts: preconditions that hold by chance, of how many robots are near."""

from __future__ import annotations

from geswarm.automode.modules import crowded_chance
from geswarm.rules.arguments import Number, Whole
from geswarm.sim.terms.component import Percept, Sensor
from geswarm.sim.terms.declare import percept


def crowd_percepts(of: Sensor, words: str) -> tuple[Percept, Percept]:
    """`CROWDED(xi, eta)` and `ALONE(xi, eta)`.

    Args:
        of: The sensor that counts robots.
        words: The phrase for it, `with {} robots near`: many, or few.
    """
    arguments = (Whole("xi", 1, 10, "robots"), Number("eta", 0.0, 20.0, 0.5))
    many, few = (f"{words.format(which)} (xi {{xi}}, eta {{eta}})" for which in ("many", "few"))
    crowded = percept(
        "CROWDED",
        of,
        *arguments,
        chance=lambda near, xi, eta: crowded_chance(xi, eta, near),
        holds=many,
        fails=f"not {many}",
    )
    alone = percept(
        "ALONE",
        of,
        *arguments,
        chance=lambda near, xi, eta: 1.0 - crowded_chance(xi, eta, near),
        holds=few,
        fails=f"not {few}",
    )
    return crowded, alone
