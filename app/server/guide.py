"""The guide as pages: what is written in Markdown in static/guide, in as much of it as is used."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator
from pathlib import Path

FOLDER = "guide"
"""Of static/."""

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title} - GESwarm</title>
<link rel="stylesheet" href="../common/page.css">
<link rel="stylesheet" href="guide.css">
<link rel="icon" href="../common/icon.svg" type="image/svg+xml">
<script src="../common/theme.js"></script>
</head>
<body>
<nav>{links}</nav>
<main>
{body}
</main>
</body>
</html>
"""
_PAGES = {
    "scenarios": "Scenario files",
    "terms": "All terms and measures",
    "own-terms": "Terms of one's own",
    "missions": "Missions of the field",
    "automode": "For AutoMoDe users",
    "epuck-agreement": "E-pucks here and there",
    "commands": "Commands in detail",
}
"""In the order in which they are read."""
_INLINE = re.compile(r"`([^`]+)`|(!?)\[([^]]+)\]\(([\w./-]+)\)|(<br>)")


def guide_page(folder: Path, name: str) -> str | None:
    """A page of the guide as HTML; None if there is none of that name.

    Args:
        folder: Where its text lies, `<name>.md`.
        name: Without `.html`.
    """
    file = folder / f"{name}.md"
    if name not in _PAGES or not file.is_file():
        return None
    body = "\n".join(_blocks(file.read_text(encoding="utf-8")))
    return _PAGE.format(title=html.escape(_PAGES[name]), links=_links(name), body=body)


def _links(here: str) -> str:
    parts = (
        f"<b>{html.escape(title)}</b>"
        if name == here
        else f'<a href="{name}.html">{html.escape(title)}</a>'
        for name, title in _PAGES.items()
    )
    return " ".join(parts)


def _blocks(text: str) -> Iterator[str]:
    """The elements of a page, one for each part between empty lines."""
    for block in re.findall(
        r"(?:^ {4}.*\n(?:\n+(?= {4}))?)+|(?:^(?! {4}).+\n)+", text, re.MULTILINE
    ):
        block = block.strip("\n")
        if block.startswith("    "):
            code = "\n".join(line[4:] for line in block.split("\n"))
            yield f"<pre>{html.escape(code)}</pre>"
        elif block.startswith("#"):
            marks, _, title = block.partition(" ")
            yield f"<h{len(marks)}>{_inline(title)}</h{len(marks)}>"
        elif block.startswith("|"):
            yield _table(block.split("\n"))
        elif block.startswith("- "):
            items = re.split(r"\n(?=- )", block)
            yield "<ul>" + "".join(f"<li>{_inline(item[2:])}</li>" for item in items) + "</ul>"
        else:
            yield f"<p>{_inline(block)}</p>"


def _table(lines: list[str]) -> str:
    head, _, *rows = ([cell.strip() for cell in _cells(line)] for line in lines)
    titles = "".join(f"<th>{_inline(cell)}</th>" for cell in head)
    body = "".join(
        f"<tr>{''.join(f'<td>{_inline(cell)}</td>' for cell in row)}</tr>\n" for row in rows
    )
    return f"<table><thead><tr>{titles}</tr></thead><tbody>\n{body}</tbody></table>"


def _cells(line: str) -> list[str]:
    return re.split(r"(?<!\\)\|", line.strip())[1:-1]


def _inline(text: str) -> str:
    """Text with code, links, pictures and line breaks in it; all else is shown as it is written."""
    found, at = [], 0
    for match in _INLINE.finditer(text):
        found.append(html.escape(text[at : match.start()], quote=False))
        code, picture, label, target, _ = match.groups()
        if code is not None:
            found.append(f"<code>{html.escape(code, quote=False)}</code>")
        elif picture:
            found.append(f'<img src="{html.escape(target)}" alt="{html.escape(label)}">')
        elif label is not None:
            page = target.removesuffix(".md") + ".html" if target.endswith(".md") else target
            found.append(f'<a href="{html.escape(page)}">{_inline(label)}</a>')
        else:
            found.append("<br>")
        at = match.end()
    found.append(html.escape(text[at:], quote=False))
    return "".join(found)
