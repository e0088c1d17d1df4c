"""The commands with which a session changes its rules."""

from __future__ import annotations

from abc import ABC, abstractmethod

from geswarm.rules import (
    Finding,
    Place,
    RuleSet,
    RuleSetError,
    Vocabulary,
    load_preset,
    read_rule_set,
    simplify,
)
from geswarm.rules.names import require_known_names, unknown_terms
from geswarm.sim import Scenario

from ..protocol.edits import AnyEdit
from .document import RuleDocument
from .journal import Journal, Unsaved


class RuleCommands(ABC):
    """Changes the rules being edited.

    Attributes:
        document: The rules.
        journal: What of them would be lost in a crash.
        scenario: Where the swarm is.
    """

    scenario: Scenario
    document: RuleDocument
    journal: Journal

    @property
    @abstractmethod
    def vocabulary(self) -> Vocabulary:
        """What the rules may mention."""

    def require_offered(self, rule_set: RuleSet) -> None:
        """Raise RuleSetError if a rule set mentions what this scenario does not offer."""
        if unknown := unknown_terms(rule_set, self.vocabulary):
            names = ", ".join(unknown)
            place = Place(rule_set.name or "These rules")
            raise RuleSetError([Finding(place, f"{self.scenario.name} does not offer {names}")])
        require_known_names(rule_set, self.vocabulary)

    @abstractmethod
    def _follow_document(self) -> None:
        """Have all else follow the rules as they are now."""

    def edit(self, edit: AnyEdit) -> None:
        """Change the rules; the swarm follows them from its next step on.

        Raises:
            EditError: The edit cannot be made; nothing has changed.
        """
        self.document.edit(edit, self.vocabulary)
        self._follow_document()

    def undo(self) -> None:
        """Take the last change of the rules back."""
        self.document.undo()
        self._follow_document()

    def redo(self) -> None:
        """Make the last change taken back again."""
        self.document.redo()
        self._follow_document()

    def load(self, rule_set: RuleSet) -> None:
        """Put another rule set in the table and in the swarm; undo brings the old one back.

        Raises:
            RuleSetError: It mentions what this scenario does not offer; nothing has changed.
        """
        self.require_offered(rule_set)
        self.document.load(rule_set)
        self._follow_document()

    def load_preset(self, name: str) -> None:
        """Load a preset.

        Raises:
            RuleSetError: There is none of that name.
        """
        self.load(load_preset(name, self.vocabulary))

    def load_text(self, text: str, source: str) -> None:
        """Load YAML or the rule language.

        Raises:
            RuleSetError: It cannot be read; nothing has changed.
        """
        self.load(read_rule_set(text, source, self.vocabulary, self.scenario.name))

    def set_text(self, text: str) -> None:
        """Change the rules to what was typed in the rule language.

        Raises:
            RuleSetError: It cannot be read; nothing has changed.
        """
        self.document.replace(read_rule_set(text, "", self.vocabulary, self.scenario.name))
        self._follow_document()

    def saved(self) -> None:
        """Somebody has the rules in a file."""
        self.document.saved = self.document.rule_set
        self.journal.keep(self.document.unsaved)

    def bring_back(self, unsaved: Unsaved) -> None:
        """Put rules that a killed dashboard left in place; undo takes them out again.

        Raises:
            RuleSetError: They mention what this scenario does not offer.
        """
        self.require_offered(unsaved.rule_set)
        self.document.replace(unsaved.rule_set)
        self.journal.settle(unsaved, self.document.unsaved)
        self._follow_document()

    def simplify(self) -> None:
        """Put the shortest rules with exactly the same behaviour in place."""
        self.document.replace(simplify(self.document.rule_set, self.vocabulary).rule_set)
        self._follow_document()
