"""A scenario's robots are one of the known bodies, with whose numbers it runs."""

import pytest

from geswarm.sim import ScenarioError, load_scenario, parse_scenario
from geswarm.sim.bodies import BODIES, E_PUCK, FOOT_BOT
from geswarm.sim.controllers.encoding import scenario_numbers


def test_robots_are_foot_bots_unless_a_scenario_says_otherwise():
    assert load_scenario("paper").robot is FOOT_BOT
    assert "body:" not in load_scenario("aac").to_yaml()


def test_a_body_survives_being_written():
    scenario = load_scenario("epuck-aac")
    assert scenario.robot is E_PUCK
    assert parse_scenario(scenario.to_yaml()).robot is E_PUCK


def test_an_unknown_body_is_refused():
    with pytest.raises(ScenarioError, match="expected foot-bot or e-puck, got the text"):
        parse_scenario("extends: aac\nbody: e-pucks\n")


@pytest.mark.parametrize("body", BODIES.values(), ids=lambda body: body.name)
def test_kernels_take_the_numbers_of_the_body(body):
    name = "epuck-aac" if body is E_PUCK else "aac"
    numbers = scenario_numbers(load_scenario(name))
    assert (numbers["radius"], numbers["wheel_base"]) == (body.radius, body.wheel_base)


def test_a_scenario_may_give_other_numbers_for_a_body():
    text = "extends: epuck-aac\nnumbers: {rab_loss: 0.9}\n"
    numbers = scenario_numbers(parse_scenario(text))
    assert (numbers["rab_loss"], numbers["wheel_noise"]) == (0.9, 0.05)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"robots": 65}, "expected at most 64 e-pucks, got 65"),
        ({"objects": 3}, "e-pucks carry none"),
    ],
)
def test_what_e_pucks_cannot_do_is_refused(change, message):
    with pytest.raises(ScenarioError, match=message):
        load_scenario("epuck-aac").with_changes(**change)
