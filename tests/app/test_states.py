"""The state machine of the edited rules, drawn in the background, and the swarm in it."""

import time
from xml.etree import ElementTree

import numpy as np
import pytest

from geswarm.app.panels import rule_messages
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.app.state.states import MachineDrawer
from geswarm.rules import FORAGING, StateMachine, load_preset, parse_text
from geswarm.sim import World, load_scenario
from tests.app.wire import as_read, typed

EVO8, HAND_CODED = load_preset("evo8"), load_preset("hand-coded")
PAPER = load_scenario("paper")


@pytest.fixture
def drawer():
    drawer = MachineDrawer()
    yield drawer
    drawer.close()


def drawn(drawer, rule_set, seconds=30):
    """Wait for the picture of a rule set."""
    end = time.monotonic() + seconds
    while drawer.drawn is None or drawer.drawn.rule_set is not rule_set:
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.01)
    return drawer.drawn


def test_the_newest_rules_are_drawn(drawer):
    for rule_set in (EVO8, HAND_CODED, EVO8, HAND_CODED):
        drawer.draw(rule_set, FORAGING)
    picture = drawn(drawer, HAND_CODED)
    assert picture.machine == StateMachine.of(HAND_CODED)
    space = "{http://www.w3.org/2000/svg}"
    groups = ElementTree.fromstring(picture.svg).iter(f"{space}g")
    kinds = [group.get("class") for group in groups]
    assert kinds.count("state") == 3
    assert kinds.count("transition") == len(picture.machine.transitions)


def test_the_swarm_is_seen_only_in_the_machine_of_its_rules(drawer):
    world = World(PAPER, EVO8, 1)
    assert drawer.activity(world) is None
    drawer.draw(EVO8, FORAGING)
    machine = drawn(drawer, EVO8).machine
    world.step(3000)
    activity = drawer.activity(world)
    assert sum(activity.robots) == 4
    assert list(activity.taken) == machine.times_taken(world.decisions).tolist()
    assert sum(activity.taken) > 10
    world.set_rules(HAND_CODED)
    assert drawer.activity(world) is None


def test_every_transition_is_counted_at_any_speed():
    """In one go as in single steps: nothing is lost between two frames."""
    machine = StateMachine.of(EVO8)
    slow, fast = (World(PAPER, EVO8, 1) for _ in range(2))
    seen = np.zeros(len(machine.transitions), dtype=np.int64)
    for _ in range(2000):
        before = machine.times_taken(slow.decisions)
        slow.step()
        seen += machine.times_taken(slow.decisions) - before
    fast.step(2000)
    assert seen.tolist() == machine.times_taken(fast.decisions).tolist()


def test_a_session_draws_what_its_swarm_runs():
    session = Session(PAPER.with_changes(duration=50.0), EVO8, EvolutionThread(workers=1))
    try:
        drawn(session.machine, EVO8)
        session.edit(typed({"do": "set_comment", "rule": 0, "comment": "other words"}))
        assert session.machine.activity(session.world) is not None
        session.load(HAND_CODED)
        assert drawn(session.machine, HAND_CODED).machine == StateMachine.of(HAND_CODED)
        session.world.step(10)
        assert sum(session.machine.activity(session.world).robots) == 4
    finally:
        session.close()


def test_what_pages_are_told_of_states_and_transitions(drawer):
    rule_set = parse_text("rule if ON_NEST == true do p = 0.1, WANT_OBJECT = false")
    drawer.draw(rule_set, FORAGING)
    message = as_read(rule_messages.states_message(drawn(drawer, rule_set)))
    assert [state["means"] for state in message["states"]] == [
        "walking at random, WANT_OBJECT is false",
        "walking at random, WANT_OBJECT is true",
    ]
    assert [state["initial"] for state in message["states"]] == [False, True]
    assert message["transitions"] == [
        {
            "source": 1,
            "target": 0,
            "when": "ON_NEST",
            "rate": "p = 0.1, 1 s",
            "effects": [],
            "rules": [1],
            "words": "RANDOM_WALK, WANT_OBJECT to RANDOM_WALK, not WANT_OBJECT when ON_NEST: "
            "p = 0.1, 1 s",
        }
    ]
    world = World(PAPER, rule_set, 1)
    world.step(5)
    told = as_read(rule_messages.activity_message(drawer.activity(world), world))
    assert (told["time"], told["swarm"], sum(told["robots"])) == (pytest.approx(0.5), 4, 4)
