"""A state machine in the DOT language, for Graphviz."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from geswarm.exports.colours import behaviour_colours, css
from geswarm.exports.layout import Lines, label_lines
from geswarm.rules.model import RuleSet
from geswarm.rules.state_machine import StateMachine
from geswarm.rules.vocabulary import FORAGING, Vocabulary


def format_dot(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> str:
    """The state machine of a rule set as a DOT graph.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    return "\n".join(_lines(StateMachine.of(rule_set, vocabulary))) + "\n"


def _lines(machine: StateMachine) -> Iterator[str]:
    yield "digraph rule_set {"
    yield f'  label={_quoted(machine.name)}; labelloc=t; fontname="Helvetica";'
    yield "  nodesep=0.6; ranksep=0.8;"
    yield '  node [shape=box, style="rounded,bold", fontname="Helvetica", margin="0.25,0.12"];'
    yield '  edge [fontname="Helvetica", fontsize=10];'
    for at, state in enumerate(machine.states):
        code = machine.position(state.behaviour)
        colour = css(behaviour_colours(machine.space.vocabulary)[code])
        border = ", peripheries=2" if state.initial else ""
        yield f"  s{at} [label={_quoted(state.label)}, color={_quoted(colour)}{border}];"
    for (source, target), transitions in machine.between.items():
        code = machine.position(machine.states[source].behaviour)
        colour = _quoted(css(behaviour_colours(machine.space.vocabulary)[code]))
        label = _left(label_lines(machine, entry) for entry in transitions)
        yield f"  s{source} -> s{target} [label={label}, color={colour}];"
    yield "}"


def _escaped(line: str) -> str:
    return line.replace("\\", "\\\\").replace('"', '\\"')


def _quoted(line: str) -> str:
    """A DOT string."""
    return f'"{_escaped(line)}"'


def _left(blocks: Iterable[Lines]) -> str:
    """A DOT string of left-aligned lines, off the edge, with an empty one between two blocks."""
    texts = ("".join(f"  {_escaped(line)}\\l" for line in block) for block in blocks)
    return '"' + " \\l".join(texts) + '"'
