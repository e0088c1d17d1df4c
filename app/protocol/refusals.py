"""Why a message is refused: where it is, what was expected there and what was given."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any, Literal, get_args, get_origin, get_type_hints

import msgspec

from geswarm.rules.findings import shown, unknown_name

from .edits import AnyEdit

_WORDS = {
    "bool": "true or false",
    "int": "a whole number",
    "float": "a number",
    "str": "text",
    "object": "an object",
    "array": "a list",
}
_EDITS = {one.__struct_config__.tag: one for one in get_args(AnyEdit)}


def explained(error: msgspec.ValidationError, raw: str, kinds: Mapping[str, type]) -> str:
    """What a page is told whose message is none of some kinds.

    Args:
        error: What msgspec says of it.
        raw: The message.
        kinds: What may come, by what it is called.
    """
    what, _, path = str(error).partition(" - at `$")
    try:
        given = json.loads(raw)
    except (ValueError, RecursionError):  # nested deeper than that it could be shown
        return f"expected a JSON object: {what}"
    if not isinstance(given, dict):
        return f"expected a JSON object, got {shown(given)}"
    kind = given.get("type")
    if not isinstance(kind, str) or kind not in kinds:
        return f"unknown message {shown(kind)}; expected one of {', '.join(kinds)}"
    keys = re.findall(r"\w+", path)
    hint, value = _at(kinds[kind], given, keys)
    return f"{'.'.join([kind, *keys])}: {_in_words(what, hint, value)}"


def _at(hint: Any, value: Any, keys: list[str]) -> tuple[Any, Any]:
    """What is expected at a path, as a type, and what is there."""
    for key in keys:
        hint, value = _chosen(hint, value), value if isinstance(value, dict) else {}
        if hint == AnyEdit and key == "do":
            hint = Literal[tuple(_EDITS)]
        else:
            hint = get_type_hints(hint).get(key) if isinstance(hint, type) else None
        value = value.get(key)
    return _chosen(hint, value), value


def _chosen(hint: Any, value: Any) -> Any:
    """The edit that a value is meant to be, if an edit is expected and it says which."""
    name = value.get("do") if hint == AnyEdit and isinstance(value, dict) else None
    return _EDITS.get(name, hint) if isinstance(name, str) else hint


def _in_words(what: str, hint: Any, value: Any) -> str:
    if get_origin(hint) is Literal:
        return f"expected one of {', '.join(map(str, get_args(hint)))}, got {shown(value)}"
    if field := re.search(r"unknown field `(.*)`", what):
        known = msgspec.structs.fields(hint) if isinstance(hint, type) else ()
        return unknown_name("field", field[1], [one.encode_name for one in known])
    if field := re.search(r"missing required field `(.*)`", what):
        return f"expected the field {field[1]}, got nothing"
    if expected := re.match(r"Expected `(.*?)`(.*?)(?:, got `.*`)?$", what):
        names = [name for name in expected[1].split(" | ") if name != "null"]
        words = " or ".join(_WORDS.get(name, name) for name in names)
        bound = re.sub(r"of length <= (\d+)", r"of at most \1 characters", expected[2])
        return f"expected {words}{bound}, got {shown(value)}"
    return what[:1].lower() + what[1:]
