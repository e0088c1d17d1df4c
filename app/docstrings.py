"""What classes say of themselves in their docstrings, for people who look at a page."""

from __future__ import annotations

import inspect
import re


def summary(owner: type) -> str:
    """The first paragraph of a class's docstring, on one line."""
    return " ".join((inspect.getdoc(owner) or "").partition("\n\n")[0].split())


def explanations(owner: type) -> dict[str, str]:
    """What a class says of its attributes in its docstring, by name."""
    _, _, text = (inspect.getdoc(owner) or "").partition("Attributes:\n")
    entries = re.findall(r"^    (\w+): ((?:.+\n?)(?:^     +.+\n?)*)", text, re.MULTILINE)
    return {name: " ".join(words.replace("`", "").split()) for name, words in entries}
