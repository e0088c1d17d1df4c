"""`geswarm compare` as a user calls it."""

import json

import pytest

from geswarm.analysis import compare, holm
from geswarm.cli import main


@pytest.fixture
def scenarios(tmp_path):
    for name, robots in (("few", 3), ("many", 9)):
        (tmp_path / f"{name}.yaml").write_text(f"robots: {robots}\nduration: 200\n")
    return [str(tmp_path / "few.yaml"), str(tmp_path / "many.yaml")]


def test_json_has_every_case_and_its_comparison_with_the_first(scenarios, capsys):
    arguments = ["compare", "evo8", "hand-coded", "--scenario", *scenarios, "--runs", "12"]
    assert main([*arguments, "--json", "--seed", "5"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert (document["runs"], document["seed"]) == (12, 5)
    results = document["results"]
    assert [(one["rules"], one["scenario"]) for one in results] == [
        (rules, scenario) for scenario in scenarios for rules in ("evo8", "hand-coded")
    ]
    assert set(results[0]) == {
        *("rules", "scenario", "objective", "fitness", "measures", "collected"),
        *("mean", "sd", "median", "lost_mean"),
        *("p_value", "p_holm", "effect"),
    }
    assert results[0]["objective"]["expression"] == "collected"
    assert results[0]["p_value"] is results[0]["p_holm"] is results[0]["effect"] is None
    found = [compare(results[at]["collected"], results[at - 1]["collected"]) for at in (1, 3)]
    assert [results[at]["p_value"] for at in (1, 3)] == [one.p_value for one in found]
    assert [results[at]["effect"] for at in (1, 3)] == [one.effect for one in found]
    assert [results[at]["p_holm"] for at in (1, 3)] == holm([one.p_value for one in found])


def test_scenarios_may_be_given_one_by_one(scenarios, capsys):
    one_by_one = [word for name in scenarios for word in ("--scenario", name)]
    outputs = []
    for chosen in (one_by_one, ["--scenario", *scenarios]):
        assert main(["compare", "evo8", *chosen, "--runs", "2", "--json"]) == 0
        outputs.append(capsys.readouterr().out)
    assert outputs[0] == outputs[1]
    assert len(json.loads(outputs[0])["results"]) == 2


def test_it_agrees_with_evaluate(scenarios, capsys):
    common = ["evo8", "--runs", "4", "--seed", "2", "--json", "--scenario", scenarios[0]]
    documents = []
    for verb in ("compare", "evaluate"):
        assert main([verb, *common]) == 0
        documents.append(json.loads(capsys.readouterr().out)["results"][0]["collected"])
    assert documents[0] == documents[1]


def test_the_table_names_rules_and_scenarios(scenarios, capsys):
    assert main(["compare", "evo8", "hand-coded", "--scenario", scenarios[0], "--runs", "3"]) == 0
    out = capsys.readouterr().out
    assert "hand-coded" in out
    assert "Mann-Whitney against evo8" in out
    assert main(["compare", "evo8", "--scenario", scenarios[0], "--runs", "3"]) == 0
    assert "Mann-Whitney" not in capsys.readouterr().out


def test_the_page_needs_nothing_else_and_escapes_names(scenarios, tmp_path, capsys):
    rules = tmp_path / "<b>mine.rules"
    rules.write_text('name "<script>alert(1)</script>"\nrule do p = 0.1, RANDOM_WALK\n')
    page = tmp_path / "page.html"
    arguments = ["compare", "evo8", str(rules), "--scenario", *scenarios, "--runs", "3"]
    assert main([*arguments, "--html", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "<b>mine" not in text
    assert "&lt;b&gt;mine.rules" in text
    assert "<script>alert" not in text
    assert "Plotly.newPlot" in text
    assert "default-src 'none'" in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["evo8", "evo8"], "rules: expected each one once, got evo8 twice"),
        (["evo8", "--scenario", "paper", "paper"], "scenario: expected each one once"),
        (
            ["evo8", "--scenario", "paper", "--scenario", "paper"],
            "scenario: expected each one once",
        ),
        (["evo9"], "evo9: neither a file"),
        (["evo8", "--scenario", "moon"], "moon"),
        (["evo8", "--runs", "0"], "expected a whole number >= 1"),
        (["evo8", "--runs", "1", "--html", "no/where"], "no/where: cannot be written"),
        (["evo8", "--runs", "1", "--html", "."], ".: cannot be written: Is a directory"),
    ],
)
def test_usage_errors_exit_2_with_one_clear_message(arguments, message, capsys):
    try:
        status = main(["compare", *arguments])
    except SystemExit as error:
        status = error.code
    captured = capsys.readouterr()
    assert status == 2
    assert message in captured.err
    assert captured.out == ""
    assert "Traceback" not in captured.err
