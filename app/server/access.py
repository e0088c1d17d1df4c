"""Who may talk to the dashboard: the one check that every request passes, pages and websockets."""

from __future__ import annotations

import re
import socket
from dataclasses import dataclass
from ipaddress import ip_address
from typing import TypeAlias

from websockets.datastructures import Headers

Address: TypeAlias = tuple[str, int]

_AUTHORITY = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(?::([0-9]{1,5}))?", re.IGNORECASE)
_ORIGIN = re.compile(r"(https?)://(.+)", re.IGNORECASE)
_DEFAULT_PORTS = {"http": 80, "https": 443}


@dataclass(frozen=True)
class Access:
    """The rules of admission for a server bound to `host`.

    A page of another site must neither read nor command the app: the browser's `Origin` must be
    the address that the request went to, and that address must be one of ours, or a foreign name
    that was made to resolve to this machine (DNS rebinding) would pass for it.
    """

    host: str

    @property
    def loopback(self) -> bool:
        """True if the server can be reached from this machine only."""
        return is_loopback(self.host)

    def refusal(self, headers: Headers, port: int) -> str | None:
        """Why a request is refused, in one line, or None if it is let in.

        Args:
            headers: The request's headers.
            port: The port that it came in on.
        """
        hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
        target = parse_authority(hosts[0], 80) if len(hosts) == 1 else None
        if target is None:
            return "expected exactly one Host header with a host name and port"
        if not self._ours(target[0]):
            return self._foreign_host(hosts[0], port)
        if len(origins) > 1:
            return "expected at most one Origin header"
        if origins and parse_origin(origins[0]) != target:
            return f"pages of {origins[0]} may not use this app; open it at http://{hosts[0]}"
        return None

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


def is_loopback(host: str) -> bool:
    """True for localhost and the loopback addresses."""
    return host.lower() == "localhost" or (_is_ip_address(host) and ip_address(host).is_loopback)


def _is_ip_address(host: str) -> bool:
    try:
        ip_address(host)
    except ValueError:
        return False
    return True
