"""Pages that need nothing else: figures, tables and rule sets in one HTML file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

import plotly.graph_objects as go
from plotly.offline import get_plotlyjs

_STYLE = Path(__file__).with_name("page.css")
_CONFIG = {"displayModeBar": False, "responsive": False}
_PAPER_WIDTH = 688  # pixels between the margins of A4
_NOTHING_ELSE = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
)


def page(title: str, body: str) -> str:
    """A whole page; it carries plotly and its style, and may not load anything.

    Args:
        title: Plain text.
        body: HTML, all text in it escaped.
    """
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{_NOTHING_ELSE}">
<meta name="viewport" content="width=device-width">
<title>{escape(title)}</title>
<style>
{_STYLE.read_text(encoding="utf-8")}</style>
<script>{get_plotlyjs()}</script>
</head>
<body>
{body}
</body>
</html>
"""


def figure_html(figure: go.Figure, name: str, caption: str) -> str:
    """A figure and what it shows.

    Args:
        figure: What to draw.
        name: Its identifier in the page.
        caption: HTML.
    """
    drawn = figure.to_html(
        full_html=False, include_plotlyjs=False, div_id=f"{name}-plot", config=_CONFIG
    )
    kind = ' class="wide"' if figure.layout.width > _PAPER_WIDTH else ""
    return f'<figure id="{name}"{kind}>\n{drawn}\n<figcaption>{caption}</figcaption>\n</figure>'


def table_html(headings: Sequence[str], rows: Iterable[Sequence[str]], texts: int = 1) -> str:
    """A table of plain texts.

    Args:
        headings: One per column.
        rows: One text per column; it is escaped.
        texts: So many columns at the left hold text, the others figures.
    """

    def line(tag: str, cells: Sequence[str]) -> str:
        kinds = ["text" if at < texts else "number" for at in range(len(cells))]
        inner = (
            f'<{tag} class="{kind}">{escape(cell)}</{tag}>'
            for kind, cell in zip(kinds, cells, strict=True)
        )
        return f"<tr>{''.join(inner)}</tr>"

    body = "\n".join(line("td", row) for row in rows)
    head = line("th", headings)
    return (
        f'<div class="scroll"><table class="data"><thead>{head}</thead>\n'
        f"<tbody>\n{body}\n</tbody></table></div>"
    )
