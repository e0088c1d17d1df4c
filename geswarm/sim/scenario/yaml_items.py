"""YAML values that know where they are written, and reading them with findings."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import yaml

from geswarm.rules.findings import Place
from geswarm.rules.findings import shown as quoted
from geswarm.rules.plain_yaml import value_of
from geswarm.sim.parameter import Parameter, listed, shown


@dataclass(frozen=True)
class Item:
    """A value and where it is written: a scalar, a list of items, or items by their keys."""

    value: Any
    place: Place

    @property
    def plain(self) -> Any:
        """The value without places."""
        if isinstance(self.value, list):
            return [item.plain for item in self.value]
        if isinstance(self.value, dict):
            return {key: item.plain for key, item in self.value.items()}
        return self.value


def item_of(node: yaml.Node, place: Place) -> Item:
    """The value of a node of which `value_of` has found that it is right."""

    def at(line: int, element: str) -> Place:
        return Place(place.source, line + 1, element=element)

    if isinstance(node, yaml.SequenceNode):
        parts = [
            item_of(part, at(part.start_mark.line, f"{place.element} {number}"))
            for number, part in enumerate(node.value, start=1)
        ]
        return Item(parts, place)
    if isinstance(node, yaml.MappingNode):
        entries = {
            key.value: item_of(
                part, at(key.start_mark.line, f"{place.element}: {_short(key.value)}")
            )
            for key, part in node.value
        }
        return Item(entries, place)
    return Item(value_of(node), place)


def _short(key: str) -> str:
    return key if len(key) <= 40 and key.isprintable() else quoted(key)


def unknown_key(
    key: object, known: Iterable[str], inside: str, elsewhere: Mapping[str, str] | None = None
) -> str:
    """Message for a key that is not known; `elsewhere` says where others are known."""
    known = tuple(known)
    places = {name: name for name in known} | dict(elsewhere or {})
    near = difflib.get_close_matches(str(key).lower(), places, n=1, cutoff=0.5)
    hint = f"did you mean {places[near[0]]}?" if near else f"known are {listed(known)}"
    return f"unknown key {inside}{quoted(key)}; {hint}"


class ItemReader:
    """Takes items apart and collects what is wrong with them."""

    def __init__(self, wrong: Callable[[Place, str], None]) -> None:
        self.wrong = wrong

    def keys(
        self, item: Item, known: tuple[str, ...], needed: tuple[str, ...] = ()
    ) -> dict[str, Item] | None:
        """The items of a mapping by their keys; None if it is none or lacks what is needed."""
        if not isinstance(item.value, dict):
            form = ", ".join(f"{key}: ..." for key in needed or known)
            self.wrong(item.place, f"expected {{{form}}}, got {shown(item.value)}")
            return None
        inside = f"{item.place.element}: "
        for key, part in item.value.items():
            if key not in known:
                place = Place(part.place.source, part.place.line)
                self.wrong(place, unknown_key(key, known, inside))
        if missing := [key for key in needed if key not in item.value]:
            self.wrong(item.place, f"expected {' and '.join(missing)}, too")
            return None
        return {key: part for key, part in item.value.items() if key in known}

    def parts(self, item: Item, most: int, what: str) -> list[Item]:
        """The items of a list."""
        if not isinstance(item.value, list):
            self.wrong(item.place, f"expected a list of {what}, got {shown(item.value)}")
        elif len(item.value) > most:
            self.wrong(item.place, f"expected at most {most} {what}, got {len(item.value)}")
        else:
            return item.value
        return []

    def number(self, item: Item, parameter: Parameter) -> float | None:
        """A number within its range."""
        if message := parameter.problem(item.value):
            self.wrong(item.place, message)
            return None
        number: float = parameter.kind(item.value)
        return number

    def right(self, item: Item, message: str | None) -> bool:
        """Whether there is nothing to say against an item."""
        if message:
            self.wrong(item.place, message)
        return not message
