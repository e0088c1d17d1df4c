"""A state machine as a Mermaid state diagram, as GitHub and many editors show it in Markdown."""

from __future__ import annotations

import json
from collections.abc import Iterator

from geswarm.exports.colours import behaviour_colours, css
from geswarm.exports.layout import label_lines
from geswarm.rules.model import RuleSet
from geswarm.rules.state_machine import StateMachine
from geswarm.rules.vocabulary import FORAGING, Vocabulary

_MEANING = {character: f"#{ord(character)};" for character in '#;:<>&"'} | {" ": "\u00a0"}

_IN_TITLES = str.maketrans("<>&", "‹›＆")  # Mermaid takes markup out of titles, with no escape


def format_mermaid(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> str:
    """The state machine of a rule set as Mermaid text.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    return "\n".join(_lines(StateMachine.of(rule_set, vocabulary))) + "\n"


def _lines(machine: StateMachine) -> Iterator[str]:
    if machine.name:
        title = json.dumps(machine.name.translate(_IN_TITLES), ensure_ascii=False)
        yield from ("---", f"title: {title}", "---")
    yield "stateDiagram-v2"
    for at, state in enumerate(machine.states):
        yield f'    state "{_text(state.label)}" as s{at}'
    yield from (f"    [*] --> s{at}" for at, state in enumerate(machine.states) if state.initial)
    for (source, target), transitions in machine.between.items():
        blocks = (map(_text, label_lines(machine, entry)) for entry in transitions)
        label = "<br/><br/>".join(map("<br/>".join, blocks))
        yield f"    s{source} --> s{target} : {label}"
    for at, state in enumerate(machine.states):
        code = machine.position(state.behaviour)
        colour = css(behaviour_colours(machine.space.vocabulary)[code])
        yield f"    classDef behaviour{at} stroke:{colour},stroke-width:3px"
        yield f"    class s{at} behaviour{at}"


def _text(text: str) -> str:
    """Text without the characters that mean something to Mermaid; it is not to be wrapped."""
    return "".join(_MEANING.get(character, character) for character in text)
