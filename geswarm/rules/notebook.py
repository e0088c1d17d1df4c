"""How rule sets and state machines show themselves in notebooks."""

from __future__ import annotations

from importlib import import_module


def as_html(value: object) -> str:
    """What a notebook shows of a value.

    `geswarm.exports` draws it, which stands above the rules: it is looked up by name, and only when
    a notebook asks.
    """
    return str(import_module("geswarm.exports").as_html(value))
