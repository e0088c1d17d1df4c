"""The modules of AutoMoDe (Francesca et al. 2014), for the e-puck: what it does and what it heeds.

Vectors are in the robot's own frame. `published` is 1 where modules are to do what the published
code does and 0 where they are to do what is meant.
"""

from __future__ import annotations

from geswarm.rules.arguments import Number, Whole
from geswarm.sim.bodies import E_PUCK
from geswarm.sim.kernels.single import ONE, ZERO, F, I, fma, fraction
from geswarm.sim.terms.component import Bits, Integer, Real
from geswarm.sim.terms.crowd import crowd_percepts
from geswarm.sim.terms.declare import (
    behaviour,
    cell_measure,
    effect,
    measure,
    percept,
    sensor,
    update,
)

BODY = E_PUCK
"""The robots that these terms are for."""

_AWAY, _AWAY_TO_NEIGHBOURS = F(5.0), F(6.0)
_OBSTACLE = F(0.1 * 0.1)
_ASIDE = F(1e-3)  # what is straight behind is to neither side
MOST_HEARD = 31


FLOORS = ("grey", "black", "white")
"""By reading."""


@sensor(values=3)
def floor_below(ground: Integer) -> Integer:
    """The floor as most of the last readings of three sensors have it."""
    return ground


FLOOR = percept(
    "FLOOR",
    floor_below,
    names=FLOORS,
    holds="on {value}",
    fails="on a floor that is not {value}",
)


@sensor(values=MOST_HEARD + 1)
def messages(heard: Integer) -> Integer:
    """Robots whose message arrived in this step."""
    return heard if heard < I(MOST_HEARD) else I(MOST_HEARD)


HEARD = percept("HEARD", messages, holds="hearing {comparison} {value} robots")


CROWDED, ALONE = crowd_percepts(messages, "hearing {} robots")


@update(writes={"turn_until": I})
def walk_on(step: Integer) -> Integer:
    """Turning is over."""
    return step


@update(writes={"turn_until": I, "turn_side": F}, draws=("turn_time",))
def turn_away(
    turn_time: Bits,
    turn_until: Integer,
    turn_side: Real,
    step: Integer,
    rwm: Real,
    prox_x: Real,
    prox_y: Real,
) -> tuple[Integer, Real]:
    """With an obstacle ahead: until when to turn, fewer than `rwm` steps but one, and whereto."""
    near = I(fma(prox_x, prox_x, prox_y * prox_y) >= _OBSTACLE)
    meets = I(I(near & I(prox_x >= ZERO)) & I(step >= turn_until))
    steps = I(fraction(turn_time) * rwm)
    steps = steps if steps > I(1) else I(1)
    side = ONE if prox_y < ZERO else -ONE
    until = I(I(step + I(1)) + steps)
    return until if meets != I(0) else turn_until, side if meets != I(0) else turn_side


@behaviour(
    "EXPLORATION",
    Whole("rwm", 1, 100, "steps"),
    doing="exploring, turning for up to {rwm} steps",
    starting="explore, turning for up to {rwm} steps",
    start=walk_on,
    goes_on=turn_away,
)
def exploration(turn_until: Integer, turn_side: Real, step: Integer) -> tuple[Real, Real]:
    """Straight on; turning on the spot away from what is ahead, for a random time below `rwm`."""
    turns = step < turn_until
    return -ONE if turns else ONE, _ASIDE * turn_side if turns else ZERO


@behaviour("STOP", doing="standing still", starting="stop", paced=True)
def stand() -> tuple[Real, Real, Real]:
    """Standing still."""
    return ONE, ZERO, ZERO


@behaviour("PHOTOTAXIS", doing="going to the light", starting="go to the light")
def to_the_light(light_x: Real, light_y: Real, prox_x: Real, prox_y: Real) -> tuple[Real, Real]:
    """To the light, away from obstacles."""
    return fma(-_AWAY, prox_x, light_x), fma(-_AWAY, prox_y, light_y)


@behaviour("ANTI-PHOTOTAXIS", doing="going away from the light", starting="leave the light")
def from_the_light(light_x: Real, light_y: Real, prox_x: Real, prox_y: Real) -> tuple[Real, Real]:
    """Away from the light and from obstacles."""
    return fma(-_AWAY, prox_x, -light_x), fma(-_AWAY, prox_y, -light_y)


@behaviour(
    "ATTRACTION",
    Number("att", 1.0, 5.0, 0.5),
    doing="going to the robots that it hears (gain {att})",
    starting="go to the robots that it hears (gain {att})",
)
def to_the_heard(
    att: Real, published: Real, rab_x: Real, rab_y: Real, prox_x: Real, prox_y: Real
) -> tuple[Real, Real]:
    """To the robots heard: for each message att, whole as published, / (1 + gap in cm)."""
    att = F(I(att)) if published != ZERO else att
    away = -_AWAY_TO_NEIGHBOURS
    return fma(away, prox_x, att * rab_x), fma(away, prox_y, att * rab_y)


@behaviour(
    "REPULSION",
    Number("rep", 1.0, 5.0, 0.5),
    doing="going away from the robots that it hears (gain {rep})",
    starting="go away from the robots that it hears (gain {rep})",
)
def from_the_heard(
    rep: Real, published: Real, rab_x: Real, rab_y: Real, prox_x: Real, prox_y: Real
) -> tuple[Real, Real]:
    """Away from the robots heard, for each rep / (1 + gap in cm); times rep again as published."""
    whole = F(I(rep))
    gain = -whole * whole if published != ZERO else -rep
    return fma(-_AWAY, prox_x, gain * rab_x), fma(-_AWAY, prox_y, gain * rab_y)


@update(writes={"loaded": I})
def load() -> Integer:
    """An item is on board."""
    return I(1)


@update(writes={"loaded": I})
def unload() -> Integer:
    """Nothing is on board."""
    return I(0)


@effect(then=load)
def fetch(loaded: Integer, in_food: Integer) -> Integer:
    """An item is taken where there is food, as soon as the robot is there."""
    return I(in_food & I(I(1) - loaded))


@effect(then=unload, after=fetch)
def deliver(loaded: Integer, in_nest: Integer) -> Integer:
    """The item is left in the nest, as soon as the robot is there."""
    return I(in_nest & loaded)


@measure(at=deliver, unit="items")
def delivered() -> Integer:
    """Items brought from the food to the nest."""
    return I(1)


_ROW, _CELL, _EDGE = I(10), F(0.2500001), F(1.2500005)


@cell_measure(cells=100, unit="cell-steps")
def unvisited(x: Real, y: Real) -> Integer:
    """Steps since each of 10 x 10 cells over 2.5 m was visited, summed up."""
    column, row = I((x + _EDGE) / _CELL), I((y + _EDGE) / _CELL)
    column, row = I(column if column < _ROW else I(9)), I(row if row < _ROW else I(9))
    return I(column * _ROW + row)
