"""The published figures are what the published runs say, and what the command finds today."""

import pytest

from geswarm.analysis.cases import run_cases
from geswarm.analysis.reproduction import QUICK, Verdict, claims
from geswarm.analysis.reproduction.report import files_of
from geswarm.analysis.reproduction.studies import EVO_8, HAND_CODED
from geswarm.cli import main
from tests.analysis.reproduction.published import published, rows_of, text_of

EXPERIMENTS = ("performance", "scalability", "flexibility", "sensitivity", "agreement")


@pytest.mark.parametrize("table", ["history", "claims", "contrasts", "scaling"])
def test_the_tables_follow_from_the_runs(table):
    assert files_of(published())[f"data/{table}.csv"] == text_of(f"{table}.csv")


def test_the_rules_are_written_as_they_are_published():
    files = files_of(published())
    for seed in range(1, 11):
        assert files[f"rules/seed-{seed}.yaml"] == text_of(f"rules/seed-{seed}.yaml")
    assert files["rules/best.yaml"] == text_of("rules/seed-5.yaml")


def test_it_is_the_papers_campaign_and_every_claim_holds():
    results = published()
    assert results.plan.is_whole
    assert all(len(records) == 1000 for records in results.histories.values())
    assert {claim.verdict for claim in claims(results)} == {Verdict.HOLDS}


@pytest.mark.long
@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_the_published_rules_collect_what_is_published(experiment):
    results = published()
    samples = getattr(results, experiment)
    cases = [case for case in samples if case.rules in results.rule_sets]
    assert {case.rules for case in cases} >= {EVO_8, HAND_CODED}
    plan = results.plan
    found = run_cases(cases, results.rule_sets, plan.evaluations, plan.seed)
    for case in cases:
        for name in ("collected", "lost"):
            one, other = (each[case].measures[name] for each in (found, samples))
            assert one.tolist() == other.tolist(), case


@pytest.mark.long
def test_quick_goes_the_first_steps_of_the_published_campaign(tmp_path, capsys):
    """`--quick` as it is: its evolutionary runs are the beginnings of the published ones."""
    place = tmp_path / "quick"
    assert main(["reproduce", "--out", str(place), "--quick"]) == 0
    captured = capsys.readouterr()
    assert f"Report: {place / 'report.html'}" in captured.err
    assert (place / "report.html").stat().st_size > 1_000_000
    assert "cannot be told  3.2.1           All evolutionary runs" in captured.out
    known = {(row["rules"], row["generation"]): row for row in rows_of(text_of("history.csv"))}
    rows = rows_of((place / "data" / "history.csv").read_text(encoding="utf-8"))
    assert len(rows) == QUICK["runs"] * QUICK["generations"]
    assert rows == [known[row["rules"], row["generation"]] for row in rows]
