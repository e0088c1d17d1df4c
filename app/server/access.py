"""Who may talk to the dashboard: the one check that every request passes, pages and websockets."""

from __future__ import annotations

import hmac
import re
import secrets
import socket
from collections.abc import Collection
from dataclasses import dataclass
from ipaddress import IPv6Address, ip_address
from typing import TypeAlias
from urllib.parse import parse_qs

from websockets.http11 import Request

Name: TypeAlias = tuple[str, "int | None"]
"""A host name, lower-case and without brackets, and a port; None if none is said."""

_AUTHORITY = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(?::([0-9]{1,5}))?", re.IGNORECASE)
_ORIGIN = re.compile(r"(https?)://(.+)", re.IGNORECASE)
_USUAL_PORTS = {"http": 80, "https": 443}
_LONGEST_SHOWN = 200  # characters of what a stranger sent
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
    that was made to resolve to this machine (DNS rebinding) would pass for it. Behind a proxy both
    are the proxy's name, or only `Origin` is. What else a proxy adds (`X-Forwarded-Host` and the
    like) repeats what it was told, and is not believed.

    Attributes:
        host: Address that the server listens on.
        token: Only who knows it is let in; None lets in all who can reach the server.
        names: Under which a proxy reaches it, each with a port or None; see `parse_name`.
    """

    host: str
    token: str | None = None
    names: Collection[Name] = ()

    @classmethod
    def to_host(cls, host: str, private: bool = False, names: Collection[Name] = ()) -> Access:
        """With a new token if other machines reach `host`, or if `private` asks for one."""
        host = plain_address(host)
        demanded = private or not is_loopback(host)
        return cls(host, secrets.token_urlsafe() if demanded else None, names)

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
        stranger = self.stranger(request, port)
        if stranger is not None:
            return stranger
        kept = _cookie(request, _cookie_name(request, port))
        if not (self._is_token(_given_token(request)) or self._is_token(kept)):
            return "expected the token; open the whole address that geswarm-ui printed"
        return None

    def stranger(self, request: Request, port: int) -> str | None:
        """As `refusal`, for where a request comes from alone; the token may still be missing."""
        hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        host = parse_authority(hosts[0]) if len(hosts) == 1 else None
        if host is None:
            return "expected exactly one Host header with a host name and port"
        if not self._ours(host):
            return self._foreign_host(host[0], port)
        if len(origins) > 1:
            return "expected at most one Origin header"
        if origins and not self._same_origin(origins[0], hosts[0]):
            return _foreign_origin(origins[0], hosts[0])
        return None

    def cookie(self, request: Request, port: int) -> dict[str, str]:
        """A header that gives a browser the token to keep, if its request brought it.

        What the page asks for then carries it too: scripts, frames and websockets.

        Args:
            request: What was asked for, and let in.
            port: The port that it came in on.
        """
        if self.token is None or not self._is_token(_given_token(request)):
            return {}
        pair = f"{_cookie_name(request, port)}={self.token}"
        return {"Set-Cookie": f"{pair}; Path=/; HttpOnly; SameSite=Strict"}

    def _is_token(self, given: str) -> bool:
        if self.token is None:
            return True
        return hmac.compare_digest(given.encode(errors="replace"), self.token.encode())

    def _ours(self, host: Name) -> bool:
        name, port = host
        # Any port will do: one forwarded through ssh or a container differs from ours.
        ports = _USUAL_PORTS.values() if port is None else {port}
        if is_loopback(name) or self._named(name, ports):
            return True
        # An IP address cannot be rebound.
        return not self.loopback and (_is_ip_address(name) or name in self._own_names())

    def _same_origin(self, given: str, host: str) -> bool:
        """True for pages of the address that was asked, or of a proxy's that stands for it."""
        origin = parse_origin(given)
        if origin is None:
            return False
        usual = _usual_port(given)
        if origin == parse_authority(host, usual) or origin in self.names:
            return True
        # Other ports of the proxy's machine are other people's pages.
        return origin[1] == usual and (origin[0], None) in self.names

    def _named(self, name: str, ports: Collection[int]) -> bool:
        return any(known == name and (port is None or port in ports) for known, port in self.names)

    def _own_names(self) -> set[str]:
        return {self.host.lower(), socket.gethostname().lower(), socket.getfqdn().lower()}

    def _foreign_host(self, name: str, port: int) -> str:
        place = f"http://127.0.0.1:{port}" if self.loopback else "this machine's IP address"
        shown = format_name((name, None))
        return f"this app does not answer to {shown}; open it at {place}{_or_allow(shown)}"


def _foreign_origin(given: str, host: str) -> str:
    origin, place = parse_origin(given), f"http://{host}"
    shown = given.encode("ascii", "backslashreplace").decode()[:_LONGEST_SHOWN]
    hint = ""
    if origin is not None:
        name, port = origin
        hint = _or_allow(format_name((name, None if port == _usual_port(given) else port)))
    return f"pages of {shown} may not use this app; open it at {place}{hint}"


def _or_allow(name: str) -> str:
    return f"; or, if you come through a proxy of your own, start with --allow-host {name}"


def _given_token(request: Request) -> str:
    """The token in the address, empty if there is none."""
    return parse_qs(request.path.partition("?")[2]).get("token", [""])[0]


def _cookie(request: Request, name: str) -> str:
    """The cookie of that name, empty if there is none."""
    pairs = (
        pair.strip().partition("=")
        for header in request.headers.get_all("Cookie")
        for pair in header.split(";")
    )
    return next((value for key, _, value in pairs if key == name), "")


def _cookie_name(request: Request, port: int) -> str:
    """Tells dashboards apart that a browser sees under one host name.

    Cookies are kept by host alone: two ports of one machine differ in the first number, two behind
    one proxy in the machine or the second.
    """
    host = parse_authority(request.headers["Host"])
    machine = re.sub(r"[^a-z0-9.-]", "", socket.gethostname().lower())
    return f"geswarm-{(host and host[1]) or 'usual'}-{machine}-{port}"


def parse_authority(text: str, default_port: int | None = None) -> Name | None:
    """The name and port of `host[:port]`, or None if it is not one.

    What is the same to a browser is the same here: case, a dot at the end, and the ways to write
    an IPv6 address do not matter.
    """
    match = _AUTHORITY.fullmatch(text.strip())
    if match is None:
        return None
    name, port = match[1].lower(), int(match[2]) if match[2] else default_port
    if not name.startswith("["):
        return name.removesuffix(".") or name, port
    try:
        return str(IPv6Address(name[1:-1])), port
    except ValueError:
        return None


def parse_name(text: str) -> Name:
    """What a user says the dashboard is called: `host` or `host:port`, as in a browser's address.

    Raises:
        ValueError: It is something else.
    """
    text = text.strip()
    if _is_ip_address(text) and ":" in text:
        text = f"[{text}]"
    try:
        name = parse_authority(text.encode("idna").decode() if not text.isascii() else text)
    except UnicodeError:
        name = None
    if name is None or not (name[1] is None or 0 < name[1] < 65536):
        raise ValueError(
            f"expected a host name, and :PORT if it is reached there, as in lab.example.org or "
            f"lab.example.org:8443, got {text!r}"
        )
    return name


def format_name(name: Name) -> str:
    """`host` or `host:port`, an IPv6 address in brackets."""
    host = f"[{name[0]}]" if ":" in name[0] else name[0]
    return host if name[1] is None else f"{host}:{name[1]}"


def parse_origin(text: str) -> Name | None:
    """The host and port of an `Origin` header, or None (`null`, a file, another scheme)."""
    match = _ORIGIN.fullmatch(text.strip())
    return match and parse_authority(match[2], _usual_port(text))


def _usual_port(origin: str) -> int:
    """The port of an origin that says none."""
    return _USUAL_PORTS[origin.strip().partition(":")[0].lower()]


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


def plain_address(host: str) -> str:
    """An address as browsers write it, 127.0.0.1 for 127.1 or 0x7f000001; names are left alone."""
    try:
        found = socket.getaddrinfo(host, None, flags=socket.AI_NUMERICHOST)
    except (OSError, UnicodeError):
        return host
    return str(found[0][4][0])


def is_loopback(host: str) -> bool:
    """True for localhost and the loopback addresses."""
    return host.lower() == "localhost" or (_is_ip_address(host) and ip_address(host).is_loopback)


def _is_ip_address(host: str) -> bool:
    try:
        ip_address(host)
    except ValueError:
        return False
    return True
