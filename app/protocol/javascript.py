"""The JavaScript side of messages: their types as JSDoc, and functions that make requests."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec

from geswarm.rules import Action, BehaviourChange, Precondition, Rule, StateChange, Term

from ..docstrings import explanations, summary
from .base import Message, Request
from .edits import AnyEdit, Edit, RuleElement, WholeRule
from .pages import MODULES, kinds_of

_WIDTH = 120
_PLAIN: dict[Any, str] = {
    bool: "boolean",
    int: "number",
    float: "number",
    str: "string",
}
_STANDS_FOR: dict[Any, Any] = {
    Action: BehaviourChange | StateChange,
    RuleElement: Precondition | Term | Action,
    WholeRule: Rule,
    AnyEdit: "ReturnType<typeof edits[keyof typeof edits]>",
}
"""What a type is in JavaScript, where that is something else: another type, or its words."""
_SAYS = {"rules": "the rule table page", "common": "every page"}


def written(page: str) -> str:
    """The text of `static/PAGE/protocol.js`."""
    return _Writer(page).text()


class _Writer:
    """Writes what a page knows, each type after those that name it first."""

    def __init__(self, page: str) -> None:
        self.page = page
        self.aliases = {
            value: name
            for module in MODULES[page]
            for name, value in vars(module).items()
            if get_origin(value) in (Literal, Union, UnionType) and not name.startswith("_")
        }
        self.waiting: list[type] = []
        self.named: dict[Any, str] = {}

    def text(self) -> str:
        """The whole file."""
        for kind in kinds_of(self.page, Message).values():
            self.name_of(kind)
        requests = kinds_of(self.page, Request)
        edits = kinds_of(self.page, Edit)
        makers = [self.makers("request", "Messages to Python.", requests)]
        if edits:
            makers.append(self.makers("edits", "Edits, for `request.edit`.", edits))
        types: list[str] = []
        while self.waiting:
            types.append(self.typedef(self.waiting.pop(0)))
        names = [
            f"/** @typedef {{{self.spelt(value)}}} {name} */"
            for value, name in self.named.items()
            if not isinstance(value, type) or (value in _STANDS_FOR)
        ]
        who = _SAYS.get(self.page, f"the {self.page} page")
        head = f"// What Python and {who} say to one another: written by `python -m app.protocol`."
        short = "\n".join([*names, *(one for one in types if "\n" not in one)])
        long = [one for one in types if "\n" in one]
        return "\n\n".join(filter(None, [head, short, *long, *makers])) + "\n"

    def makers(self, name: str, words: str, kinds: dict[str, type]) -> str:
        """An object with a function for each message."""
        functions = [line for kind, one in kinds.items() for line in self.maker(kind, one)]
        return "\n".join([f"/** {words} */", f"export const {name} = {{", *functions, "};"])

    def maker(self, kind: str, one: type) -> list[str]:
        """A function that makes a message."""
        notes, tag_field = explanations(one), _tag(one)[0]
        params, names = [], ""
        for name, hint, optional in _fields(one):
            shown = f"[{name}]" if optional or name == "version" else name
            params.append(f"@param {{{self.type_of(hint)}}} {shown} {notes.get(name, '')}".rstrip())
            names += f", {name}"
        comment = _comment([summary(one), "", *params] if params else [summary(one)], "  ")
        inside = f'{tag_field}: "{kind}"{names}'
        return [comment, f"  {_camel(kind)}: ({names.lstrip(', ')}) => ({{ {inside} }}),"]

    def typedef(self, one: type) -> str:
        """The type of a structure or of a dataclass."""
        fields = [(name, self.type_of(hint), hint) for name, hint, _ in _fields(one)]
        config = getattr(one, "__struct_config__", None)
        if config is not None and config.array_like:
            inside = ", ".join(spelt for _, spelt, _ in fields)
            order = f"In this order: {', '.join(name for name, *_ in fields)}."
            return _comment([summary(one), order, f"@typedef {{[{inside}]}} {one.__name__}"])
        notes = explanations(one)
        tag_field, tag = _tag(one)
        lines = [summary(one), f"@typedef {{object}} {one.__name__}"]
        if tag is not None:
            lines.append(f'@property {{"{tag}"}} {tag_field}')
        for name, spelt, hint in fields:
            shown = f"[{name}]" if msgspec.UnsetType in get_args(hint) else name
            lines.append(f"@property {{{spelt}}} {shown} {notes.get(name, '')}".rstrip())
        inside = ", ".join(f"{name}: {spelt}" for name, spelt, _ in fields)
        short = f"@typedef {{{{{inside}}}}} {one.__name__} {summary(one)}"
        plain = tag is None and not notes and len(short) < _WIDTH - len("/**  */")
        return _comment([short]) if plain else _comment(lines)

    def type_of(self, hint: Any) -> str:
        """A Python type in JSDoc's words: its name, if it has one."""
        if (alias := self.aliases.get(hint)) is not None:
            self.named.setdefault(hint, alias)
            self.spelt(hint)  # what it names has to be written, too
            return alias
        if isinstance(hint, type) and hint not in _PLAIN and get_origin(hint) is None:
            return self.name_of(hint)
        return self.spelt(hint)

    def spelt(self, hint: Any) -> str:
        """A Python type in full."""
        hint = _STANDS_FOR.get(hint, hint)
        if isinstance(hint, str):
            return hint
        if hint in _PLAIN:
            return _PLAIN[hint]
        origin, inside = get_origin(hint), get_args(hint)
        if origin is Literal:
            return " | ".join(f'"{value}"' for value in inside)
        if origin in (Union, UnionType):
            some = [one for one in inside if one not in (NoneType, msgspec.UnsetType)]
            parts = list(dict.fromkeys(self.type_of(one) for one in some))
            spelt = " | ".join(parts)
            if NoneType not in inside:
                return spelt
            return f"?{spelt}" if len(parts) == 1 else f"?({spelt})"
        if origin is dict:
            return f"Object<string, {self.type_of(inside[1])}>"
        if origin is tuple and inside[-1] is not Ellipsis:
            return f"[{', '.join(map(self.type_of, inside))}]"
        if origin is tuple:
            item = self.type_of(inside[0])
            return f"({item})[]" if " | " in item and not item.startswith("[") else f"{item}[]"
        return self.type_of(hint)

    def name_of(self, one: type) -> str:
        """The name of a structure, which is written when its turn comes."""
        if isinstance(stands_for := _STANDS_FOR.get(one), type):
            return self.name_of(stands_for)
        if one not in self.named:
            self.named[one] = one.__name__
            if one in _STANDS_FOR:
                self.spelt(one)
            else:
                self.waiting.append(one)
        return one.__name__


def _tag(one: type) -> tuple[str | None, str | int | None]:
    """Under which name a structure tells what it is, and as what."""
    config = getattr(one, "__struct_config__", None)
    return (None, None) if config is None else (config.tag_field, config.tag)


def _fields(one: type) -> Iterator[tuple[str, Any, bool]]:
    """Name, type and whether it may be left out, of each field."""
    hints = get_type_hints(one)
    if dataclasses.is_dataclass(one):
        for field in dataclasses.fields(one):
            yield field.name, hints[field.name], False
        return
    for info in msgspec.structs.fields(one):
        yield info.name, hints[info.name], not info.required


def _camel(kind: str) -> str:
    return re.sub(r"_(\w)", lambda match: match[1].upper(), kind)


def _comment(lines: list[str], indent: str = "") -> str:
    """A comment, on one line if it fits."""
    short = f"{indent}/** {' '.join(filter(None, lines))} */"
    if len(short) <= _WIDTH and not any(line.startswith("@property") for line in lines):
        return short
    inside = [f"{indent} * {line}".rstrip() for line in lines]
    return "\n".join([f"{indent}/**", *inside, f"{indent} */"])
