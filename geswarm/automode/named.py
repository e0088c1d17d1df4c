"""What users name to be run: rule sets, or controllers in AutoMoDe's own text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from geswarm.automode.machine import Machine
from geswarm.automode.modules_of import foreign_modules, terms_of
from geswarm.automode.options import AutoMoDeError
from geswarm.automode.text import Controller, read_controllers
from geswarm.automode.tree import Tree
from geswarm.rules.findings import Finding, Place
from geswarm.rules.library import RuleSetText, find_rule_set, form_of
from geswarm.rules.model import RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary

Runnable: TypeAlias = RuleSet | Machine | Tree


@dataclass(frozen=True)
class NamedText:
    """What was found under a name, and not yet understood."""

    name: str
    found: RuleSetText

    def read(self, vocabulary: Vocabulary = FORAGING, offered_by: str = "") -> dict[str, Runnable]:
        """The rule set, or each controller of a file: its name, `file#2` if there are several.

        Args:
            vocabulary: What it may mention.
            offered_by: The scenario whose vocabulary that is, for messages.

        Raises:
            RuleSetError: It is not a rule set; every reason is listed.
            AutoMoDeError: It is no controller, or none that runs in this scenario.
        """
        text, source = self.found.text, self.found.source
        if form_of(text, source) != "automode":
            return {self.name: self.found.read(vocabulary, offered_by)}
        controllers = read_controllers(text, source)
        several = len(controllers) > 1
        named: dict[str, Runnable] = {}
        problems = []
        for at, each in enumerate(controllers, start=1):
            mark = f"#{at}" if several else ""
            if problem := _problem(each, vocabulary, offered_by):
                problems.append(Finding(Place(f"{source}{mark}"), problem))
            named[f"{self.name}{mark}"] = each
        if problems:
            raise AutoMoDeError(problems)
        return named


def find_controllers(names: Sequence[str]) -> tuple[NamedText, ...]:
    """What users name: presets, files of rules or of AutoMoDe's text, or `-` for standard input.

    Raises:
        RuleSetNotFoundError: There is neither a preset nor a readable file of that name.
        RuleSetError: It is not text.
    """
    return tuple(NamedText(name, find_rule_set(name)) for name in names)


def _problem(controller: Controller, vocabulary: Vocabulary, offered_by: str) -> str:
    """Why a controller cannot run; empty if it can."""
    if unlike := foreign_modules(controller):
        return f"behaviour trees run with the modules of machines alone, got {', '.join(unlike)}"
    known = vocabulary.percepts.keys() | vocabulary.behaviour_names.keys()
    missing = sorted(terms_of(controller) - known)
    where = offered_by or "this scenario"
    return f"{where} does not offer {', '.join(missing)}" if missing else ""
