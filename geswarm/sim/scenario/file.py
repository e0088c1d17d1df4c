"""Reading scenario files: YAML that gives only what differs from another scenario."""

from __future__ import annotations

import difflib
import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from geswarm.plain_text import NotTextError, read_file
from geswarm.rules.findings import Finding, Place, shown
from geswarm.rules.limits import MAX_CHARACTERS
from geswarm.rules.plain_yaml import YamlError, compose, value_of
from geswarm.sim.arena.checks import Problem
from geswarm.sim.arena.file import ARENA_KEYS, ArenaFileError, ArenaReader, Given, build, inherited
from geswarm.sim.parameter import listed
from geswarm.sim.scenario.checks import (
    OF_THE_ARENA,
    PARAMETERS,
    ScenarioError,
    number_problems,
    problems,
)
from geswarm.sim.scenario.words import WORDS, WordReader, word_problems
from geswarm.sim.scenario.yaml_items import Item, item_of, unknown_key

_FOLDER = Path(__file__).parents[1] / "scenarios"
_ROOT = "paper"
NOTHING = "nothing"
"""What a scenario extends that inherits nothing."""
Misfits: TypeAlias = Callable[[Mapping[str, Any]], Iterable[Problem]]
_TOP = ("extends", "arena", *(key for key in PARAMETERS if key not in ARENA_KEYS), *WORDS)
_NEEDED = ("robots", "duration", "preconditions", "behaviours", "measures", "objective")


@cache
def built_in_names() -> tuple[str, ...]:
    """Names of the scenarios that come with GESwarm, `paper` first, numbers in order."""

    def order(name: str) -> tuple[bool, list[tuple[str, int]]]:
        parts = re.findall(r"([^0-9]+)([0-9]*)", name)
        return name != _ROOT, [(text, int(digits or 0)) for text, digits in parts]

    return tuple(sorted((path.stem for path in _FOLDER.glob("*.yaml")), key=order))


def about(name: str) -> str:
    """The comment with which the file of a built-in scenario begins."""
    lines = (_FOLDER / f"{name}.yaml").read_text(encoding="utf-8").splitlines()
    comment = itertools.takewhile(lambda line: line.startswith("#"), lines)
    return " ".join(line.strip("# ") for line in comment)


def read(
    name_or_path: str, defaults: Mapping[str, Any], misfits: Misfits
) -> tuple[str, dict[str, Any]]:
    """Name and fields of a built-in scenario or a file, checked.

    Args:
        name_or_path: Which.
        defaults: Of fields that need not be given.
        misfits: Finds what is wrong with fields that are right by themselves.

    Raises:
        ScenarioError: It does not exist or is wrong.
    """
    reader = _Reader(defaults, misfits, with_code=True)
    path = reader.find(name_or_path, Path(), Place())
    given = reader.file(path, Place(), ()) if path else {}
    return (path.stem if path else ""), reader.checked(given, _shown(path))


def parse(
    text: str,
    name: str,
    defaults: Mapping[str, Any],
    misfits: Misfits,
    folder: Path | None,
) -> dict[str, Any]:
    """The fields of a scenario given as text, checked.

    Args:
        text: What a file would hold.
        name: What messages call it.
        defaults: Of fields that need not be given.
        misfits: Finds what is wrong with fields that are right by themselves.
        folder: Where the text lies; None if it comes from no file, and may name no code.

    Raises:
        ScenarioError: The text is wrong.
    """
    reader = _Reader(defaults, misfits, with_code=folder is not None)
    return reader.checked(reader.text(text, name, folder or Path(), ()), name)


class _Reader:
    """Reads a scenario with all that it extends and collects what is wrong.

    `with_code` says whether it may name a file with terms of one's own.
    """

    def __init__(self, defaults: Mapping[str, Any], misfits: Misfits, with_code: bool) -> None:
        self.findings: list[Finding] = []
        self._defaults = defaults
        self._misfits = misfits
        self._with_code = with_code
        self._root = Place()
        self._parts: dict[str, Place] = {}

    def wrong(self, place: Place, message: str) -> None:
        self.findings.append(Finding(place, message))

    def checked(self, given: dict[str, Given], source: str) -> dict[str, Any]:
        """The fields; misfits are reported in the file being read if it has a part in them."""
        values = {key: given[key].value for key in (*PARAMETERS, *WORDS) if key in given}
        for keys, message in (*number_problems(values), *word_problems(values)):
            self.wrong(given[keys[0]].place, message)
        self._require(not self.findings)
        if missing := [key for key in _NEEDED if key not in values]:
            self.wrong(self._root, f"expected {', '.join(missing)}, too")
        places: dict[str, Place] = {}
        try:
            values["arena"], places = build(given)
        except ArenaFileError as error:
            self.wrong(error.place or self._root, str(error))
        self._require(not self.findings)
        places |= self._parts | {key: each.place for key, each in given.items()}
        own = {key: value for key, value in values.items() if key not in OF_THE_ARENA}
        fields = {**self._defaults, **own}
        for find in (problems, self._misfits):
            for keys, message in find(fields):
                known = [places[key] for key in keys if key in places] or [self._root]
                here = [place for place in known if place.source == source] or known
                self.wrong(here[0], message)
            self._require(not self.findings)
        return fields

    def _require(self, right: bool) -> None:
        if not right:
            raise ScenarioError(self.findings)

    def find(self, name_or_path: str, folder: Path, place: Place) -> Path | None:
        """Where a scenario is; names go before paths."""
        names = built_in_names()
        if name_or_path in names:
            return _FOLDER / f"{name_or_path}.yaml"
        path = folder / name_or_path
        try:
            if path.is_file():
                return path
        except (OSError, ValueError):  # too long, or with a NUL
            pass
        near = difflib.get_close_matches(name_or_path, names, n=1, cutoff=0.5)
        hint = f"did you mean {near[0]}?" if near else f"known are {listed(names)}"
        self.wrong(place, f"there is no scenario or file {shown(name_or_path)}; {hint}")
        return None

    def file(self, path: Path, place: Place, trail: tuple[Path, ...]) -> dict[str, Given]:
        """What a file and all that it extends give; `trail` is the way to it."""
        if path.resolve() in trail:
            chain = " -> ".join(step.name for step in (*trail, path))
            self.wrong(place, f"scenarios extend each other in a circle: {chain}")
            return {}
        try:
            text = read_file(path, MAX_CHARACTERS)
        except OSError as error:
            self.wrong(place, f"cannot read {path}: {error.strerror}")
            return {}
        except NotTextError as error:
            self.wrong(Place(_shown(path)), str(error))
            return {}
        return self.text(text, _shown(path), path.parent, (*trail, path.resolve()))

    def text(
        self, text: str, source: str, folder: Path, trail: tuple[Path, ...]
    ) -> dict[str, Given]:
        """What a text and all that it extends give."""
        own = self._own(text, source, folder)
        if own is None:
            return {}
        base: Path | None = _FOLDER / f"{_ROOT}.yaml"
        place = Place(source)
        if "extends" in own:
            name, place = own.pop("extends")
            if name == NOTHING:
                base, self._root = None, place
            elif isinstance(name, str):
                base = self.find(name, folder, place)
            else:
                self.wrong(place, "expected the name or path of a scenario")
        above = self.file(base, place, trail) if base else {}
        if "numbers" in above and "numbers" in own:
            merged = {**dict(above["numbers"].value), **dict(own["numbers"].value)}
            own["numbers"] = Given(tuple(merged.items()), own["numbers"].place)
        return {**inherited(above, own), **own}

    def _own(self, text: str, source: str, folder: Path) -> dict[str, Given] | None:
        """What this text gives, flat (`arena` resolved), or None if it is not such a file."""
        try:
            node = compose(text)
        except YamlError as error:
            self.wrong(Place(source, error.line), str(error))
            return None
        if not isinstance(node, yaml.MappingNode):
            self.wrong(Place(source), "expected lines such as `extends: paper` and `robots: 8`")
            return None
        own: dict[str, Given] = {}
        arena: dict[str, Given] = {}
        words = WordReader(self.wrong, folder if self._with_code else None)
        for key, part, given in self._entries(node, source):
            if key == "arena":
                arena = self._arena(part, given.place)
            elif key in WORDS:
                item = item_of(part, given.place)
                value = words.read(key, item)
                if value is not None:
                    own[key] = Given(value, given.place)
                    self._note_parts(key, item)
            else:
                own[key] = given
        return {**own, **arena}

    def _note_parts(self, key: str, item: Item) -> None:
        """Remember where the parts of a list are; those of the first file count, read first."""
        for number, part in enumerate(item.value if isinstance(item.value, list) else [], start=1):
            self._parts.setdefault(f"{key} {number}", part.place)

    def _arena(self, node: yaml.Node, place: Place) -> dict[str, Given]:
        """What `arena` gives."""
        if not isinstance(node, yaml.MappingNode):
            self.wrong(place, "expected {width: ..., length: ...}")
            return {}
        reader = ArenaReader(self.wrong)
        return reader.read(reader.keys(item_of(node, place), ARENA_KEYS) or {})

    def _entries(
        self, node: yaml.MappingNode, source: str
    ) -> Iterator[tuple[str, yaml.Node, Given]]:
        """The known keys of a file that are given once and can be understood."""
        first: dict[str, int] = {}
        for key_node, part in node.value:
            line = key_node.start_mark.line + 1
            key = key_node.value if isinstance(key_node, yaml.ScalarNode) else None
            if key not in _TOP:
                elsewhere = {name: f"arena: {name}" for name in ARENA_KEYS}
                self.wrong(Place(source, line), unknown_key(key, _TOP, "", elsewhere))
                continue
            place = Place(source, line, element=key)
            if key in first:
                self.wrong(place, f"given twice, first in line {first[key]}")
                continue
            first[key] = line
            try:
                yield key, part, Given(value_of(part), place)
            except YamlError as error:
                self.wrong(Place(source, error.line, element=key), str(error))


def _shown(path: Path | None) -> str:
    """A path as messages name it; built-in scenarios by their file's name."""
    if path is None:
        return ""
    return path.name if path.parent == _FOLDER else str(path)
