"""Why a server cannot listen: each cause by its name. See also `test_gate.py`."""

import errno
import socket

import pytest

from geswarm.app.server.listening import ServerError, free_port


def failing(number):
    """A machine on which listening fails in one way."""

    def create_server(address, **options):
        raise OSError(number, "of another language")

    return create_server


def test_a_port_that_is_free_is_taken():
    with socket.create_server(("127.0.0.1", 0)) as busy:
        port = busy.getsockname()[1]
    assert free_port("127.0.0.1", port) == port
    assert free_port("127.0.0.1", 0) == 0


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0"])
def test_a_busy_port_becomes_the_next(host):
    with socket.create_server((host, 0)) as busy:
        port = busy.getsockname()[1]
        assert free_port(host, port) > port


def test_the_last_port_has_no_next(monkeypatch):
    monkeypatch.setattr(socket, "create_server", failing(errno.EADDRINUSE))
    with pytest.raises(ServerError, match="all from 65530 to 65535 are busy"):
        free_port("127.0.0.1", 65530)


@pytest.mark.parametrize(
    ("number", "port", "message"),
    [
        (
            errno.EACCES,
            80,
            "port: cannot listen on 80: Permission denied: ports below 1024 are the "
            "administrator's; choose another one with --port",
        ),
        (
            errno.EACCES,
            8080,
            "port: cannot listen on 8080: Permission denied; choose another one with --port",
        ),
        (
            errno.EADDRNOTAVAIL,
            8080,
            "host: cannot listen on '127.0.0.1': this is not an address of this machine",
        ),
        (errno.EMFILE, 8080, "host: cannot listen on '127.0.0.1': Too many open files"),
    ],
)
def test_each_cause_is_told_and_never_called_busy(number, port, message, monkeypatch):
    monkeypatch.setattr(socket, "create_server", failing(number))
    with pytest.raises(ServerError) as error:
        free_port("127.0.0.1", port)
    assert str(error.value) == message


@pytest.mark.parametrize(
    ("host", "message"),
    [
        ("no.such.host.invalid", "no address is known for this name"),
        ("http://localhost", "no address is known for this name"),
        ("256.1.1.1", "no address is known for this name"),
        ("192.0.2.1", "this is not an address of this machine"),
        ("x..y", "expected a name or an address, got 'x..y'"),
        ("255.255.255.255", "nobody could connect|cannot listen"),
        ("224.0.0.1", "nobody could connect|cannot listen"),
        ("127.255.255.255", "nobody could connect|cannot listen"),
        ("ff02::1", "nobody could connect|cannot listen"),
    ],
)
def test_a_host_that_is_none_is_told(host, message):
    with pytest.raises(ServerError, match=f"host: .*{message}"):
        free_port(host, 0)
