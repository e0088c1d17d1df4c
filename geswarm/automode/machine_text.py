"""Machines as text: what stands behind `--fsm-config` on AutoMoDe's command line.

    --nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 0 --p0x0 0.5 --s1 1

`--s0 B` is the behaviour of the first state, `--n0` how many transitions leave it (none if it is
left out), `--n0x1 T --c0x1 C` the second of them. T counts the other states, so that it is one less
where the target comes behind the state.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from geswarm.automode.machine import MOST_STATES, MOST_TRANSITIONS, Machine, State, Transition
from geswarm.automode.modules import BEHAVIOURS, CONDITIONS, Behaviour, Condition, Module, written
from geswarm.automode.options import Options, Word

OPTION = "--fsm-config"


def machine_of(words: Sequence[Word], source: str = "") -> tuple[Machine | None, Options]:
    """Read one machine.

    Args:
        words: Of its line, without the option's name.
        source: Where they come from, for messages.

    Returns:
        The machine, None if there are errors; and the options with these.
    """
    options = Options(words, source)
    count = options.whole("--nstates", MOST_STATES, "how many states", low=1)
    if count is None:  # the rest is looked at all the same
        count = sum(options.has(f"--s{number}") for number in range(MOST_STATES))
    states = [_state(options, number, count) for number in range(count)]
    options.finish()
    if options.findings:
        return None, options
    return Machine(tuple(state for state in states if state)), options


def format_machine(machine: Machine) -> str:
    """The text of a machine, without the option's name; numbers are written as they were read."""
    words = ["--nstates", str(len(machine.states))]
    for number, state in enumerate(machine.states):
        words += _state_words(number, state)
    return " ".join(words)


def _state(options: Options, number: int, count: int) -> State | None:
    head = f"--s{number}"
    options.opens(head, (number,))
    module = options.module(head, BEHAVIOURS, (number,), "--nstates")
    behaviour = _behaviour(options, number, module)
    transitions = list(_transitions(options, number, count))
    if behaviour is None or None in transitions:
        return None
    return State(behaviour, tuple(each for each in transitions if each))


def _behaviour(options: Options, number: int, module: Module | None) -> Behaviour | None:
    names = [each.name for other in BEHAVIOURS.values() for each in other.parameters]
    if module is None:  # which of them are right cannot be told
        for name in names:
            options.ignore(f"--{name}{number}")
        return None
    for name in names:
        reason = f"--s{number} {module.number} is {module.name}, which has none"
        options.refuse(f"--{name}{number}", reason)
    given = [
        options.number(str(number), each, (number,), f"--s{number}") for each in module.parameters
    ]
    numbers = [each for each in given if each is not None]
    return Behaviour(module.number, *numbers) if len(numbers) == len(given) else None


def _transitions(options: Options, number: int, count: int) -> Iterator[Transition | None]:
    name = f"--n{number}"
    if not options.has(name):
        for at in range(MOST_TRANSITIONS):
            for kind in "ncpw":
                reason = f"expected {name}, how many transitions leave state {number}"
                options.refuse(f"--{kind}{number}x{at}", reason)
        return
    most = MOST_TRANSITIONS if count > 1 else 0
    found = options.whole(name, most, "how many transitions leave the state", (number,))
    for at in range(found or 0):
        yield _transition(options, number, at, count)
    for at in range(found or 0, MOST_TRANSITIONS + 1):
        for kind in "ncpw":
            if found is None:  # which of them are right cannot be told
                options.ignore(f"--{kind}{number}x{at}")
            options.refuse(f"--{kind}{number}x{at}", f"{name} is {found}")


def _transition(options: Options, number: int, at: int, count: int) -> Transition | None:
    path, suffix = (number, at), f"{number}x{at}"
    head = f"--n{suffix}"
    options.opens(head, path)
    target = options.whole(head, count - 2, "which of the other states", path, 0, f"--n{number}")
    module = options.module(f"--c{suffix}", CONDITIONS, path, head)
    if module is None:
        for kind in "pw":
            options.ignore(f"--{kind}{suffix}")
        return None
    if len(module.parameters) == 1:
        reason = f"--c{suffix} {module.number} is {module.name}, which has none"
        options.refuse(f"--w{suffix}", reason)
    values = [options.number(suffix, each, path, f"--c{suffix}") for each in module.parameters]
    numbers = [each for each in values if each is not None]
    if target is None or len(numbers) < len(values):
        return None
    return Transition(target + (target >= number), Condition(module.number, *numbers))


def _state_words(number: int, state: State) -> Iterator[str]:
    yield from (f"--s{number}", str(state.behaviour.number))
    if state.behaviour.parameter is not None:
        name = state.behaviour.module.parameters[0].name
        yield from (f"--{name}{number}", written(state.behaviour.parameter))
    if state.transitions:
        yield from (f"--n{number}", str(len(state.transitions)))
    for at, each in enumerate(state.transitions):
        suffix, condition = f"{number}x{at}", each.condition
        yield from (f"--n{suffix}", str(each.target - (each.target > number)))
        yield from (f"--c{suffix}", str(condition.number))
        yield from (f"--p{suffix}", written(condition.p))
        if condition.w is not None:
            yield from (f"--w{suffix}", written(condition.w))
