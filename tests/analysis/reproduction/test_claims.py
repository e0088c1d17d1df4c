"""Claims come out as the data say, one way and the other."""

import json
import math
from pathlib import Path

import pytest

from geswarm.analysis.cases import Case
from geswarm.analysis.reproduction import Plan, Verdict, claims, studies
from geswarm.analysis.reproduction.claims import against_hand_coded, in_larger_swarms
from geswarm.analysis.reproduction.scaling import scaling
from geswarm.analysis.reproduction.sensitivity import crossings, verdict_on_zone_miss
from geswarm.sim import load_scenario
from tests.analysis.reproduction.fabricated import fabricated, sample

HOLDS, FAILS, OPEN = Verdict.HOLDS, Verdict.FAILS, Verdict.OPEN
EVOLVED = ("evolutionary runs", "evolved behaviours", "only 1 of 10", "best evolved")


def verdicts(results, text=""):
    return [claim.verdict for claim in claims(results) if text in claim.paper]


def test_what_the_paper_found_makes_every_claim_hold():
    results = fabricated()
    assert set(verdicts(results)) == {HOLDS}
    most = next(claim for claim in claims(results) if "7 of 10" in claim.paper)
    assert most.found == "7 of 10, 7 with Holm's correction; comparable: seed 8, seed 9"
    worse = next(claim for claim in claims(results) if "only 1 of 10" in claim.paper)
    assert worse.found == "better than 1 of 10: seed 10"
    assert len(claims(results)) == 14


def test_the_opposite_makes_every_claim_fail():
    results = fabricated(
        evolved=[0] + [20] * 9, evo8=30, hand_coded=65, growth=lambda robots: 3 - 10 / robots
    )
    assert set(verdicts(results)) == {FAILS}


def test_no_difference_decides_no_contest():
    results = fabricated(evolved=[65] * 10, evo8=65, hand_coded=65)
    assert set(verdicts(results, "EVO 8 outperforms")) == {OPEN}
    assert set(verdicts(results, "generalises")) == {OPEN}
    assert verdicts(results, "7 of 10") == [FAILS]
    assert verdicts(results, "only 1 of 10") == [HOLDS]


@pytest.mark.parametrize(("better", "verdict"), [(6, FAILS), (7, HOLDS), (10, HOLDS)])
def test_seven_of_ten_is_counted(better, verdict):
    results = fabricated(evolved=[100] * better + [65] * (10 - better))
    assert verdicts(results, "7 of 10") == [verdict]


@pytest.mark.parametrize(("worse", "verdict"), [(1, HOLDS), (2, FAILS)])
def test_one_worse_is_counted(worse, verdict):
    results = fabricated(evolved=[30] * worse + [100] * (10 - worse))
    assert verdicts(results, "only 1 of 10") == [verdict]


def test_a_behaviour_that_sometimes_collects_nothing_is_not_functional():
    assert verdicts(fabricated(evolved=[100] * 9 + [10]), "functional") == [FAILS]
    assert verdicts(fabricated(evolved=[100] * 9 + [12]), "functional") == [HOLDS]


def test_evolution_cannot_be_told_from_a_smaller_campaign_and_the_rest_can():
    for plan in (Plan(runs=9), Plan(generations=999)):
        results = fabricated(evolved=[100] * plan.runs, plan=plan)
        for claim in claims(results):
            about_evolution = any(words in claim.paper for words in EVOLVED)
            assert claim.verdict is (OPEN if about_evolution else HOLDS), claim


def test_one_lost_case_is_enough_to_fail():
    results = fabricated()
    case = Case("EVO 8", load_scenario("flexibility-20"))
    results.flexibility[case] = sample(10)
    assert verdicts(results, "EVO 8 outperforms the hand-coded behaviour with") == [HOLDS, FAILS]


@pytest.mark.parametrize("kind", ["scalability", "flexibility"])
@pytest.mark.parametrize("rules", ["seed 1", "EVO 8", "hand-coded"])
def test_one_bent_line_fails_one_claim(kind, rules):
    results = fabricated(evolved=[150] + [100] * 9, hand_coded=30)
    assert set(verdicts(results)) == {HOLDS}
    samples = getattr(results, kind)
    ten, twenty = (Case(rules, load_scenario(f"{kind}-{robots}")) for robots in (10, 20))
    samples[twenty] = sample(1.05 * samples[ten].mean)
    (failed,) = (claim for claim in claims(results) if claim.verdict is FAILS)
    assert failed.where == f"3.2.2, Fig. {'3a' if kind == 'scalability' else '3b'}"
    assert "linearly" in failed.paper
    assert rules in failed.paper


@pytest.mark.parametrize("kind", ["scalability", "flexibility"])
@pytest.mark.parametrize(("mean", "verdict"), [(10, FAILS), (600, HOLDS), (65, OPEN)])
def test_each_case_of_figure_3_counts(kind, mean, verdict):
    results = fabricated()
    samples = getattr(results, kind)
    for rules in ("seed 1", "EVO 8"):
        samples[Case(rules, load_scenario(f"{kind}-5"))] = sample(mean * 5 / 4)
    at = f"Fig. {'3a' if kind == 'scalability' else '3b'}"
    ahead = [claim for claim in claims(results) if "with 5" in claim.found]
    here = [claim for claim in ahead if claim.where.endswith(at)]
    assert len(ahead) == 2 * len(here) == 4
    assert {claim.verdict for claim in here} == {verdict}
    assert {claim.verdict for claim in ahead if claim not in here} == {HOLDS}
    found = f"ahead in {3 if verdict is HOLDS else 2} of 3 (p < 0.001), "
    assert all(found in claim.found for claim in here)


def test_effect_and_correction_stand_beside_the_plain_p_values():
    results = fabricated()
    scenario = load_scenario("scalability-5")
    rival = results.scalability[Case("hand-coded", scenario)]
    for rules in ("seed 1", "EVO 8"):
        results.scalability[Case(rules, scenario)] = sample(rival.mean + 4.5)
    contests = [one for one in in_larger_swarms(results) if one.a.scenario == scenario][:2]
    assert all(one.comparison.p_value < 0.001 < one.p_holm for one in contests)
    ahead = [one.found for one in claims(results) if "with 5" in one.found and "3a" in one.where]
    assert len(ahead) == 2
    for found, contest in zip(ahead, contests, strict=True):
        effect = f"smallest A = {contest.comparison.effect:.2f}"
        assert f"ahead in 3 of 3 (p < 0.001), 2 with Holm's correction, {effect}: " in found


@pytest.mark.parametrize(
    ("growth", "gain", "verdict"),
    [
        (lambda n: n, 1.0, HOLDS),
        (lambda n: 3 * n + 7, 1.0, HOLDS),
        (math.log, 0.5, FAILS),
        (lambda n: n**2, 2.0, FAILS),
        (lambda n: 30 - n, math.nan, FAILS),
        (lambda n: 5.0, math.nan, FAILS),
    ],
)
def test_scaling(growth, gain, verdict):
    results = fabricated(growth=growth)
    assert scaling(results.scalability, "EVO 8").gain == pytest.approx(gain, abs=0.02, nan_ok=True)
    assert set(verdicts(results, "linearly")) == {verdict}


def test_scaling_that_varies_too_much_cannot_be_told():
    for kind, noisy in (("scalability", slice(3)), ("flexibility", slice(3, 6))):
        results = fabricated()
        samples = getattr(results, kind)
        for case in samples:
            samples[case] = sample(10 * case.scenario.robots, spread=60)
        expected = [HOLDS] * 6
        expected[noisy] = [OPEN] * 3
        assert verdicts(results, "linearly") == expected


def test_the_line_is_fitted_to_all_runs():
    line = scaling(fabricated(growth=lambda n: n / 10 + 2).scalability, "EVO 8")
    assert (line.slope, line.intercept) == pytest.approx((10.0, 200.0), abs=0.1)
    assert 0.95 < line.r2 < 1
    assert line.low < line.gain < line.high


def test_all_comparisons_of_a_figure_are_corrected_together():
    results = fabricated()
    family = in_larger_swarms(results)
    assert len(family) == 18
    smallest = min(family, key=lambda one: one.comparison.p_value)
    assert smallest.p_holm == pytest.approx(18 * smallest.comparison.p_value)
    assert [one.a.rules for one in against_hand_coded(results)][-2:] == ["seed 10", "EVO 8"]


def test_the_crossing_is_found_and_said():
    samples = fabricated(evo8=100, hand_coded=65, at_zero=145).sensitivity
    assert crossings(samples) == pytest.approx([0.045])
    said = verdict_on_zone_miss(samples, 0.08)
    assert "depends on zone_miss" in said
    assert "cross at 0.045" in said
    assert "at 0.08, EVO 8 collects 100.0 and hand-coded 65.0" in said


def test_no_crossing_is_said_as_well():
    samples = fabricated(evo8=100, hand_coded=65, at_zero=70).sensitivity
    assert crossings(samples) == []
    assert "does not depend on zone_miss between 0 and 0.2" in verdict_on_zone_miss(samples, 0.08)


def test_argos_cases_are_those_of_the_agreement_test():
    reference = Path(__file__).parents[2] / "sim" / "argos_reference.json"
    expected = {
        (case["scenario"].replace(" with", ","), case["rules"]): case["collected"]
        for case in json.loads(reference.read_text())["cases"]
    }
    presets = {"EVO 8": "evo8", "hand-coded": "hand-coded"}
    packaged = {
        (case.scenario.name, presets[case.rules]): found.fitness.tolist()
        for case, found in studies.argos().items()
    }
    assert packaged == expected
    misses = {case.scenario.zone_miss for case in studies.argos_over_zone_miss()}
    assert misses == {0, 0.04, 0.08}
