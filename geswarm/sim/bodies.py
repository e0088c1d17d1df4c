"""The robots that there are: what no scenario changes of them, and what it may."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from geswarm.sim import footbot


@dataclass(frozen=True)
class Body:
    """A kind of robot.

    Attributes:
        name: As scenario files write it.
        radius: Of the body (m).
        wheel_base: Distance between the wheels (m).
        is_inert: Whether it moves and senses as the e-puck of ARGoS does: wheels take time to
            reach the speed that they are given, bodies push each other, and each sensor is noisy by
            itself. Else it moves and senses as the foot-bot of the paper.
        senses: Fields of a robot that components may name, see `geswarm.sim.assembly.senses`.
        numbers: By name, what its components need; a scenario's `numbers` may say otherwise.
    """

    name: str
    radius: float
    wheel_base: float
    is_inert: bool = False
    numbers: tuple[tuple[str, float], ...] = ()
    senses: tuple[str, ...] = ()


FOOT_BOT = Body("foot-bot", footbot.RADIUS, footbot.WHEEL_BASE)
"""As the paper's section 3.1.1 has it."""

E_PUCK = Body(
    "e-puck",
    radius=0.035,
    wheel_base=0.053,
    is_inert=True,
    senses=("prox_x", "prox_y", "light_x", "light_y", "rab_x", "rab_y", "heard", "ground"),
    numbers=(
        ("wheel_noise", 0.05),  # sd, relative to the speed, of each wheel in each step
        ("acceleration", 0.0375),  # m/s in a hundredth of a second
        ("wall_friction", 0.07),
        ("body_friction", 0.49),
        ("proximity_noise", 0.05),  # readings are uniform around what they should be
        ("light_noise", 0.05),
        ("ground_noise", 0.05),
        ("rab_loss", 0.85),  # of each message, by chance
        ("published", 1.0),  # AutoMoDe's modules are as their code is, not as it is meant
        ("shadow", 0.076),  # height of a body that stands in the light (m)
    ),
)
"""With what AutoMoDe knows of it: reference model 1.2 (ARGoS 3, argos3-epuck 48)."""

BODIES: Mapping[str, Body] = {each.name: each for each in (FOOT_BOT, E_PUCK)}
