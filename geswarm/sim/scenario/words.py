"""What the parts of a scenario may be that are no plain numbers: names, objective, lists."""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from geswarm.rules.findings import Place
from geswarm.rules.findings import shown as quoted
from geswarm.sim.bodies import BODIES
from geswarm.sim.parameter import Parameter, shown
from geswarm.sim.scenario.objective import OF_THE_RUN, Objective, ObjectiveError
from geswarm.sim.scenario.yaml_items import Item, ItemReader

_DISTANCE = Parameter(float, 1e-6, 1e4, " m")
_PROBABILITY = Parameter(float, 0, 1, above=True)
_NUMBER = Parameter(float, -1e15, 1e15)
_MOST_NAMES = 64

_TERM = re.compile(r"[A-Z_](?:[A-Z0-9_-]*[A-Z0-9_])?")
_DECLARED = re.compile(rf"{_TERM.pattern}(?:\([\w., -]+\))?")
_LOWER = re.compile(r"[a-z][a-z0-9_]*")
_REFERENCE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")
_RULE_FILES = (".yaml", ".yml", ".json", ".txt")


def word_problems(values: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], str]]:
    """Everything that is wrong by itself, as (parameter, message); not all need be there."""
    for key, check in WORDS.items():
        if key in values and (message := check(values[key])):
            yield (key,), message


def term_problem(name: object) -> str | None:
    """Why something cannot be the name of a term, or None."""
    if isinstance(name, str) and len(name) <= 60 and _TERM.fullmatch(name):
        return None
    return f"expected a name of capitals, digits, _ and -, got {shown(name)}"


def declared_problem(name: object) -> str | None:
    """Why something cannot be offered as a behaviour or register, such as `MODE(red, green)`."""
    if isinstance(name, str) and len(name) <= 60 and _DECLARED.fullmatch(name):
        return None
    return term_problem(name)


def measure_problem(name: object) -> str | None:
    """Why something cannot be the name of a measure or of a number of one's own, or None."""
    if not (isinstance(name, str) and len(name) <= 60 and _LOWER.fullmatch(name)):
        return f"expected a name of lower-case letters, digits and _, got {shown(name)}"
    if name in (*OF_THE_RUN, "min", "max", "abs") or keyword.iskeyword(name):
        return f"expected another name, {name} has a meaning already"
    return None


def names_problem(names: object, problem: Callable[[object], str | None], least: int) -> str | None:
    """Why something is no list of names, or None."""
    if not isinstance(names, list | tuple):
        return f"expected a list of names, got {shown(names)}"
    if not least <= len(names) <= _MOST_NAMES:
        return f"expected {least} to {_MOST_NAMES} names, got {len(names)}"
    for at, name in enumerate(names):
        if message := problem(name):
            return message
        if name in names[:at]:
            return f"{name} is given twice"
    return None


def unit_problem(unit: object) -> str | None:
    """Why something cannot be the unit of an objective, or None."""
    if isinstance(unit, str) and len(unit) <= 40 and unit.isprintable():
        return None
    return f"expected a unit of at most 40 characters on one line, got {shown(unit)}"


def probabilities_problem(values: object) -> str | None:
    """Why something cannot be the probabilities on offer, or None."""
    if not isinstance(values, list | tuple) or not 1 <= len(values) <= _MOST_NAMES:
        return f"expected a list of 1 to {_MOST_NAMES} probabilities, got {shown(values)}"
    for at, value in enumerate(values):
        if message := _PROBABILITY.problem(value):
            return message
        if at and value <= values[at - 1]:
            return f"expected ascending probabilities, got {value} after {values[at - 1]}"
    return None


def reference_problem(name: object) -> str | None:
    """Why something cannot be the name of a reference rule set, or the file of one, or None."""
    if name == "" or (isinstance(name, str) and len(name) <= 60 and _REFERENCE.fullmatch(name)):
        return None
    if isinstance(name, str) and Path(name).is_absolute() and name.endswith(_RULE_FILES):
        return None
    files = ", ".join(_RULE_FILES)
    return f"expected the name of a rule set, or a file ({files}), got {shown(name)}"


def own_numbers_problem(pairs: object) -> str | None:
    """Why something cannot be the numbers of one's own, or None."""
    if not isinstance(pairs, list | tuple) or len(pairs) > _MOST_NAMES:
        return f"expected at most {_MOST_NAMES} numbers with their names, got {shown(pairs)}"
    taken = set()
    for pair in pairs:
        if not isinstance(pair, list | tuple) or len(pair) != 2:
            return f"expected a name and a number, got {shown(pair)}"
        name, value = pair
        if message := measure_problem(name):
            return message
        if name in taken:
            return f"{name} is given twice"
        taken.add(name)
        if message := _NUMBER.problem(value):
            return f"{name}: {message}"
    return None


def _avoidance_problem(value: object) -> str | None:
    return None if value is None else _DISTANCE.problem(value)


_EVALUATIONS = Parameter(int, 1, 1000)


def _body_problem(name: object) -> str | None:
    if isinstance(name, str) and name in BODIES:
        return None
    return f"expected {' or '.join(BODIES)}, got {shown(name)}"


def _initial_problem(name: object) -> str | None:
    return None if name == "" else term_problem(name)


def _objective_problem(objective: object) -> str | None:
    if not isinstance(objective, Objective):
        return f"expected an objective, got {shown(objective)}"
    return unit_problem(objective.unit)


def _terms_problem(path: object) -> str | None:
    if path is None or (isinstance(path, Path) and path.is_absolute()):
        return None
    return f"expected an absolute path, got {shown(path)}"


WORDS: Mapping[str, Callable[[object], str | None]] = {
    "avoidance_range": _avoidance_problem,
    "body": _body_problem,
    "evaluations": _EVALUATIONS.problem,
    "preconditions": partial(names_problem, problem=term_problem, least=0),
    "behaviours": partial(names_problem, problem=declared_problem, least=1),
    "registers": partial(names_problem, problem=declared_problem, least=0),
    "initial_behaviour": _initial_problem,
    "measures": partial(names_problem, problem=measure_problem, least=1),
    "objective": _objective_problem,
    "probabilities": probabilities_problem,
    "reference": reference_problem,
    "terms": _terms_problem,
    "numbers": own_numbers_problem,
}
"""What is wrong with a value of each field that is neither a number nor the arena, or None."""


_NAMED_BY_FILES: set[Path] = set()
"""Code that a scenario's file has named in this process: what else names it may have it, too."""


class WordReader(ItemReader):
    """Reads the values of `WORDS` from a file.

    Args:
        wrong: Told what is wrong, and where.
        folder: What paths are relative to; None where no code may be named.
    """

    def __init__(self, wrong: Callable[[Place, str], None], folder: Path | None) -> None:
        super().__init__(wrong)
        self._folder = folder

    def read(self, key: str, item: Item) -> Any:
        """The value as the field takes it; None if it is wrong."""
        reader: Callable[[Item], Any] | None = getattr(self, f"_{key}", None)
        if reader is not None:
            return reader(item)
        if item.value is None:
            self.wrong(item.place, WORDS[key]("") or "expected a value, got nothing")
        return tuple(item.plain) if isinstance(item.value, list) else item.plain

    def _names(self, item: Item, problem: Callable[[object], str | None]) -> Any:
        parts = item.value if isinstance(item.value, list) else []
        found, taken = True, set()
        for part in parts[: _MOST_NAMES + 1]:
            name = part.value
            message = problem(name) or (f"{name} is given twice" if name in taken else None)
            found &= self.right(part, message)
            taken |= set() if message else {name}
        return item.plain if found else None

    def _preconditions(self, item: Item) -> Any:
        return self._names(item, term_problem)

    def _behaviours(self, item: Item) -> Any:
        return self._names(item, declared_problem)

    _registers = _behaviours

    def _measures(self, item: Item) -> Any:
        return self._names(item, measure_problem)

    def _objective(self, item: Item) -> Objective | None:
        entries = {"maximise": item}
        if isinstance(item.value, dict):
            entries = self.keys(item, ("maximise", "minimise", "unit")) or {}
        chosen = [key for key in ("maximise", "minimise") if key in entries]
        if len(chosen) != 1:
            self.wrong(item.place, "expected either maximise or minimise")
            return None
        unit, expression = entries.get("unit"), entries[chosen[0]]
        if unit is not None and not self.right(unit, unit_problem(unit.value)):
            return None
        if not isinstance(expression.value, str):
            message = f"expected an expression over measures, got {shown(expression.value)}"
            self.wrong(expression.place, message)
            return None
        try:
            return Objective(expression.value, chosen[0] == "maximise", unit.value if unit else "")
        except ObjectiveError as error:
            self.wrong(expression.place, str(error))
            return None

    def _reference(self, item: Item) -> str | None:
        name = item.value
        if self._folder is not None and isinstance(name, str) and name.endswith(_RULE_FILES):
            name = str((self._folder / name).absolute())
            try:
                found = Path(name).is_file()
            except (OSError, ValueError):  # too long, or a NUL
                found = False
            if not found:
                self.wrong(item.place, f"there is no file {quoted(item.value)}")
                return None
        return name if self.right(item, reference_problem(name)) else None

    def _terms(self, item: Item) -> Path | None:
        if not isinstance(item.value, str):
            self.wrong(item.place, f"expected the path of a Python file, got {shown(item.value)}")
            return None
        if self._folder is None and Path(item.value) not in _NAMED_BY_FILES:
            message = "terms of one's own are code, which is only read where a file names it"
            self.wrong(item.place, message)
            return None
        try:
            path = ((self._folder or Path()) / item.value).resolve()
            if path.is_file():
                _NAMED_BY_FILES.add(path)
                return path
        except (OSError, ValueError, RuntimeError):  # too long, a NUL, or links in a circle
            pass
        self.wrong(item.place, f"there is no file {quoted(item.value)}")
        return None

    def _numbers(self, item: Item) -> tuple[tuple[str, float], ...] | None:
        if not isinstance(item.value, dict):
            self.wrong(item.place, f"expected {{name: number}}, got {shown(item.value)}")
            return None
        pairs = [(name, part.plain) for name, part in item.value.items()]
        found = [
            self.right(part, own_numbers_problem([(name, part.plain)]))
            for name, part in list(item.value.items())[:_MOST_NAMES]
        ]
        return tuple(pairs) if all(found) else None
