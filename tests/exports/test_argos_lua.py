"""The controller script runs in a real Lua interpreter, step by step beside the Python oracle."""

import importlib
import math
import random
import shutil
import subprocess

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.exports import format_argos_lua
from geswarm.rules import (
    FORAGING,
    BehaviourChange,
    Rule,
    RuleSet,
    load_preset,
    parse_text,
    preset_names,
)
from geswarm.sim import load_scenario
from tests import strategies
from tests.exports.footbot_stub import FootBot, light_direction
from tests.sim import oracle

PAPER = load_scenario("paper")
HALF_TURN = math.pi


class Twins(oracle.Oracle):
    """The oracle's swarm; beside every robot runs a script that senses and draws the same."""

    def __init__(self, scenario, rule_set, seed, monkeypatch):
        script = format_argos_lua(rule_set, scenario)
        keys = [oracle.make_key(seed, 0, 0, i) for i in range(scenario.robots)]
        self.streams = {key: random.Random(str(key)) for key in keys}
        keyed = oracle.draw
        monkeypatch.setattr(
            oracle,
            "draw",
            lambda key, step, purpose: (
                self.streams[key].random()
                if purpose >= oracle.FIRST_ACTION
                else keyed(key, step, purpose)
            ),
        )
        super().__init__(scenario, seed)
        self.decide_alone = oracle.by_rules(rule_set)
        self.scripts = [FootBot(script, str(key)) for key in keys]
        self.steps_compared = self.errors = 0
        self.seen = set()

    def restart_walk(self, robot, step, *_):
        one, two = (self.streams[robot.key].random() for _ in range(2))
        robot.walk = HALF_TURN * (2 * one - 1)  # from the direction of the light
        low, high = self.scenario.random_walk
        robot.walk_until = step + (low + (high - low) * two) * 10

    def target(self, robot, now):
        x, y = super().target(robot, now)
        if robot.behaviour != "RANDOM_WALK":
            return x, y
        angle = light_direction(self.scenario, (robot.x, robot.y, 0)) + robot.walk
        return math.cos(angle), math.sin(angle)

    def decide(self, robot, now):
        at = self.robots.index(robot)
        script = self.scripts[at]
        others = [(other.x, other.y) for other in self.before if other is not self.before[at]]
        script.sense(self.scenario, (robot.x, robot.y, robot.theta), others)
        script.perceive(**robot.percepts)
        script.step()
        restart = self.decide_alone(robot, now)
        decided = {"BEHAVIOUR": robot.behaviour, **robot.states}
        assert {name: script.globals[name] for name in decided} == decided, now
        self.seen.add(tuple(decided.values()))
        return restart

    def move(self, robot, i, poses, now):
        x, y, theta = robot.x, robot.y, robot.theta
        super().move(robot, i, poses, now)
        left, right = self.scripts[i].wheels
        turned = (right - left) / 100 / oracle.WHEEL_BASE * oracle.CONTROL_STEP
        forward = (left + right) / 200 * oracle.CONTROL_STEP
        self.errors += (
            abs(turned - (robot.theta - theta)) > 0.02
            or abs(forward - math.hypot(robot.x - x, robot.y - y)) > 0.0004
        )
        self.steps_compared += 1

    def run(self, steps):
        for _ in range(steps):
            self.before = [oracle.Robot(r.key, r.x, r.y, r.theta) for r in self.robots]
            self.step(self.decide)


# Robots that run `evolved` press against the far wall: target and avoidance nearly cancel there,
# and what is left of their sum differs between 24 rays and the exact distance.
@pytest.mark.parametrize(("preset", "astray"), [("evo8", 0), ("evolved", 30), ("hand-coded", 0)])
def test_a_swarm_of_scripts_does_what_the_oracle_does(preset, astray, monkeypatch):
    crowded = PAPER.with_changes(width=1.6, length=2.4, nest=0.8, source=0.9, robots=4)
    twins = Twins(crowded, load_preset(preset), 3, monkeypatch)
    twins.run(1500)
    assert {behaviour for behaviour, *_ in twins.seen} == set(FORAGING.behaviour_index)
    assert twins.collected > 0
    assert twins.steps_compared == 6000
    assert twins.errors <= astray


PERCEPTS = st.sampled_from([(False, False), (True, False), (False, True)])


@settings(max_examples=60)
@given(
    strategies.plain_rule_sets(),
    st.lists(st.tuples(PERCEPTS, st.booleans()), min_size=1),
    st.integers(0, 99),
)
def test_any_rules_decide_as_the_oracle_does(rule_set, percepts, seed):
    script = FootBot(format_argos_lua(rule_set, PAPER), seed)
    stream = random.Random(seed)
    robot = oracle.Robot((0, 0))
    decide = oracle.by_rules(rule_set)
    walk_until = 0

    def walk(now):
        stream.random()
        return now + (5 + 10 * stream.random()) * 10

    keyed, oracle.draw = oracle.draw, lambda *_: stream.random()
    try:
        walk_until = walk(0)
        for now, ((nest, source), holding) in enumerate(percepts * 20):
            robot.percepts = {"ON_NEST": nest, "ON_SOURCE": source, "HAS_OBJECT": holding}
            robot.states["DROP_OBJECT"] = False
            script.perceive(**robot.percepts)
            script.step()
            if decide(robot, now):
                walk_until = walk(now)
            if robot.behaviour == "RANDOM_WALK" and now >= walk_until:
                walk_until = walk(now)
            decided = {"BEHAVIOUR": robot.behaviour, **robot.states}
            assert {name: script.globals[name] for name in decided} == decided
    finally:
        oracle.draw = keyed


def test_drop_object_is_seen_once_and_want_object_stays():
    rules = parse_text(
        "rule if ON_NEST == true do p = 1, DROP_OBJECT = true do p = 1, WANT_OBJECT = false"
    )
    script = FootBot(format_argos_lua(rules, PAPER))
    seen = []
    for nest in (False, True, False, False):
        script.perceive(ON_NEST=nest, ON_SOURCE=False, HAS_OBJECT=True)
        script.step()
        seen.append((script.globals.DROP_OBJECT, script.globals.WANT_OBJECT))
    assert seen == [(False, True), (True, False), (False, False), (False, False)]
    script.globals.reset()
    assert (script.globals.DROP_OBJECT, script.globals.WANT_OBJECT) == (False, True)
    script.globals.destroy()


@pytest.mark.parametrize(
    ("ground", "zone"),
    [
        ((1, 1, 1, 1), "ON_NEST"),
        ((1, 1, 1, 0.5), "ON_NEST"),
        ((1, 1, 0.5, 0.5), None),
        ((0, 0.5, 0, 0), "ON_SOURCE"),
        ((0.5, 0.5, 0.5, 0.5), None),
    ],
)
def test_zones_come_from_the_floor_if_nobody_says_them(ground, zone):
    rules = parse_text(
        "rule if ON_NEST == true do p = 1, PHOTOTAXIS "
        "rule if ON_SOURCE == true do p = 1, ANTI-PHOTOTAXIS "
        "rule if HAS_OBJECT == true do p = 1, DROP_OBJECT = true"
    )
    expected = {"ON_NEST": "PHOTOTAXIS", "ON_SOURCE": "ANTI-PHOTOTAXIS", None: "RANDOM_WALK"}
    for miss in (0.0, 1.0):
        script = FootBot(format_argos_lua(rules, PAPER.with_changes(zone_miss=miss)))
        for sensor, value in zip(script.robot.motor_ground.values(), ground, strict=True):
            sensor.value = value
        assert script.step() == ("RANDOM_WALK" if miss else expected[zone])
        assert script.globals.DROP_OBJECT is False


def test_zones_are_missed_as_often_as_the_scenario_says():
    rules = parse_text("rule if ON_NEST == true do p = 1, DROP_OBJECT = true")
    script = FootBot(format_argos_lua(rules, PAPER), 5)
    for sensor in script.robot.motor_ground.values():
        sensor.value = 1.0
    missed = 0
    for _ in range(4000):
        script.step()
        missed += not script.globals.DROP_OBJECT
    assert 0.065 < missed / 4000 < 0.095


def test_the_robot_drives_to_the_light_in_every_pose():
    script = FootBot(format_argos_lua(parse_text("rule do p = 1, PHOTOTAXIS"), PAPER))
    for theta in (-3.0, -1.5, -0.2, 0.0, 0.4, 1.6, 2.9):
        pose = (1.0, 0.3, theta)
        script.sense(PAPER, pose, [])
        script.step()
        left, right = script.wheels
        alpha = math.remainder(light_direction(PAPER, pose), 2 * math.pi)
        speed, turn = 10 * max(0.0, math.cos(alpha)), 2 * alpha * 14 / 2
        scale = min(1.0, 10 / max(abs(speed - turn), abs(speed + turn)))
        assert left == pytest.approx(scale * (speed - turn), abs=0.1)
        assert right == pytest.approx(scale * (speed + turn), abs=0.1)


def test_in_the_dark_the_robot_remembers_where_the_light_was():
    script = FootBot(format_argos_lua(parse_text("rule do p = 1, PHOTOTAXIS"), PAPER))
    script.sense(PAPER, (0.0, 0.0, 0.0), [])
    script.step()
    for sensor in script.robot.light.values():
        sensor.value = 0.0
    for _ in range(60):
        script.step()
    assert script.wheels == pytest.approx((10, 10), abs=0.05)


@pytest.mark.parametrize("version", ["lua51", "lua52", "lua53", "lua54", "luajit21"])
def test_every_lua_that_argos_is_built_with_runs_it(version):
    try:
        runtime = importlib.import_module(f"lupa.{version}").LuaRuntime
    except ImportError:
        pytest.skip(f"lupa was built without {version}")
    script = format_argos_lua(load_preset("evo8"), PAPER)
    behaviours = []
    for lua in (runtime, FootBot.__init__.__defaults__[1]):
        bot = FootBot(script, 4, lua)
        bot.sense(PAPER, (1.9, -1.9, 2.0), [(1.7, -1.8)])
        behaviours.append([(bot.step(), *bot.wheels) for _ in range(50)])
    assert behaviours[0] == behaviours[1]


def test_the_script_can_be_read():
    script = format_argos_lua(load_preset("evo8"), PAPER)
    assert max(map(len, script.splitlines())) <= 100
    assert (
        """drop any object and go back to the source
  if on_nest and (BEHAVIOUR == "RANDOM_WALK" or BEHAVIOUR == "ANTI-PHOTOTAXIS") then
    if chance(1) then change_to("PHOTOTAXIS") end
    if chance(1) then DROP_OBJECT = true end
  end
"""
        in script
    )


@given(strategies.documented_rule_sets)
def test_no_text_breaks_the_script(rule_set):
    FootBot(format_argos_lua(rule_set, PAPER)).step()


HOSTILE = (
    "]] os.exit(3) --[[\n]==] error('out')\rerror('out')\u2028error('out')\x00\\\nerror('out')"
)


def test_no_hostile_comment_is_run():
    rule = Rule(comment=HOSTILE, actions=(BehaviourChange(1, "PHOTOTAXIS"),))
    off = Rule(comment=f"[[{HOSTILE}", enabled=False)
    rule_set = RuleSet((rule, off), name=HOSTILE, comment=f"[==[ {HOSTILE} {'x' * 300}")
    script = format_argos_lua(rule_set, PAPER)
    assert FootBot(script).step() == "PHOTOTAXIS"
    for line in script.splitlines():
        assert "error" not in line.split("--", 1)[0]
        assert "exit" not in line.split("--", 1)[0]


INTERPRETER = shutil.which("lua5.3") or shutil.which("lua53")
DRIVER = """
local drawn, names = {}, {"ON_NEST", "ON_SOURCE", "HAS_OBJECT"}
for number in io.lines(arg[2]) do drawn[#drawn + 1] = tonumber(number) end
local at = 0
robot = {id = "robot0", light = {}, proximity = {}, range_and_bearing = {}, random = {}}
robot.wheels = {set_velocity = function() end}
function robot.random.uniform(low, high)
  at = at + 1
  return low and low + (high - low) * drawn[at] or drawn[at]
end
dofile(arg[1])
init()
for line in io.lines(arg[3]) do
  for i, name in ipairs(names) do _G[name] = line:sub(i, i) == "1" end
  step()
  print(BEHAVIOUR, DROP_OBJECT, WANT_OBJECT)
end
"""


@pytest.mark.skipif(not INTERPRETER, reason="lua5.3 is not installed")
@pytest.mark.parametrize("preset", ["evo8", "evolved", "hand-coded"])
def test_the_lua_executable_decides_as_the_oracle_does(preset, tmp_path, monkeypatch):
    rng = random.Random(11)
    numbers = [rng.random() for _ in range(200_000)]
    zones = [rng.choice([(0, 0), (1, 0), (0, 1)]) for _ in range(5000)]
    percepts = [(*zone, rng.randrange(2)) for zone in zones]
    files = {
        "driver.lua": DRIVER,
        "script.lua": format_argos_lua(load_preset(preset), PAPER),
        "numbers": "\n".join(map(repr, numbers)),
        "percepts": "\n".join("".join(map(str, each)) for each in percepts),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    command = [INTERPRETER, "driver.lua", "script.lua", "numbers", "percepts"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    stream = iter(numbers)
    monkeypatch.setattr(oracle, "draw", lambda *_: next(stream))
    decide, robot = oracle.by_rules(load_preset(preset)), oracle.Robot((0, 0))

    def walk(now):
        next(stream)
        return now + (5 + 10 * next(stream)) * 10

    walk_until, expected = walk(0), []
    for now, each in enumerate(percepts):
        names = ("ON_NEST", "ON_SOURCE", "HAS_OBJECT")
        robot.percepts = dict(zip(names, map(bool, each), strict=True))
        robot.states["DROP_OBJECT"] = False
        if decide(robot, now):
            walk_until = walk(now)
        if robot.behaviour == "RANDOM_WALK" and now >= walk_until:
            walk_until = walk(now)
        states = (robot.states["DROP_OBJECT"], robot.states["WANT_OBJECT"])
        expected.append("\t".join([robot.behaviour, *(str(state).lower() for state in states)]))
    assert done.stdout.splitlines() == expected
    assert len(set(expected)) >= 3


@pytest.mark.skipif(not shutil.which("luac5.3"), reason="luac5.3 is not installed")
def test_the_lua_compiler_finds_no_fault(tmp_path):
    for number, preset in enumerate(preset_names()):
        (tmp_path / f"{number}.lua").write_text(format_argos_lua(load_preset(preset), PAPER))
        subprocess.run(["luac5.3", "-p", f"{number}.lua"], cwd=tmp_path, check=True)
