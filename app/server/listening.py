"""Whether a server can listen at an address, and if not, why."""

from __future__ import annotations

import errno
import os
import socket
from ipaddress import ip_address

_NOBODY_COMES = (errno.ENETUNREACH, errno.EHOSTUNREACH, errno.EACCES, errno.EADDRNOTAVAIL)
"""How a connection fails to an address that is everybody's: broadcast or multicast."""


class ServerError(RuntimeError):
    """The dashboard's server cannot be started; the text says why."""


def free_port(host: str, port: int) -> int:
    """The port, or the next one that is not busy.

    Raises:
        ServerError: For another reason, with which viser's constructor would wait for ever or go
            on to the next port, too.
    """
    if not 0 <= port <= 65535:
        raise ServerError(f"port: expected 0 to 65535, got {port}")
    for candidate in range(port, 65536):
        try:
            _listen(host, candidate)
        except UnicodeError as error:
            raise ServerError(f"host: expected a name or an address, got {host!r}") from error
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise ServerError(_why_not(host, candidate, error)) from error
        else:
            return candidate
    raise ServerError(f"port: expected a free one, but all from {port} to 65535 are busy")


def _listen(host: str, port: int) -> None:
    """Listen for a moment, in the same way as asyncio's servers, and see whether one can come."""
    for family, _, _, _, address in socket.getaddrinfo(
        host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
    ):
        with socket.create_server(address, family=family) as server:
            if not ip_address(address[0]).is_unspecified:
                _require_reachable(host, server)


def _require_reachable(host: str, server: socket.socket) -> None:
    """Raise ServerError where one can listen and nobody can connect; slow machines pass."""
    with socket.socket(server.family, socket.SOCK_STREAM) as visitor:
        visitor.setblocking(False)
        failed = visitor.connect_ex(server.getsockname())
    if failed in _NOBODY_COMES:
        raise ServerError(
            f"host: nobody could connect to {host!r}: {os.strerror(failed)}, as with addresses "
            "that stand for many machines; expected one of this machine, or 0.0.0.0 for all of it"
        )


def _why_not(host: str, port: int, error: OSError) -> str:
    """Why the server cannot listen there: each cause with its own remedy."""
    reason = os.strerror(error.errno) if error.errno else str(error)
    if isinstance(error, PermissionError):
        below = ": ports below 1024 are the administrator's" if port < 1024 else ""
        return f"port: cannot listen on {port}: {reason}{below}; choose another one with --port"
    if isinstance(error, socket.gaierror):
        reason = f"no address is known for this name ({error.strerror})"
    elif error.errno == errno.EADDRNOTAVAIL:
        reason = "this is not an address of this machine"
    return f"host: cannot listen on {host!r}: {reason}"
