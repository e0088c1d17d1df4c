"""Several people at one rule table: who is there, and what each of them does, in words."""

from __future__ import annotations

from geswarm.rules import RuleSet

from ..server.channel import Channel, Client, Message

MAX_NAME = 30

_WORDS = {
    "undo": "took the last change back",
    "redo": "made a change again that had been taken back",
    "set_text": "changed the rules as text",
    "take_simplified": "simplified the rules",
    "bring_back": "brought back rules that were not saved",
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
            people = [{"name": client.name, "you": client is you} for client in present]
            channel.send(you, {"type": "people", "people": people})

    def tell_others(self, channel: Channel, who: Client, what: str) -> None:
        """Tell all others what somebody has done; if they cannot keep up, the newest alone."""
        for client in channel.clients:
            if client.welcome and client is not who:
                changed = {"type": "changed", "who": who.name, "what": what}
                channel.send(client, changed, live=True)


def one_line(name: str) -> str:
    """A name as it was typed, without what is not seen."""
    visible = "".join(char if char.isprintable() else " " for char in name)
    return " ".join(visible.split())[:MAX_NAME]


def change_words(message: Message, before: RuleSet, after: RuleSet) -> str:
    """What a message did to the rules, after a name: `changed R3: p = 0.5, RANDOM_WALK`.

    Args:
        message: What a page asked for; it was done.
        before: The rules as they were.
        after: The rules as they are now.
    """
    kind = message["type"]
    if kind == "edit":
        return _edit_words(message["edit"], before, after)
    return _WORDS.get(kind) or f"loaded {after.name or 'other rules'}"


def _edit_words(edit: Message, before: RuleSet, after: RuleSet) -> str:
    if edit["do"] == "set_name":
        return f"called the rules {after.name}" if after.name else "took the name away"
    rule = f"R{edit['at' if edit['do'] in ('add_rule', 'paste_rules') else 'rule'] + 1}"
    match edit["do"]:
        case "set_comment":
            return f"explained {rule}"
        case "set_enabled":
            return f"switched {rule} {'on' if edit['enabled'] else 'off'}"
        case "move_rule":
            return f"moved {rule} to R{edit['to'] + 1}"
        case "remove_rule":
            return f"removed {rule}"
        case "add":
            return f"added to {rule}: {_element_words(edit, after)}"
        case "remove":
            return f"removed from {rule}: {_element_words(edit, before)}"
        case "set":
            return f"changed {rule}: {_element_words(edit, after)}"
        case _:  # add_rule, duplicate_rule, paste_rules
            added = len(after.rules) - len(before.rules)
            return f"added {'a rule' if added == 1 else f'{added} rules'} at {rule}"


def _element_words(edit: Message, rule_set: RuleSet) -> str:
    elements = getattr(rule_set.rules[edit["rule"]], edit["part"])
    return str(elements[edit["at"]])
