"""Controllers in words, as rows of a table."""

from __future__ import annotations

from collections.abc import Iterator

from geswarm.automode.machine import Machine
from geswarm.automode.modules import written
from geswarm.automode.text import Controller
from geswarm.automode.tree import CONTROLS, Action, Check, Node


def describe(controller: Controller) -> list[tuple[str, str, str]]:
    """Rows of three texts.

    Of a machine: state, behaviour, transitions, a line for each; of a tree: the number of a node,
    what it is, indented by its level, and what belongs to it.
    """
    if isinstance(controller, Machine):
        return list(_states(controller))
    return list(_nodes(controller.root, ""))


def _states(machine: Machine) -> Iterator[tuple[str, str, str]]:
    for number, state in enumerate(machine.states):
        lines = (f"to {each.target}: {each.condition}" for each in state.transitions)
        yield str(number), str(state.behaviour), "\n".join(lines) or "none"


def _nodes(node: Node, suffix: str) -> Iterator[tuple[str, str, str]]:
    indent = "  " * len(suffix)
    name = suffix or "root"
    if isinstance(node, Action):
        yield name, f"{indent}{node.behaviour}", f"succeeds with p {written(node.success)}"
    elif isinstance(node, Check):
        yield name, f"{indent}{node.condition}", ""
    else:
        yield name, f"{indent}{CONTROLS[node.kind]}", _children(len(node.children))
        for at, child in enumerate(node.children):
            yield from _nodes(child, f"{suffix}{at}")


def _children(count: int) -> str:
    return "1 child" if count == 1 else f"{count} children"
