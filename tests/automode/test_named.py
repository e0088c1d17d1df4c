"""AutoMoDe's text wherever rule sets are named."""

import json

import numpy as np
import pytest

from geswarm.automode import AutoMoDeError, Machine, Tree, find_controllers
from geswarm.cli import main
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import RuleSet, RuleSetError, load_rule_set
from geswarm.sim import load_scenario, vocabulary_of

EXPLORES = "--fsm-config --nstates 1 --s0 0 --rwm0 5"
STOPS = "--nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 --s1 1"
TREE = "--bt-config --nroot 0 --nchildroot 1 --n0 5 --a0 0 --rwm0 5 --p0 0"
STRAIGHT = "--bt-config --nroot 0 --nchildroot 1 --n0 5 --a0 6 --p0 0"
AAC = load_scenario("epuck-aac")
WORDS = vocabulary_of(AAC)


@pytest.fixture
def file(tmp_path):
    def write(*lines):
        path = tmp_path / "machines.txt"
        path.write_text("\n".join(lines))
        return str(path)

    return write


def read(name, vocabulary=WORDS, offered_by="epuck-aac"):
    (found,) = find_controllers([name])
    return found.read(vocabulary, offered_by)


def test_each_machine_of_a_file_has_a_name(file):
    name = file("# published", EXPLORES, f"bin/automode_main --seed 3 {EXPLORES}", STOPS)
    found = read(name)
    assert list(found) == [f"{name}#1", f"{name}#2", f"{name}#3"]
    assert all(isinstance(each, Machine) for each in found.values())
    assert list(read(file(EXPLORES))) == [name]


def test_trees_are_named_as_machines_are(file):
    name = file(EXPLORES, TREE)
    assert list(map(type, read(name).values())) == [Machine, Tree]


def test_rules_are_rules(file):
    (rules,) = read("epuck-aac").values()
    assert isinstance(rules, RuleSet)
    commented = "# not --nstates 2\nrule do p = 1, STOP"
    assert isinstance(read(file(commented)).popitem()[1], RuleSet)


def test_rules_that_come_from_a_machine_are_rules(file, tmp_path):
    rules = tmp_path / "two.yaml"
    assert main(["import", file(EXPLORES), "--from", "automode", "-o", str(rules)]) == 0
    assert "--nstates" in rules.read_text()  # where they come from
    assert isinstance(read(str(rules))[str(rules)], RuleSet)


def test_what_does_not_run_here_is_told_with_its_place(file):
    name = file(EXPLORES, STOPS)
    with pytest.raises(AutoMoDeError) as error:
        read(name, vocabulary_of(load_scenario("paper")), "paper")
    assert str(error.value).splitlines() == [
        f"{name}#1: paper does not offer EXPLORATION",
        f"{name}#2: paper does not offer EXPLORATION, FLOOR, STOP",
    ]
    with pytest.raises(AutoMoDeError, match=r"#2: behaviour trees .* got straight"):
        read(file(EXPLORES, STRAIGHT))
    with pytest.raises(AutoMoDeError, match=r":1: "):
        read(file("--nstates 1 --s0 9"))


def test_whoever_reads_only_rules_says_what_to_do(file):
    with pytest.raises(RuleSetError, match="geswarm import"):
        load_rule_set(file(STOPS), WORDS)


def test_machines_run_beside_rules_as_they_do_alone(file):
    short = AAC.with_changes(duration=5.0)
    rules = load_rule_set("epuck-aac", WORDS)
    explores, stops, tree = read(file(EXPLORES, STOPS, TREE)).values()
    several = [stops, rules, tree, explores]
    together = evaluate_rule_sets(several, short, runs=3, seed=1)
    for each, found in zip(several, together, strict=True):
        (alone,) = evaluate_rule_sets([each], short, runs=3, seed=1)
        np.testing.assert_array_equal(alone.fitness, found.fitness)


def test_evaluate_and_compare_take_the_text(file, tmp_path, capsys):
    scenario = tmp_path / "short.yaml"
    scenario.write_text("extends: epuck-aac\nduration: 2\n")
    name, page = file(EXPLORES, STOPS), tmp_path / "page.html"
    common = [name, "epuck-aac", "--scenario", str(scenario), "--runs", "2", "--json"]
    for verb, more in (("evaluate", []), ("compare", ["--html", str(page)])):
        assert main([verb, *common, *more]) == 0
        results = json.loads(capsys.readouterr().out)["results"]
        assert [each["rules"] for each in results] == [f"{name}#1", f"{name}#2", "epuck-aac"]
    assert "--fsm-config --nstates 2 --s0 0" in page.read_text()


def test_a_tree_that_comes_to_too_much_is_told(file, capsys):
    action = "--n{0}{1} 5 --a{0}{1} 4 --att{0}{1} {2} --p{0}{1} .5"
    children = " ".join(
        f"--n{j} 3 --nchild{j} 4 " + " ".join(action.format(j, k, k + 1) for k in range(4))
        for j in range(4)
    )
    name = file(f"--bt-config --nroot 2 --nchildroot 4 {children}")
    for verb in ("evaluate", "compare"):
        assert main([verb, name, "--scenario", "epuck-aac", "--runs", "1"]) == 2
        assert "at most 32 different pairs of memory and behaviour" in capsys.readouterr().err
