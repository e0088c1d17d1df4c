"""A state machine in the DOT language, for Graphviz."""

from __future__ import annotations

from collections.abc import Iterator

from geswarm.rules.exports.svg import BEHAVIOUR_COLOURS
from geswarm.rules.model import RuleSet
from geswarm.rules.state_machine import StateMachine


def format_dot(rule_set: RuleSet) -> str:
    """The state machine of a rule set as a DOT graph.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    return "\n".join(_lines(StateMachine.of(rule_set))) + "\n"


def _lines(machine: StateMachine) -> Iterator[str]:
    yield "digraph rule_set {"
    yield f"  label={_quoted(machine.name)}; labelloc=t; rankdir=LR; nodesep=0.8; ranksep=1.6;"
    yield '  node [shape=box, style="rounded,bold", fontname="Helvetica", margin="0.25,0.12"];'
    yield '  edge [fontname="Helvetica", fontsize=10];'
    for at, state in enumerate(machine.states):
        code = machine.vocabulary.behaviour_index[state.behaviour]
        colour = BEHAVIOUR_COLOURS[code % len(BEHAVIOUR_COLOURS)]
        border = ", peripheries=2" if state.initial else ""
        yield f"  s{at} [label={_quoted(state.label)}, color={_quoted(colour)}{border}];"
    for transition in machine.transitions:
        parts = [str(transition.condition), transition.rate, *machine.effects(transition)]
        code = machine.vocabulary.behaviour_index[machine.states[transition.source].behaviour]
        colour = _quoted(BEHAVIOUR_COLOURS[code % len(BEHAVIOUR_COLOURS)])
        yield (
            f"  s{transition.source} -> s{transition.target} "
            f"[label={_quoted(*parts)}, color={colour}];"
        )
    yield "}"


def _quoted(*lines: str) -> str:
    """A DOT string of one or more centred lines."""
    escaped = (line.replace("\\", "\\\\").replace('"', '\\"') for line in lines)
    return '"' + "\\n".join(escaped) + '"'
