"""Reading scenario files: YAML that gives only what differs from another scenario."""

from __future__ import annotations

import difflib
import re
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from geswarm.plain_text import NotTextError, read_file
from geswarm.rules.findings import Finding, Place, shown
from geswarm.rules.limits import MAX_CHARACTERS
from geswarm.rules.plain_yaml import YamlError, compose, value_of
from geswarm.sim.scenario_checks import PARAMETERS, ScenarioError, problems, written

_FOLDER = Path(__file__).parent / "scenarios"
_ROOT = "paper"
_ARENA = ("width", "length")
_TOP = ("extends", "arena", *(key for key in PARAMETERS if key not in _ARENA))


class _Given(NamedTuple):
    """A value and where it is written."""

    value: Any
    place: Place


def built_in_names() -> list[str]:
    """Names of the scenarios that come with GESwarm, `paper` first, numbers in order."""

    def order(name: str) -> tuple[bool, list[tuple[str, int]]]:
        parts = re.findall(r"([^0-9]+)([0-9]*)", name)
        return name != _ROOT, [(text, int(digits or 0)) for text, digits in parts]

    return sorted((path.stem for path in _FOLDER.glob("*.yaml")), key=order)


def read(name_or_path: str) -> tuple[str, dict[str, Any]]:
    """Name and all parameters of a built-in scenario or a file, checked.

    Raises:
        ScenarioError: It does not exist or is wrong.
    """
    reader = _Reader()
    path = reader.find(name_or_path, Path(), Place())
    given = reader.file(path, Place(), ()) if path else {}
    return (path.stem if path else ""), reader.checked(given, _shown(path))


def parse(text: str, name: str) -> dict[str, Any]:
    """All parameters of a scenario given as text, checked.

    Raises:
        ScenarioError: The text is wrong.
    """
    reader = _Reader()
    return reader.checked(reader.text(text, name, Path(), ()), name)


class _Reader:
    """Reads a scenario with all that it extends and collects what is wrong."""

    def __init__(self) -> None:
        self.findings: list[Finding] = []

    def wrong(self, place: Place, message: str) -> None:
        self.findings.append(Finding(place, message))

    def checked(self, given: dict[str, _Given], source: str) -> dict[str, Any]:
        """The values; misfits are reported in the file being read if it has a part in them."""
        values = {key: given[key].value for key in PARAMETERS if key in given}
        for keys, message in problems(values):
            here = [key for key in keys if given[key].place.source == source] or list(keys)
            self.wrong(given[here[0]].place, message)
        if self.findings:
            raise ScenarioError(self.findings)
        return values

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
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(names)}"
        self.wrong(place, f"there is no scenario or file {shown(name_or_path)}; {hint}")
        return None

    def file(self, path: Path, place: Place, trail: tuple[Path, ...]) -> dict[str, _Given]:
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
    ) -> dict[str, _Given]:
        """What a text and all that it extends give."""
        own = self._own(text, source)
        if own is None:
            return {}
        base: Path | None = _FOLDER / f"{_ROOT}.yaml"
        place = Place(source)
        if "extends" in own:
            name, place = own.pop("extends")
            if isinstance(name, str):
                base = self.find(name, folder, place)
            else:
                self.wrong(place, "expected the name or path of a scenario")
        elif trail and trail[-1] == (_FOLDER / f"{_ROOT}.yaml").resolve():
            base = None
        return {**(self.file(base, place, trail) if base else {}), **own}

    def _own(self, text: str, source: str) -> dict[str, _Given] | None:
        """What this text gives, flat (`arena` resolved), or None if it is not such a file."""
        try:
            node = compose(text)
        except YamlError as error:
            self.wrong(Place(source, error.line), str(error))
            return None
        if not isinstance(node, yaml.MappingNode):
            self.wrong(Place(source), "expected lines such as `extends: paper` and `robots: 8`")
            return None
        own = self._mapping(node, source, _TOP, "")
        arena = own.pop("arena", None)
        if arena is not None:
            arena_node = next(value for key, value in node.value if key.value == "arena")
            if isinstance(arena_node, yaml.MappingNode):
                own |= self._mapping(arena_node, source, _ARENA, "arena: ")
            else:
                self.wrong(arena.place, "expected {width: ..., length: ...}")
        return own

    def _mapping(
        self, node: yaml.MappingNode, source: str, known: tuple[str, ...], inside: str
    ) -> dict[str, _Given]:
        """The known keys of a mapping."""
        own: dict[str, _Given] = {}
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            key = key_node.value if isinstance(key_node, yaml.ScalarNode) else None
            if key not in known:
                self.wrong(Place(source, line), _unknown(key, known, inside))
                continue
            place = Place(source, line, element=f"{inside}{key}")
            if key in own:
                self.wrong(place, f"given twice, first in line {own[key].place.line}")
                continue
            try:
                own[key] = _Given(value_of(value_node), place)
            except YamlError as error:
                self.wrong(Place(source, error.line, element=place.element), str(error))
        return own


def _shown(path: Path | None) -> str:
    """A path as messages name it; built-in scenarios by their file's name."""
    if path is None:
        return ""
    return path.name if path.parent == _FOLDER else str(path)


def _unknown(key: str | None, known: tuple[str, ...], inside: str) -> str:
    places = {name: name for name in known}
    if not inside:
        places |= {name: written(name) for name in _ARENA}
    near = difflib.get_close_matches(str(key).lower(), places, n=1, cutoff=0.5)
    hint = f"did you mean {places[near[0]]}?" if near else f"known are {', '.join(known)}"
    return f"unknown key {inside}{shown(key)}; {hint}"
