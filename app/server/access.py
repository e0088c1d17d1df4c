"""Who may talk to the dashboard: the one check that every request passes, pages and websockets."""

from __future__ import annotations

import hmac
import re
import secrets
import socket
from dataclasses import dataclass
from ipaddress import ip_address
from typing import TypeAlias
from urllib.parse import parse_qs

from websockets.http11 import Request

Address: TypeAlias = tuple[str, int]

_AUTHORITY = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(?::([0-9]{1,5}))?", re.IGNORECASE)
_ORIGIN = re.compile(r"(https?)://(.+)", re.IGNORECASE)
_DEFAULT_PORTS = {"http": 80, "https": 443}
_ELSEWHERE = {
    "0.0.0.0": (socket.AF_INET, "192.0.2.1"),  # nosec B104
    "::": (socket.AF_INET6, "2001:db8::1"),
}
"""Addresses that stand for all of this machine's, and one elsewhere, reserved for examples."""


@dataclass(frozen=True)
class Access:
    """The rules of admission for a server bound to `host`.

    A page of another site must neither read nor command the app: the browser's `Origin` must be
    the address that the request went to, and that address must be one of ours, or a foreign name
    that was made to resolve to this machine (DNS rebinding) would pass for it.

    Attributes:
        host: Address that the server listens on.
        token: Only who knows it is let in; None lets in all who can reach the server.
    """

    host: str
    token: str | None = None

    @classmethod
    def to_host(cls, host: str, private: bool = False) -> Access:
        """With a new token if other machines reach `host`, or if `private` asks for one."""
        demanded = private or not is_loopback(host)
        return cls(host, secrets.token_urlsafe() if demanded else None)

    @property
    def loopback(self) -> bool:
        """True if the server can be reached from this machine only."""
        return is_loopback(self.host)

    def refusal(self, request: Request, port: int) -> str | None:
        """Why a request is refused, in one line, or None if it is let in.

        Args:
            request: What was asked for.
            port: The port that it came in on.
        """
        hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        target = parse_authority(hosts[0], 80) if len(hosts) == 1 else None
        if target is None:
            return "expected exactly one Host header with a host name and port"
        if not self._ours(target[0]):
            return self._foreign_host(hosts[0], port)
        if len(origins) > 1:
            return "expected at most one Origin header"
        if origins and parse_origin(origins[0]) != target:
            return f"pages of {origins[0]} may not use this app; open it at http://{hosts[0]}"
        if not (self._is_token(_given_token(request)) or self._is_token(_cookie(request))):
            return "expected the token; open the whole address that geswarm-ui printed"
        return None

    def cookie(self, request: Request) -> dict[str, str]:
        """A header that gives a browser the token to keep, if its request brought it.

        What the page asks for then carries it too: scripts, frames and websockets.
        """
        if self.token is None or not self._is_token(_given_token(request)):
            return {}
        cookie = f"{_cookie_name(request)}={self.token}; Path=/; HttpOnly; SameSite=Strict"
        return {"Set-Cookie": cookie}

    def _is_token(self, given: str) -> bool:
        if self.token is None:
            return True
        return hmac.compare_digest(given.encode(errors="replace"), self.token.encode())

    def _ours(self, name: str) -> bool:
        # Any port will do: one forwarded through ssh or a container differs from ours.
        if self.loopback:
            return is_loopback(name)
        # An IP address cannot be rebound.
        return is_loopback(name) or _is_ip_address(name) or name in self._own_names()

    def _own_names(self) -> set[str]:
        return {self.host.lower(), socket.gethostname().lower(), socket.getfqdn().lower()}

    def _foreign_host(self, given: str, port: int) -> str:
        if self.loopback:
            return f"this app does not answer to {given}; open it at http://127.0.0.1:{port}"
        return f"this app does not answer to {given}; open it at this machine's IP address"


def _given_token(request: Request) -> str:
    """The token in the address, empty if there is none."""
    return parse_qs(request.path.partition("?")[2]).get("token", [""])[0]


def _cookie(request: Request) -> str:
    """The token in the cookies, empty if there is none."""
    pairs = (
        pair.strip().partition("=")
        for header in request.headers.get_all("Cookie")
        for pair in header.split(";")
    )
    name = _cookie_name(request)
    return next((value for key, _, value in pairs if key == name), "")


def _cookie_name(request: Request) -> str:
    """Cookies are kept by host alone: the port tells two dashboards of one host apart."""
    target = parse_authority(request.headers["Host"], 80)
    return f"geswarm-{target[1] if target else ''}"


def parse_authority(text: str, default_port: int) -> Address | None:
    """(lower-case host without brackets, port) of `host[:port]`, or None if it is not one."""
    match = _AUTHORITY.fullmatch(text.strip())
    if match is None:
        return None
    return match[1].lower().strip("[]"), int(match[2] or default_port)


def parse_origin(text: str) -> Address | None:
    """(host, port) of an `Origin` header, or None (`null`, a file, another scheme)."""
    match = _ORIGIN.fullmatch(text.strip())
    return match and parse_authority(match[2], _DEFAULT_PORTS[match[1].lower()])


def machine_address(host: str) -> str:
    """A host for addresses: `host` itself, or this machine's IP address if it stands for all."""
    if host in _ELSEWHERE:
        family, elsewhere = _ELSEWHERE[host]
        try:
            with socket.socket(family, socket.SOCK_DGRAM) as probe:
                probe.connect((elsewhere, 9))  # chooses the way there, and sends nothing
                host = probe.getsockname()[0]
        except OSError:  # no network
            host = "localhost"
    return f"[{host}]" if ":" in host else host


def is_loopback(host: str) -> bool:
    """True for localhost and the loopback addresses."""
    return host.lower() == "localhost" or (_is_ip_address(host) and ip_address(host).is_loopback)


def _is_ip_address(host: str) -> bool:
    try:
        ip_address(host)
    except ValueError:
        return False
    return True
