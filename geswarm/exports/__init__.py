"""Rule sets in the forms in which people use them elsewhere: papers, ARGoS, AutoMoDe, pictures.

>>> from geswarm.rules import load_rule_set
>>> from geswarm.exports import EXPORTS
>>> print(EXPORTS["english"](load_rule_set("hand-coded")).splitlines()[3])
R1. When away from the source and not holding an object, go to the light.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import singledispatch
from typing import Protocol

from geswarm.exports.argos_experiment import format_argos_experiment, format_floor
from geswarm.exports.argos_lua import format_argos_lua
from geswarm.exports.automode import AutoMoDe, format_automode, to_automode
from geswarm.exports.counterparts import CounterpartError
from geswarm.exports.dot import format_dot
from geswarm.exports.html import format_html
from geswarm.exports.json_document import format_json_document, machine_to_json
from geswarm.exports.latex import format_latex
from geswarm.exports.mermaid import format_mermaid
from geswarm.exports.prose import format_english, format_markdown
from geswarm.exports.svg import brief_svg, format_svg, machine_svg
from geswarm.rules import RuleSet, StateMachine
from geswarm.rules.text import format_text
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.rules.yaml_form import format_yaml


class Export(Protocol):
    """Writes a rule set that is in the words of a vocabulary."""

    def __call__(self, rule_set: RuleSet, vocabulary: Vocabulary = FORAGING, /) -> str:
        """The text."""


def _of_any(form: Callable[[RuleSet], str]) -> Export:
    """A form that shows the rules as they stand, whatever the vocabulary."""
    return lambda rule_set, _=FORAGING: form(rule_set)


EXPORTS: dict[str, Export] = {
    "yaml": _of_any(format_yaml),
    "text": _of_any(format_text),
    "json": format_json_document,
    "english": format_english,
    "markdown": _of_any(format_markdown),
    "latex": _of_any(format_latex),
    "mermaid": format_mermaid,
    "dot": format_dot,
    "svg": format_svg,
    "automode": format_automode,
}
"""Everything that needs rule set and vocabulary; `format_argos_lua` needs a scenario."""


@singledispatch
def as_html(value: object) -> str:
    """How a notebook shows a rule set (as a table) or a state machine (as a picture)."""
    raise TypeError(f"expected a rule set or a state machine, got {type(value).__name__}")


as_html.register(RuleSet, format_html)
as_html.register(StateMachine, machine_svg)

__all__ = [
    "EXPORTS",
    "AutoMoDe",
    "CounterpartError",
    "as_html",
    "brief_svg",
    "format_argos_experiment",
    "format_argos_lua",
    "format_automode",
    "format_dot",
    "format_english",
    "format_floor",
    "format_html",
    "format_json_document",
    "format_latex",
    "format_markdown",
    "format_mermaid",
    "format_svg",
    "machine_svg",
    "machine_to_json",
    "to_automode",
]
