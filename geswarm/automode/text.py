"""Controllers as people keep them: one a line, with comments, in a file or on a command line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias, TypeVar

from geswarm.automode.machine import Machine
from geswarm.automode.machine_text import OPTION as FSM_OPTION
from geswarm.automode.machine_text import format_machine, machine_of
from geswarm.automode.options import AutoMoDeError, Options, Word, lines_of_words
from geswarm.automode.tree import Tree
from geswarm.automode.tree_text import OPTION as BT_OPTION
from geswarm.automode.tree_text import format_tree, tree_of
from geswarm.rules.findings import Finding, Place
from geswarm.rules.limits import too_long

Controller: TypeAlias = Machine | Tree

_MOST_WORDS = 1000
"""On a line: several times as many as the largest published tree has."""

_Read = TypeVar("_Read", Machine, Tree, Controller)
_Reader: TypeAlias = Callable[[Sequence[Word], str], tuple[_Read | None, Options]]


def read_machines(text: str, source: str = "") -> tuple[Machine, ...]:
    """Read finite-state machines, one a line; see `read_controllers`."""
    return _read(text, source, machine_of, "a machine such as --nstates 1 --s0 1")


def read_trees(text: str, source: str = "") -> tuple[Tree, ...]:
    """Read behaviour trees, one a line; see `read_controllers`."""
    return _read(text, source, tree_of, "a tree such as --nroot 3 --nchildroot 1 ...")


def read_controllers(text: str, source: str = "") -> tuple[Controller, ...]:
    """Read machines and behaviour trees, one a line.

    What stands on a line before `--fsm-config` or `--bt-config` is the rest of a command line and
    left out; so are comments, from `#` on, and quotes.

    Args:
        text: With or without the options' names.
        source: Where it comes from, for messages.

    Raises:
        AutoMoDeError: With everything that is wrong, each with line and column.
    """
    return _read(text, source, _controller_of, "a machine such as --nstates 1 --s0 1, or a tree")


def format_controller(controller: Controller) -> str:
    """The text of a controller with the option's name, as it stands on the command line."""
    if isinstance(controller, Machine):
        return f"{FSM_OPTION} {format_machine(controller)}"
    return f"{BT_OPTION} {format_tree(controller)}"


def _controller_of(words: Sequence[Word], source: str) -> tuple[Controller | None, Options]:
    """A tree if anything says so: its first option, or one that only trees have."""
    names = {word.text for word in words}
    return (tree_of if names & {"--nroot", "--nchildroot"} else machine_of)(words, source)


def _read(text: str, source: str, reader: _Reader[_Read], expected: str) -> tuple[_Read, ...]:
    if message := too_long(text):
        raise AutoMoDeError([Finding(Place(source), message)])
    found: list[_Read] = []
    findings: list[Finding] = []
    for words in lines_of_words(text):
        names = [word.text for word in words]
        at = max(
            (names.index(each) for each in (FSM_OPTION, BT_OPTION) if each in names), default=-1
        )
        problem = None
        if at == len(words) - 1:
            problem = f"expected {expected} behind {names[at]}, got nothing"
        elif len(words) > _MOST_WORDS:
            problem = f"expected at most {_MOST_WORDS} words for a controller, got {len(words)}"
        if problem:
            word = words[max(at, 0)]
            place = Place(source, word.line, element=f"column {word.column}")
            findings.append(Finding(place, problem))
            continue
        controller, options = reader(words[at + 1 :], source)
        findings += options.findings
        found += [] if controller is None else [controller]
    if not found and not findings:
        findings.append(Finding(Place(source), f"expected {expected}, found none"))
    if findings:
        raise AutoMoDeError(findings)
    return tuple(found)
