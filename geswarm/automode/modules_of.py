"""Which modules a controller uses, and what rules call them."""

from __future__ import annotations

from collections.abc import Iterator

from geswarm.automode.machine import Machine
from geswarm.automode.modules import BEHAVIOURS, CONDITIONS, FIXED, Behaviour, Condition
from geswarm.automode.text import Controller
from geswarm.automode.tree import Action, Check, Node


def modules_of(controller: Controller) -> Iterator[Behaviour | Condition]:
    """Every behaviour and condition, in order, as often as it is there."""
    if isinstance(controller, Machine):
        for state in controller.states:
            yield state.behaviour
            yield from (each.condition for each in state.transitions)
    else:
        yield from _in(controller.root)


def _in(node: Node) -> Iterator[Behaviour | Condition]:
    if isinstance(node, Action):
        yield node.behaviour
    elif isinstance(node, Check):
        yield node.condition
    else:
        for each in node.children:
            yield from _in(each)


def terms_of(controller: Controller) -> frozenset[str]:
    """The names of what a controller does and looks at, as rules have them."""
    found = set()
    for each in modules_of(controller):
        if isinstance(each, Behaviour):
            found.add(each.module.term)
        elif each.number != FIXED:
            found.add(each.module.term or "FLOOR")
    return frozenset(found | ({"STOP"} if not isinstance(controller, Machine) else set()))


def foreign_modules(controller: Controller) -> tuple[str, ...]:
    """The names of those that only trees have, each once."""
    known = {True: BEHAVIOURS, False: CONDITIONS}
    names = (
        each.module.name
        for each in modules_of(controller)
        if each.number not in known[isinstance(each, Behaviour)]
    )
    return tuple(dict.fromkeys(names))
