"""The page of all terms: `python -m geswarm.sim.library.page > static/guide/terms.md`."""

from __future__ import annotations

from geswarm.rules.arguments import Argument
from geswarm.rules.model import format_value
from geswarm.sim.library.catalogue import Entry, catalogue

_HEAD = """# All terms and measures

What comes with GESwarm for [scenarios](scenarios.md) to offer. `geswarm terms` prints the same,
with `--scenario S` what one scenario offers. What is missing is [written](own-terms.md).
"""
_LISTS = {
    "precondition": "Listed under `preconditions`. Rules compare by `==` and `!=` with `true` and "
    "`false` unless something else is given.",
    "behaviour": "Listed under `behaviours`.",
    "register": "Listed under `registers`: internal states of a robot, which actions change. Rules "
    "may compare those that the scenario declares.",
    "measure": "Listed under `measures`.",
}


def terms_page() -> str:
    """What the page holds."""
    entries = catalogue()
    lines = [_HEAD]
    for kind, about in _LISTS.items():
        title = f"{kind.capitalize()}s"
        lines += [f"## {title}", "", about, "", f"| {kind} | what it is |", "| --- | --- |"]
        lines += [f"| `{each.written}` | {_about(each)} |" for each in entries if each.kind == kind]
        lines.append("")
    return "\n".join(lines)


def _about(entry: Entry) -> str:
    """Everything about a term, in one cell."""
    parts = [entry.about, ", ".join(f"“{words}”" for words in entry.words)]
    parts += [_argument(each) for each in entry.arguments]
    parts += [_compared(entry), f"In {entry.unit}." if entry.unit else ""]
    parts += [f"For the {entry.body}."] if entry.body else []
    return "<br>".join(part.replace("|", "\\|") for part in parts if part)


def _argument(argument: Argument) -> str:
    unit = f" {argument.unit}" if argument.unit else ""
    return f"`{argument.name}`: {argument.expected}{unit}"


def _compared(entry: Entry) -> str:
    """`==` `!=` 0 to 7; nothing for what is true or false."""
    if not entry.values or isinstance(entry.values[0], bool):
        return ""
    signs = " ".join(f"`{sign}`" for sign in entry.signs)
    return f"{signs} {format_value(entry.values[0])} to {format_value(entry.values[-1])}"


if __name__ == "__main__":
    print(terms_page(), end="")
