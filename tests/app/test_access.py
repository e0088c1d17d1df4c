import contextlib
import socket

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.datastructures import Headers, is_valid_header_value
from websockets.http11 import Request

from geswarm.app.server.access import (
    Access,
    format_name,
    is_loopback,
    machine_address,
    parse_authority,
    parse_name,
    parse_origin,
)

PORT = 8080
HERE = Access("127.0.0.1")
EVERYWHERE = Access("0.0.0.0")


def asks(host=None, origin=None, path="/", cookie=None):
    pairs = {"Host": host, "Origin": origin, "Cookie": cookie}
    given = Headers({name: value for name, value in pairs.items() if value is not None})
    return Request(path, given)


def kept(access, host, port=PORT):
    """What a browser sends as a cookie once it has opened the address with the token."""
    given = access.cookie(asks(host, path=f"/?token={access.token}"), port)
    return given["Set-Cookie"].partition(";")[0]


@pytest.mark.parametrize(
    "host",
    ["127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080", "localhost:9000"],
)
def test_loopback_hosts_are_let_in(host):
    assert HERE.refusal(asks(host), PORT) is None
    assert HERE.refusal(asks(host, f"http://{host}"), PORT) is None


@pytest.mark.parametrize(
    "host",
    [
        None,
        "",
        "evil.example:8080",
        "127.0.0.1.evil.example:8080",
        "localhost.evil.example:8080",
        "192.168.0.7:8080",
        "user@127.0.0.1:8080",
        "127.0.0.1:8080/path",
        "[::1:8080",
        "127.0.0.1:8080, evil.example",
    ],
)
def test_other_hosts_are_refused_in_one_line(host):
    refusal = HERE.refusal(asks(host), PORT)
    assert refusal
    assert "\n" not in refusal


def test_two_hosts_are_refused():
    both = Request("/", Headers([("Host", "127.0.0.1:8080"), ("Host", "127.0.0.1:8080")]))
    assert "exactly one" in HERE.refusal(both, PORT)


@pytest.mark.parametrize(
    "origin",
    [
        "null",
        "",
        "http://evil.example",
        "http://127.0.0.1",
        "http://127.0.0.1:3000",
        "http://localhost:8080",
        "file://",
        "http://127.0.0.1:8080.evil.example",
    ],
)
def test_other_origins_are_refused(origin):
    assert HERE.refusal(asks("127.0.0.1:8080", origin), PORT)


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("localhost", "http://localhost"),
        ("localhost", "https://localhost"),
        ("localhost:443", "https://localhost"),
        ("localhost", "https://localhost:443"),
        ("localhost:8443", "https://localhost:8443"),
        ("localhost.:8080", "http://localhost:8080"),
        ("[0:0:0:0:0:0:0:1]:8080", "http://[::1]:8080"),
    ],
)
def test_what_a_browser_takes_for_one_address_is_one(host, origin):
    assert HERE.refusal(asks(host, origin), PORT) is None


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("localhost", "https://localhost:80"),
        ("localhost", "https://localhost:8443"),
        ("localhost:80", "https://localhost"),
        ("localhost:443", "http://localhost"),
        ("localhost", "ftp://localhost"),
    ],
)
def test_another_port_of_the_same_name_is_another_address(host, origin):
    assert HERE.refusal(asks(host, origin), PORT)


# Other names

LAB = "lab.example.org"


def called(*names, host="127.0.0.1"):
    return Access(host, names=[parse_name(name) for name in names])


@pytest.mark.parametrize(
    ("name", "host", "origin"),
    [
        (LAB, LAB, f"https://{LAB}"),
        (LAB, LAB, f"http://{LAB}"),
        (LAB, "LAB.example.org", f"https://{LAB}"),
        (LAB, f"{LAB}.", f"https://{LAB}."),
        (f"{LAB}.", LAB, f"https://{LAB}"),
        (LAB.upper(), LAB, f"https://{LAB}"),
        (LAB, f"{LAB}:8443", f"https://{LAB}:8443"),
        (f"{LAB}:8443", f"{LAB}:8443", f"https://{LAB}:8443"),
        (f"{LAB}:443", LAB, f"https://{LAB}"),
        # Proxies that do not pass the name on
        (LAB, "127.0.0.1:8080", f"https://{LAB}"),
        (LAB, "localhost:8080", f"http://{LAB}"),
        (f"{LAB}:8443", "127.0.0.1:8080", f"https://{LAB}:8443"),
        ("localhost:9000", "127.0.0.1:8080", "http://localhost:9000"),
        ("[fd00::7]", "[fd00:0::7]", "https://[fd00::7]"),
        ("fd00::7", "[fd00::7]:8080", "http://[fd00::7]:8080"),
        ("192.168.0.7", "192.168.0.7:8080", "http://192.168.0.7:8080"),
        ("bücher.example", "xn--bcher-kva.example", "https://xn--bcher-kva.example"),
    ],
)
@pytest.mark.parametrize("bound", ["127.0.0.1", "0.0.0.0"])
def test_who_comes_under_a_name_that_was_allowed_is_let_in(bound, name, host, origin):
    assert called("other.example", name, host=bound).refusal(asks(host, origin), PORT) is None
    assert called("other.example", name, host=bound).refusal(asks(host), PORT) is None
    assert called("other.example").refusal(asks(host, origin), PORT)


@pytest.mark.parametrize(
    ("name", "host", "origin"),
    [
        (LAB, "evil.example", None),
        (LAB, f"{LAB}.evil.example", None),
        (LAB, f"evil.{LAB}", None),
        (LAB, f"evil{LAB}", None),
        (f"{LAB}:8443", f"{LAB}:9000", None),
        (f"{LAB}:8443", LAB, None),
        (LAB, LAB, "https://evil.example"),
        (LAB, LAB, "null"),
        (LAB, "127.0.0.1:8080", "https://evil.example"),
        (LAB, "127.0.0.1:8080", f"https://evil.{LAB}"),
        (LAB, "127.0.0.1:8080", f"https://{LAB}:8443"),
        (LAB, "127.0.0.1:8080", f"https://{LAB}:80"),
        (f"{LAB}:8443", "127.0.0.1:8080", f"https://{LAB}"),
        (LAB, LAB, f"https://{LAB}:8443"),
        (LAB, "127.0.0.1:8080", "http://localhost:8080"),
    ],
)
def test_a_name_that_was_allowed_lets_in_no_other(name, host, origin):
    assert called(name).refusal(asks(host, origin), PORT)


@pytest.mark.parametrize(
    ("host", "origin", "name"),
    [
        (LAB, None, LAB),
        (f"{LAB}:8443", f"https://{LAB}:8443", LAB),
        ("127.0.0.1:8080", f"https://{LAB}", LAB),
        ("127.0.0.1:8080", f"http://{LAB}:9000", f"{LAB}:9000"),
        ("127.0.0.1:8080", "https://[fd00::7]", "[fd00::7]"),
    ],
)
def test_a_refusal_names_the_option_that_helps(host, origin, name):
    refusal = HERE.refusal(asks(host, origin), PORT)
    assert refusal.endswith(f"start with --allow-host {name}")
    assert called(name).refusal(asks(host, origin), PORT) is None


def test_what_a_proxy_adds_is_not_believed():
    forwarded = Headers(
        [("X-Forwarded-Host", "127.0.0.1:8080"), ("Forwarded", "host=127.0.0.1:8080")]
    )
    forwarded["Host"] = "evil.example"
    assert HERE.refusal(Request("/", forwarded), PORT)
    forwarded = Headers([("X-Forwarded-Host", "evil.example"), ("X-Forwarded-Proto", "https")])
    forwarded["Host"], forwarded["Origin"] = "127.0.0.1:8080", "https://evil.example"
    assert HERE.refusal(Request("/", forwarded), PORT)


@pytest.mark.parametrize(
    "name",
    [
        "",
        "*",
        "*.example.org",
        f"https://{LAB}",
        f"{LAB}/path",
        f"{LAB}:",
        f"{LAB}:0",
        "a b",
        "[::",
    ],
)
def test_what_is_no_name_is_refused_with_what_was_expected(name):
    with pytest.raises(ValueError, match="expected a host name") as error:
        parse_name(name)
    assert repr(name) in str(error.value)


@pytest.mark.parametrize("name", [LAB, f"{LAB}:8443", "[fd00::7]:9000", "[fd00::7]"])
def test_names_are_written_as_they_are_read(name):
    assert format_name(parse_name(name)) == name


@pytest.mark.parametrize("host", ["192.168.0.7:8080", "[fd00::7]:9000", "localhost:9000"])
def test_an_open_server_answers_to_ip_addresses(host):
    assert EVERYWHERE.refusal(asks(host, f"http://{host}"), PORT) is None


def test_an_open_server_still_refuses_rebound_names_and_foreign_pages():
    assert EVERYWHERE.refusal(asks("evil.example:8080"), PORT)
    assert EVERYWHERE.refusal(asks("192.168.0.7:8080", "http://evil.example"), PORT)


HEADER_VALUES = st.text(st.characters(max_codepoint=255)).filter(is_valid_header_value)


@given(HEADER_VALUES, st.none() | HEADER_VALUES)
def test_no_header_breaks_the_check(host, origin):
    refusal = HERE.refusal(asks(host, origin), PORT)
    assert refusal is None or refusal


@given(st.text())
def test_parsers_take_any_text(text):
    assert parse_authority(text, 80) is None or parse_authority(text, 80)[0]
    with contextlib.suppress(ValueError):
        assert parse_name(text)[0]
    parse_origin(text)


def test_loopback():
    assert all(map(is_loopback, ["localhost", "127.0.0.1", "127.1.2.3", "::1"]))
    assert not any(map(is_loopback, ["0.0.0.0", "::", "10.0.0.1", "example.org", ""]))


# Token

LOCKED = Access.to_host("0.0.0.0")
AT = "192.168.0.7:8080"


@pytest.mark.parametrize(
    ("host", "plain"),
    [
        ("0", "0.0.0.0"),
        ("127.1", "127.0.0.1"),
        ("0x7f000001", "127.0.0.1"),
        ("::0", "::"),
        ("0:0::1", "::1"),
        ("localhost", "localhost"),
        ("no.such.host.invalid", "no.such.host.invalid"),
        ("x..y", "x..y"),
    ],
)
def test_an_address_is_written_as_browsers_write_it(host, plain):
    access = Access.to_host(host)
    assert access.host == plain
    assert (access.token is None) == is_loopback(plain)


def test_a_token_is_demanded_where_other_machines_can_come_or_on_request():
    assert Access.to_host("127.0.0.1").token is None
    assert Access.to_host("localhost").token is None
    tokens = [Access.to_host(host).token for host in ("0.0.0.0", "::", "192.168.0.7")]
    tokens.append(Access.to_host("127.0.0.1", private=True).token)
    assert len(set(tokens)) == 4
    assert min(map(len, tokens)) >= 43  # 256 bits


def test_the_token_in_the_address_lets_in_and_is_kept_in_a_cookie():
    first = asks(AT, path=f"/?token={LOCKED.token}")
    assert LOCKED.refusal(first, PORT) is None
    pair, *attributes = LOCKED.cookie(first, PORT)["Set-Cookie"].split("; ")
    assert set(attributes) == {"Path=/", "HttpOnly", "SameSite=Strict"}
    assert LOCKED.refusal(asks(AT, path="/rules/socket", cookie=pair), PORT) is None
    among_others = f'_xsrf=2|a; theme; {pair}; x="y;z"'
    assert LOCKED.refusal(asks(AT, cookie=among_others), PORT) is None


@pytest.mark.parametrize(
    ("path", "cookie"),
    [
        ("/", None),
        ("/?token=", None),
        ("/?token=wrong", None),
        ("/?token=%FF%00\udcff", None),
        ("/?tokens={token}", None),
        ("/{token}", None),
        ("/?token=x&token={token}", None),
        ("/", "{name}="),
        ("/", "{name}=wrong"),
        ("/", "{name}=\xff"),
        ("/", "{name}1={token}"),
        ("/", "{token}"),
    ],
)
def test_without_the_token_nobody_is_let_in_and_no_cookie_given(path, cookie):
    token, name = LOCKED.token, kept(LOCKED, AT).partition("=")[0]
    cookie = cookie and cookie.format(token=token, name=name)
    request = asks(AT, path=path.format(token=token), cookie=cookie)
    refusal = LOCKED.refusal(request, PORT)
    assert "expected the token" in refusal
    assert token not in refusal
    assert "\n" not in refusal
    assert LOCKED.cookie(request, PORT) == {}


@given(st.text(), HEADER_VALUES)
def test_no_address_and_no_cookie_breaks_the_check(path, cookie):
    assert "expected the token" in LOCKED.refusal(asks(AT, path=path, cookie=cookie), PORT)


def test_the_token_does_not_help_pages_of_others():
    path = f"/?token={LOCKED.token}"
    assert "evil.example" in LOCKED.refusal(asks(AT, "http://evil.example", path), PORT)
    assert "evil.example" in LOCKED.refusal(asks("evil.example:8080", path=path), PORT)


@pytest.mark.parametrize(
    ("host", "port", "machine"),
    [
        ("192.168.0.7:8081", 8081, "node1"),
        ("192.168.0.7:8081", 8080, "node1"),
        (AT, 8081, "node1"),
        (AT, 8080, "node2"),
    ],
    ids=["beside", "through ssh", "behind one proxy", "on another machine behind it"],
)
def test_two_dashboards_of_one_host_keep_their_tokens_apart(monkeypatch, host, port, machine):
    other = Access.to_host("0.0.0.0")
    monkeypatch.setattr(socket, "gethostname", lambda: "node1")
    mine = kept(LOCKED, AT, 8080)
    monkeypatch.setattr(socket, "gethostname", lambda: machine)
    cookies = f"{mine}; {kept(other, host, port)}"
    assert other.refusal(asks(host, cookie=cookies), port) is None
    monkeypatch.setattr(socket, "gethostname", lambda: "node1")
    assert LOCKED.refusal(asks(AT, cookie=cookies), 8080) is None


def test_the_address_to_open_is_one_that_can_be_opened():
    assert machine_address("127.0.0.1") == "127.0.0.1"
    assert machine_address("::1") == "[::1]"
    for everywhere in ("0.0.0.0", "::"):
        shown = machine_address(everywhere)
        assert shown not in ("0.0.0.0", "[::]")
        assert EVERYWHERE.refusal(asks(f"{shown}:8080"), PORT) is None
