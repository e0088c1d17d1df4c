"""Several people at one rule table: who is there, and what each of them does, in words."""

from __future__ import annotations

from geswarm.rules import RuleSet

from ..protocol import edits
from ..protocol import rule_requests as asked
from ..protocol.base import Request
from ..protocol.rules import ChangedMessage, PeopleMessage, Person
from ..server.channel import Channel, Client

MAX_NAME = 30

_WORDS: dict[type[Request], str] = {
    asked.Undo: "took the last change back",
    asked.Redo: "made a change again that had been taken back",
    asked.SetText: "changed the rules as text",
    asked.TakeSimplified: "simplified the rules",
    asked.BringBack: "brought back rules that were not saved",
}


class People:
    """Tells the pages of a channel about one another."""

    def __init__(self) -> None:
        self._shown: list[tuple[int, str]] = []

    def sync(self, channel: Channel) -> None:
        """Tell everybody who is there, if that has changed."""
        present = [client for client in channel.clients if client.welcome]
        shown = [(client.number, client.name) for client in present]
        if shown == self._shown:
            return
        self._shown = shown
        for you in present:
            people = tuple(Person(client.name, client is you) for client in present)
            channel.send(you, PeopleMessage(people))

    def tell_others(self, channel: Channel, who: Client, what: str) -> None:
        """Tell all others what somebody has done; if they cannot keep up, the newest alone."""
        for client in channel.clients:
            if client.welcome and client is not who:
                channel.send(client, ChangedMessage(who.name, what), live=True)


def one_line(name: str) -> str:
    """A name as it was typed, without what is not seen."""
    visible = "".join(char if char.isprintable() else " " for char in name)
    return " ".join(visible.split())[:MAX_NAME]


def change_words(message: Request, before: RuleSet, after: RuleSet) -> str:
    """What a message did to the rules, after a name: `changed R3: p = 0.5, RANDOM_WALK`.

    Args:
        message: What a page asked for; it was done.
        before: The rules as they were.
        after: The rules as they are now.
    """
    if isinstance(message, asked.MakeEdit):
        return _edit_words(message.edit, before, after)
    return _WORDS.get(type(message)) or f"loaded {after.name or 'other rules'}"


def _edit_words(edit: edits.AnyEdit, before: RuleSet, after: RuleSet) -> str:
    if isinstance(edit, edits.SetName):
        return f"called the rules {after.name}" if after.name else "took the name away"
    rule = f"R{(edit.at if isinstance(edit, edits.PlaceEdit) else edit.rule) + 1}"
    match edit:
        case edits.SetComment():
            return f"explained {rule}"
        case edits.SetEnabled(enabled=enabled):
            return f"switched {rule} {'on' if enabled else 'off'}"
        case edits.MoveRule(to=to):
            return f"moved {rule} to R{to + 1}"
        case edits.RemoveRule():
            return f"removed {rule}"
        case edits.AddElement():
            return f"added to {rule}: {_element_words(edit, after)}"
        case edits.RemoveElement():
            return f"removed from {rule}: {_element_words(edit, before)}"
        case edits.SetElement():
            return f"changed {rule}: {_element_words(edit, after)}"
        case _:  # AddRule, DuplicateRule, PasteRules
            added = len(after.rules) - len(before.rules)
            return f"added {'a rule' if added == 1 else f'{added} rules'} at {rule}"


def _element_words(edit: edits.ElementEdit, rule_set: RuleSet) -> str:
    elements = getattr(rule_set.rules[edit.rule], edit.part)
    return str(elements[edit.at])
