import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.datastructures import Headers, is_valid_header_value

from geswarm.app.server.access import Access, is_loopback, parse_authority, parse_origin

PORT = 8080
HERE = Access("127.0.0.1")
EVERYWHERE = Access("0.0.0.0")


def headers(host=None, origin=None):
    pairs = {"Host": host, "Origin": origin}
    return Headers({name: value for name, value in pairs.items() if value is not None})


@pytest.mark.parametrize(
    "host",
    ["127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080", "localhost:9000"],
)
def test_loopback_hosts_are_let_in(host):
    assert HERE.refusal(headers(host), PORT) is None
    assert HERE.refusal(headers(host, f"http://{host}"), PORT) is None


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
    refusal = HERE.refusal(headers(host), PORT)
    assert refusal
    assert "\n" not in refusal


def test_two_hosts_are_refused():
    both = Headers([("Host", "127.0.0.1:8080"), ("Host", "127.0.0.1:8080")])
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
    assert HERE.refusal(headers("127.0.0.1:8080", origin), PORT)


def test_default_ports():
    assert Access("127.0.0.1").refusal(headers("localhost", "http://localhost"), 80) is None


@pytest.mark.parametrize("host", ["192.168.0.7:8080", "[fd00::7]:9000", "localhost:9000"])
def test_an_open_server_answers_to_ip_addresses(host):
    assert EVERYWHERE.refusal(headers(host, f"http://{host}"), PORT) is None


def test_an_open_server_still_refuses_rebound_names_and_foreign_pages():
    assert EVERYWHERE.refusal(headers("evil.example:8080"), PORT)
    assert EVERYWHERE.refusal(headers("192.168.0.7:8080", "http://evil.example"), PORT)


HEADER_VALUES = st.text(st.characters(max_codepoint=255)).filter(is_valid_header_value)


@given(HEADER_VALUES, st.none() | HEADER_VALUES)
def test_no_header_breaks_the_check(host, origin):
    refusal = HERE.refusal(headers(host, origin), PORT)
    assert refusal is None or refusal


@given(st.text())
def test_parsers_take_any_text(text):
    assert parse_authority(text, 80) is None or parse_authority(text, 80)[0]
    parse_origin(text)


def test_loopback():
    assert all(map(is_loopback, ["localhost", "127.0.0.1", "127.1.2.3", "::1"]))
    assert not any(map(is_loopback, ["0.0.0.0", "::", "10.0.0.1", "example.org", ""]))
