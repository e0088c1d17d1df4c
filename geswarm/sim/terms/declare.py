"""How components are declared: decorators that say what a function is for, see `component`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from string import Formatter
from typing import Any

from geswarm.rules.arguments import Argument, Choice, Number, Whole
from geswarm.rules.declarations import BehaviourName, InternalStateName, PreconditionName
from geswarm.rules.model import Value
from geswarm.sim.terms.component import (
    Behaviour,
    CellMeasure,
    Component,
    Effect,
    Function,
    Measure,
    Percept,
    PlacesMeasure,
    Register,
    Sensor,
    Steering,
    Sum,
    SwarmMeasure,
    Update,
)


def sensor(values: int = 2, fails: str | None = None) -> Callable[[Function], Sensor]:
    """The function returns a reading, see `Sensor`."""
    if not isinstance(values, int):
        raise ValueError(f"expected a whole number of values, got {values!r}")
    return lambda function: Sensor(function, values=values, fails=fails)


def percept(
    name: str,
    of: Sensor,
    *arguments: Argument,
    holds: str = "",
    fails: str = "",
    truth: Callable[..., bool] | None = None,
    chance: Callable[..., float] | None = None,
    names: Sequence[str] = (),
) -> Percept:
    """What rules call a sensor's reading.

    Args:
        name: As rules write it, `IS_CLOSE_TO`.
        of: The sensor.
        *arguments: What is written in parentheses.
        holds: Phrase for a percept that is true, `close to {k} robots`, or that is compared, `with
            {comparison} {value} robots near`.
        fails: Phrase for one that is false.
        truth: Makes it true or false of a reading and the arguments; None compares the reading.
        chance: Instead, makes of them the probability that it is true; each rule draws it anew.
        names: What the readings are called, if they are no numbers.
    """
    _require_words(name, arguments, (holds, fails))
    said = truth or chance
    if truth and chance:
        raise ValueError(f"{name}: expected truth or chance, got both")
    if of.values == 2 and said is None and not names and not arguments:
        word = PreconditionName(name, holds or name, fails or f"not {name}")
        return Percept(word, of, bool)
    holds = holds or (
        name if said else f"{{value}} {name}" if names else f"{name} {{comparison}} {{value}}"
    )
    fails = fails or f"not {holds}"
    word = PreconditionName(name, holds, fails, of.name, arguments, truth, chance)
    return Percept(word, of, names.__getitem__ if names else int)


def _require_words(name: object, arguments: Sequence[Any], phrases: Sequence[object]) -> None:
    """Names, arguments and phrases are what they should be.

    Raises:
        ValueError: They are not.
    """
    for each in arguments:
        if not isinstance(each, Whole | Number | Choice):
            raise ValueError(f"{name}: expected arguments Whole, Number or Choice, got {each!r}")
    known = [*(each.name for each in arguments), "comparison", "value"]
    for phrase in (name, *phrases):
        if not isinstance(phrase, str):
            raise ValueError(f"{name}: expected a text, got {phrase!r}")
        try:
            filled_in = [part[1] for part in Formatter().parse(phrase) if part[1] is not None]
        except ValueError as error:
            raise ValueError(f"{name}: {phrase!r}: {error}") from error
        if unknown := [each for each in filled_in if each not in known]:
            raise ValueError(
                f"{name}: {phrase!r}: expected one of {', '.join(known)} in braces, "
                f"got {unknown[0]!r}"
            )


def register(
    name: str,
    values: Sequence[Value] = (False, True),
    initially: Value | None = None,
    momentary: bool = False,
    readable: bool = True,
    on: str = "",
    off: str = "",
) -> Register:
    """An internal state of a robot.

    Args:
        name: As rules write it, `HUNGER`.
        values: False and true, some names, or the whole numbers from 0 to at most 7: a counter.
        initially: Value at the start; the first one unless given.
        momentary: Whether it is so again after every step.
        readable: Whether rules may compare it.
        on: Phrase for setting it, `light up {value}`.
        off: Phrase for clearing it, if it is true or false.
    """
    _require_words(name, (), (on, off))
    is_flag = isinstance(values[0], bool)
    word = InternalStateName(
        name,
        on or (f"set {name}" if is_flag else f"set {name} to {{value}}"),
        (off or f"clear {name}") if is_flag else "",
        values[0] if initially is None else initially,
        momentary,
        readable,
        tuple(values),
    )
    if not readable:
        return Register(word)
    bare = Register(word)
    seen_by = Sensor(None, called=f"{bare.name}_reading", given=(bare.name,), values=2**bare.bits)
    return Register(word, seen_by)


def update(writes: Mapping[str, type], draws: tuple[str, ...] = ()) -> Callable[[Function], Update]:
    """The function returns new values of the fields in `writes`, in that order."""
    return lambda function: Update(function, writes=dict(writes), draws=draws)


def behaviour(
    word: BehaviourName | str,
    *arguments: Argument,
    doing: str = "",
    starting: str = "",
    start: Update | None = None,
    again: Component | None = None,
    paced: bool = False,
    goes_on: Update | None = None,
) -> Callable[[Function], Behaviour]:
    """The function returns a target vector, see `Behaviour`.

    Args:
        word: As rules write it, `ATTRACTION`; or all words.
        *arguments: What is written in parentheses; the function may name them.
        doing: Phrase that describes it, `going to others with gain {gain}`.
        starting: Phrase for changing to it, `go to others with gain {gain}`.
        start: What changing to it does.
        again: Whether it starts afresh by itself.
        paced: Whether the function returns its share of the highest speed, too.
        goes_on: What it notes down in each step.
    """
    if isinstance(word, str):
        _require_words(word, arguments, (doing, starting))
        plain = (
            word if not arguments else f"{word}({', '.join(f'{{{a.name}}}' for a in arguments)})"
        )
        word = BehaviourName(
            word,
            doing or f"doing {plain}",
            starting or f"start {plain}",
            start is not None,
            arguments,
        )
    words = word
    return lambda function: Behaviour(
        function, word=words, start=start, again=again, paced=paced, goes_on=goes_on
    )


def condition(function: Function) -> Component:
    """The function returns 1 if it is so, else 0."""
    return Component(function)


def steering(gain: str) -> Callable[[Function], Steering]:
    """The function returns a vector for every behaviour, see `Steering`."""
    return lambda function: Steering(function, gain=gain)


def vector_sum(output: str) -> Callable[[Function], Sum]:
    """Over the other robots: the function's weight times (dx, dy)."""
    return lambda function: Sum(function, output=output, form="vector")


def total(output: str) -> Callable[[Function], Sum]:
    """Over the other robots: the sum of the function's number."""
    return lambda function: Sum(function, output=output, form="total")


def count(output: str) -> Callable[[Function], Sum]:
    """Over the other robots: for how many the function is true."""
    return lambda function: Sum(function, output=output, form="count")


def effect(
    then: Update, nearest: str | None = None, after: Effect | None = None
) -> Callable[[Function], Effect]:
    """The function returns 1 if the effect happens, else 0; see `Effect`."""
    return lambda function: Effect(function, then=then, nearest=nearest, after=after)


def measure(
    at: Effect | str = "step", kind: type = int, unit: str = ""
) -> Callable[[Function], Measure]:
    """The function returns a number, see `Measure`."""
    return lambda function: Measure(function, at=at, kind=kind, unit=unit)


def cell_measure(cells: int, unit: str = "") -> Callable[[Function], CellMeasure]:
    """The function returns the number of a robot's cell, see `CellMeasure`."""
    return lambda function: CellMeasure(function, cells=cells, unit=unit)


def swarm_measure(
    at: str = "step", kind: type = int, unit: str = ""
) -> Callable[[Function], SwarmMeasure]:
    """The function returns a number, see `SwarmMeasure`."""
    return lambda function: SwarmMeasure(function, at=at, kind=kind, unit=unit)


def places_measure(
    unit: str = "", areas: Sequence[str] = ()
) -> Callable[[Function], PlacesMeasure]:
    """The function returns a number for each simulation, see `PlacesMeasure`."""
    return lambda function: PlacesMeasure(function, unit=unit, areas=tuple(areas))
