import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.datastructures import Headers, is_valid_header_value
from websockets.http11 import Request

from geswarm.app.server.access import (
    Access,
    is_loopback,
    machine_address,
    parse_authority,
    parse_origin,
)

PORT = 8080
HERE = Access("127.0.0.1")
EVERYWHERE = Access("0.0.0.0")


def asks(host=None, origin=None, path="/", cookie=None):
    pairs = {"Host": host, "Origin": origin, "Cookie": cookie}
    given = Headers({name: value for name, value in pairs.items() if value is not None})
    return Request(path, given)


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


def test_default_ports():
    assert Access("127.0.0.1").refusal(asks("localhost", "http://localhost"), 80) is None


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
    parse_origin(text)


def test_loopback():
    assert all(map(is_loopback, ["localhost", "127.0.0.1", "127.1.2.3", "::1"]))
    assert not any(map(is_loopback, ["0.0.0.0", "::", "10.0.0.1", "example.org", ""]))


# Token

LOCKED = Access.to_host("0.0.0.0")
AT = "192.168.0.7:8080"


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
    kept = LOCKED.cookie(first)["Set-Cookie"]
    pair, *attributes = kept.split("; ")
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
        ("/", "geswarm-8080="),
        ("/", "geswarm-8080=wrong"),
        ("/", "geswarm-8080=\xff"),
        ("/", "geswarm-8081={token}"),
        ("/", "{token}"),
    ],
)
def test_without_the_token_nobody_is_let_in_and_no_cookie_given(path, cookie):
    token = LOCKED.token
    request = asks(AT, path=path.format(token=token), cookie=cookie and cookie.format(token=token))
    refusal = LOCKED.refusal(request, PORT)
    assert "expected the token" in refusal
    assert token not in refusal
    assert "\n" not in refusal
    assert LOCKED.cookie(request) == {}


@given(st.text(), HEADER_VALUES)
def test_no_address_and_no_cookie_breaks_the_check(path, cookie):
    assert "expected the token" in LOCKED.refusal(asks(AT, path=path, cookie=cookie), PORT)


def test_the_token_does_not_help_pages_of_others():
    path = f"/?token={LOCKED.token}"
    assert "evil.example" in LOCKED.refusal(asks(AT, "http://evil.example", path), PORT)
    assert "evil.example" in LOCKED.refusal(asks("evil.example:8080", path=path), PORT)


def test_two_dashboards_of_one_host_keep_their_tokens_apart():
    other = Access.to_host("0.0.0.0")
    cookies = [
        access.cookie(asks(host, path=f"/?token={access.token}"))["Set-Cookie"].split(";")[0]
        for access, host in ((LOCKED, "192.168.0.7:8080"), (other, "192.168.0.7:8081"))
    ]
    assert LOCKED.refusal(asks("192.168.0.7:8080", cookie="; ".join(cookies)), PORT) is None
    assert other.refusal(asks("192.168.0.7:8081", cookie="; ".join(cookies)), PORT) is None


def test_the_address_to_open_is_one_that_can_be_opened():
    assert machine_address("127.0.0.1") == "127.0.0.1"
    assert machine_address("::1") == "[::1]"
    for everywhere in ("0.0.0.0", "::"):
        shown = machine_address(everywhere)
        assert shown not in ("0.0.0.0", "[::]")
        assert EVERYWHERE.refusal(asks(f"{shown}:8080"), PORT) is None
