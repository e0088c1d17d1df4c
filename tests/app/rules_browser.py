"""The rule table page in a real browser, and what a user does there."""

import pytest

from tests.app.rules_server import RulesServer

sync_api = pytest.importorskip("playwright.sync_api")
expect = sync_api.expect

GONE = ("WebSocket connection", "ERR_CONNECTION_REFUSED")
"""What a browser says when the server has stopped."""


@pytest.fixture(name="server")
def server_fixture():
    with RulesServer() as server:
        yield server


@pytest.fixture(name="page")
def page_fixture(browser, server):
    """The page with EVO 8 in it; nothing in it may complain, a blocked script or style included."""
    context = browser.new_context(viewport={"width": 560, "height": 660})
    page = context.new_page()
    complaints = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on(
        "console",
        lambda message: (
            complaints.append(message.text)
            if message.type == "error" and not any(map(message.text.__contains__, GONE))
            else None
        ),
    )
    page.goto(server.address)
    expect(page.get_by_test_id("rule-4")).to_be_visible()
    yield page
    context.close()
    assert complaints == []


def term(name, *arguments):
    return {"name": name, "arguments": list(arguments)}


def precondition(name, value):
    return {"percept": term(name), "value": value, "comparison": "=="}


def changes(p, behaviour):
    return {"p": p, "behaviour": term(behaviour)}


def sets(p, state, value):
    return {"p": p, "state": state, "value": value, "operation": "="}


def choose(page, opener, choice):
    page.get_by_test_id(opener).click()
    page.get_by_test_id(f"choice-{choice}").click()


def sees_edit(page, server, edit):
    """Wait for the last edit that reached the server."""
    for _ in range(100):
        if server.edits and server.edits[-1] == edit:
            return
        page.wait_for_timeout(20)
    assert server.edits[-1:] == [edit]


def tells(page, server, message):
    """Wait until the last message that reached the server is this one."""
    for _ in range(100):
        if server.received and server.received[-1] == message:
            return
        page.wait_for_timeout(20)
    assert server.received[-1:] == [message]
