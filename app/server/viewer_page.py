"""viser's page as we serve it: under our name, and with a script that sees to what viser does not.

The script (`viewer_page.js`) says on the page what keeps it from being shown: a browser without
WebGL, or an address that the gate refuses; and it finds the websocket below a proxy's path.
"""

from __future__ import annotations

import functools
import gzip
import re
from pathlib import Path

_HERE = Path(__file__)
_TITLE = re.compile(r"<title>.*?</title>", re.DOTALL)
_ICON = re.compile(r"<link\s+rel=\"icon\".*?>", re.DOTALL)
_HEAD = re.compile(r"<meta charset=[^>]*>")


def named(page: str, icon: str) -> str:
    """A page of viser's with our name and icon on its tab in the browser.

    Args:
        page: HTML.
        icon: Address of the icon.
    """
    page = _TITLE.sub("<title>GESwarm</title>", page, count=1)
    link = f'<link rel="icon" href="{icon}" type="image/svg+xml">'
    return _ICON.sub(lambda _: link, page, count=1)


@functools.lru_cache(maxsize=1)
def served(page: bytes) -> tuple[bytes, bytes]:
    """Viser's page with our name and script, plain and as gzip has it."""
    script, style = (
        _HERE.with_suffix(kind).read_text(encoding="utf-8") for kind in (".js", ".css")
    )
    ours = (
        f"<style>{style}</style>\n<script>{script}</script>\n"
        '<script src="common/refused.js"></script>'
    )
    text = named(page.decode(), "common/icon.svg")
    # Before viser's own script, which reads the address of the websocket.
    text = _HEAD.sub(lambda head: f"{head[0]}\n{ours}", text, count=1)
    return text.encode(), gzip.compress(text.encode(), mtime=0)
