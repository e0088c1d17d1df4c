"""Answers to requests for pages and files: each protects its reader."""

from __future__ import annotations

import html
from http import HTTPStatus

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

CONTENT_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}
"""Of the files of our pages, by suffix."""

PROTECTION = {
    "Content-Security-Policy": "frame-ancestors 'self'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",  # the address may hold the token
}
"""Headers of every answer, unless it has stricter ones."""

_REFUSED = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Refused - GESwarm</title>
<style>
:root {{ color-scheme: light dark; }}
body {{ margin: 18vh auto 0; padding: 0 20px; max-width: 560px; }}
body {{ font: 16px/1.5 system-ui, sans-serif; }}
h1 {{ font-size: 20px; }}
p {{ overflow-wrap: anywhere; }}
</style>
</head>
<body>
<h1>GESwarm is here, but this request is refused</h1>
<p>Refused: {reason}</p>
</body>
</html>
"""
_REFUSED_POLICY = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'"


def plain(status: HTTPStatus, line: str) -> Response:
    """A line of text."""
    return response(status, "text/plain; charset=utf-8", f"{line}\n".encode(), {})


def refused(request: Request, reason: str) -> Response:
    """Why a request is refused: a page for who opens one in a browser, else a line of text."""
    if "text/html" not in ",".join(request.headers.get_all("Accept")):
        return plain(HTTPStatus.FORBIDDEN, reason)
    page = _REFUSED.format(reason=html.escape(reason))
    policy = {"Content-Security-Policy": _REFUSED_POLICY}
    return response(HTTPStatus.FORBIDDEN, CONTENT_TYPES[".html"], page.encode(), policy)


def response(status: HTTPStatus, kind: str, body: bytes, more: dict[str, str]) -> Response:
    """An answer that is not to be kept.

    Args:
        status: Of the answer.
        kind: Its content type.
        body: Its content.
        more: Further headers, which take precedence.
    """
    headers = {
        "Content-Type": kind,
        "Content-Length": str(len(body)),
        "Cache-Control": "no-store",
        "Connection": "close",
        **PROTECTION,
        **more,
    }
    return Response(status.value, status.phrase, Headers(headers), body)
