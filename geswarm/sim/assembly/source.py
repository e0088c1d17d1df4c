"""Python source, line by line, and the names in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from geswarm.sim.assembly import ground
from geswarm.sim.kernels.single import F, I
from geswarm.sim.terms.component import OF_A_PAIR, OTHER, Component, Sum
from geswarm.sim.terms.parts import CORE, Parts, PartsError


@dataclass(frozen=True)
class Layout:
    """Which kernel is assembled of the components.

    Attributes:
        swarm: Lanes are robots of one swarm, its neighbours found by lists of pairs; else lanes are
            simulations.
        rules: Rules are interpreted one by one, and it is counted which fire; else each robot draws
            once from a control table.
        wide: The arena is so large, or a robot turns so far in a step, that single precision needs
            help: positions have a low part, and turns may be of any angle.
    """

    swarm: bool = False
    rules: bool = False
    wide: bool = False

    @property
    def name(self) -> str:
        """The layout in a word."""
        names = ("swarm" if self.swarm else "lanes", "rules" if self.rules else "table")
        return "_".join((*names, "wide") if self.wide else names)


@dataclass
class Source:
    """Lines of a kernel, and which numbers of the scenario they name.

    Attributes:
        parts: What the kernel is assembled of.
        layout: How.
        numbers: Names of the scenario's numbers that the kernel needs, in the order of their use.
    """

    parts: Parts
    layout: Layout
    lines: list[str] = field(default_factory=list)
    numbers: dict[str, None] = field(default_factory=dict)
    depth: int = 0

    def __call__(self, text: str) -> None:
        """Write lines at the present depth."""
        indent = "    " * self.depth
        self.lines += [indent + line if line else "" for line in text.strip("\n").split("\n")]

    @contextmanager
    def inside(self, head: str) -> Iterator[None]:
        """What is written within is a block under this head."""
        self(head)
        self.depth += 1
        yield
        self.depth -= 1

    @contextmanager
    def lanes(self) -> Iterator[None]:
        """What is written within is a loop over the lanes."""
        with self.inside(f"for lane in range({'LANES' if self.layout.swarm else 'width'}):"):
            yield

    def set_field(self, name: str, value: str) -> None:
        """Give a field of the robot a new value in the lanes in which it happens."""
        self(f"robot.{name}[lane] = {value} if happens != I(0) else robot.{name}[lane]")

    def number(self, name: str) -> str:
        """A number of the scenario."""
        self.numbers[name] = None
        return name

    def call(self, component: Component, **local: str) -> str:
        """A call of a component for the robot of the lane, or what stands for it.

        Args:
            component: What is called.
            **local: What some of its names mean here.
        """
        if component.function is None:
            return self._given(component)
        arguments = [
            local.get(name) or self.means(name, "robot", "lane") for name in component.needs
        ]
        return f"{component.name}({', '.join(arguments)})"

    def _given(self, component: Component) -> str:
        """What a component without a function is: its names as bits, or the only one of them."""
        first, *others = (self.means(name, "robot", "lane") for name in component.given)
        value = first
        for at, other in enumerate(others, start=1):
            value = f"I({value} | I({other} << I({at})))"
        return value

    def means(self, name: str, robot: str, lane: str) -> str:
        """What a name means: a register, a field, the step, of the arena, or a number."""
        if name == "step":
            return "I(step)"
        if name == "object_near":
            return f"work.object_near[{lane}]"
        if name in self.parts.shifts:
            (register,) = (each for each in self.parts.registers if each.name == name)
            shifted = f"I({robot}.state[{lane}] >> I({self.parts.shifts[name]}))"
            return f"I({shifted} & I({(1 << register.bits) - 1}))"
        if name in self.fields:
            return f"{robot}.{name}[{lane}]"
        of_arena = ground.expression(self, name, robot, lane)
        return self.number(name) if of_arena is None else of_arena

    @property
    def fields(self) -> frozenset[str]:
        """Fields of a robot that components may name."""
        senses = self.parts.body.senses
        return frozenset((*CORE, *self.parts.own_fields, *senses))

    def is_symmetric(self, one: Sum) -> bool:
        """Whether a sum's function names nothing that differs between the two of a pair."""
        own = [name for name in one.needs if self._is_own(name)]
        return not own and not any(name.startswith(OTHER) for name in one.needs)

    def _is_own(self, name: str) -> bool:
        """Whether a name means something else for each robot."""
        of_robot = name in self.fields or name in self.parts.shifts
        return of_robot or ground.is_name(self.parts.ground, name)

    def call_for_pair(
        self, one: Sum, there: bool, robots: tuple[str, str], lanes: tuple[str, str]
    ) -> str:
        """A call of a sum's function for the first robot of a pair, or `there` for the second.

        Raises:
            PartsError: It names what is not known of each robot while sums are made.
        """
        (mine, its), (my, its_lane) = (robots, lanes) if not there else (robots[::-1], lanes[::-1])
        arguments = []
        for name in one.needs:
            if name.removeprefix(OTHER) in ground.WRITTEN:
                raise PartsError(
                    f"{one.place}: {one.name} names {name}, which is not known of each robot of a "
                    "pair"
                )
            if name in OF_A_PAIR:
                arguments.append(f"-{name}" if there and name in ("dx", "dy") else name)
            elif name.startswith(OTHER):
                arguments.append(self.means(name[len(OTHER) :], its, its_lane))
            else:
                arguments.append(self.means(name, mine, my))
        return f"{one.name}({', '.join(arguments)})"

    @property
    def text(self) -> str:
        """All lines."""
        return "\n".join(self.lines) + "\n"


def zero(kind: type) -> str:
    """A zero of a kind of number."""
    return "ZERO" if kind is F else "I(0)"


def plus(kind: type, one: str, other: str) -> str:
    """The sum of two numbers of a kind."""
    return f"I({one} + {other})" if kind is I else f"{one} + {other}"
