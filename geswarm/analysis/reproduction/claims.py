"""What the paper reports beside what was found; every verdict is computed from the data.

The paper calls a difference significant at p < 0.001 (section 3.2.1), and so do the verdicts. Its
words "functional" and "approximately linearly" are made precise here; see `claims`.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from geswarm.analysis.cases import Case, Contrast, Samples, contrasts
from geswarm.analysis.reproduction.plan import Plan
from geswarm.analysis.reproduction.results import Results, format_csv
from geswarm.analysis.reproduction.scaling import Scaling, scaling
from geswarm.analysis.reproduction.studies import EVO_8, HAND_CODED
from geswarm.analysis.statistics import SIGNIFICANCE

OUTPERFORMING, WORSE, OF = 7, 1, 10
"""Of the evolved behaviours that the paper reports."""

LINEAR = (0.75, 1.25)
"""Of `Scaling.gain`: what passes for approximately linear."""


_COLUMNS = ("where", "paper", "found", "verdict")


class Verdict(Enum):
    """Whether a claim of the paper holds here."""

    HOLDS = "holds"
    FAILS = "does not hold"
    OPEN = "cannot be told"


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, held to the data.

    Attributes:
        where: In the paper.
        paper: What it reports.
        found: What the campaign found, in figures.
        verdict: What follows from them.
    """

    where: str
    paper: str
    found: str
    verdict: Verdict


def format_claims(found: Sequence[Claim]) -> str:
    """One line per claim, as CSV."""
    rows = [(one.where, one.paper, one.found, one.verdict.value) for one in found]
    return format_csv(_COLUMNS, rows)


def parse_claims(text: str) -> list[Claim]:
    """Read what `format_claims` wrote.

    Raises:
        ValueError: It is something else.
    """
    header, *rows = csv.reader(io.StringIO(text, newline=""))
    if tuple(header) != _COLUMNS:
        raise ValueError(f"expected the columns {', '.join(_COLUMNS)}")
    return [Claim(where, paper, found, Verdict(verdict)) for where, paper, found, verdict in rows]


def claims(results: Results) -> list[Claim]:
    """All claims that figures can decide.

    A claim about evolution cannot be told from a smaller campaign than the paper's. A behaviour is
    functional if it collects objects in every run. A difference decides a claim if it is
    significant. Scaling is approximately linear if the whole 95 % interval of `Scaling.gain` lies
    within `LINEAR`, and is not if the whole interval lies outside.
    """
    sets = {"3a": results.scalability, "3b": results.flexibility}
    return [
        *_evolution(results),
        _best_of_the_paper(results),
        *(_generalises(results, at, samples) for at, samples in sets.items()),
        *(_always_ahead(results, EVO_8, at, samples) for at, samples in sets.items()),
        *(
            _scales(results.plan, rules, at, samples)
            for at, samples in sets.items()
            for rules in (results.best, EVO_8, HAND_CODED)
        ),
    ]


def against_hand_coded(results: Results) -> list[Contrast]:
    """Every rule set against the hand-coded one where they evolved (Figure 2b), EVO 8 last."""
    cases = {case.rules: case for case in results.performance}
    pairs = [(cases[name], cases[HAND_CODED]) for name in (*results.evolved, EVO_8)]
    return contrasts(results.performance, pairs)


def in_larger_swarms(results: Results) -> list[Contrast]:
    """The three rule sets against each other in each of the six settings of Figure 3."""
    samples = results.scalability | results.flexibility
    pairs = [
        (Case(a, scenario), Case(b, scenario))
        for scenario in dict.fromkeys(case.scenario for case in samples)
        for a, b in ((results.best, HAND_CODED), (EVO_8, HAND_CODED), (results.best, EVO_8))
    ]
    return contrasts(samples, pairs)


def _evolution(results: Results) -> list[Claim]:
    """The claims of section 3.2.1 about the ten runs."""
    plan, number = results.plan, len(results.evolved)
    found = results.by_rules
    least = [int(found[name].fitness.min()) for name in results.evolved]
    functional = sum(one > 0 for one in least)
    means = [found[name].mean for name in results.evolved]
    contests = against_hand_coded(results)[:-1]
    better = _names(contests, 1)
    worse = _names(contests, -1)
    comparable = _names(contests, 0)
    return [
        Claim(
            "3.2.1",
            "All evolutionary runs obtain a functional behaviour.",
            f"{functional} of {number} collect objects in every run; means from "
            f"{min(means):.1f} to {max(means):.1f}",
            _of_evolution(plan, functional == number),
        ),
        Claim(
            "3.2.1, Fig. 2b",
            "7 of 10 evolved behaviours outperform the hand-coded one (p < 0.001); "
            "2 are comparable.",
            f"{len(better)} of {number}, {_clear(contests)} with Holm's correction; "
            f"comparable: {_listed(comparable)}",
            _of_evolution(plan, OF * len(better) >= OUTPERFORMING * number),
        ),
        Claim(
            "3.2.1, Fig. 2b",
            "The hand-coded behaviour performs better than only 1 of 10 (EVO 6).",
            f"better than {len(worse)} of {number}: {_listed(worse)}",
            _of_evolution(plan, OF * len(worse) <= WORSE * number),
        ),
    ]


def _of_evolution(plan: Plan, true: bool) -> Verdict:
    if not plan.is_whole:
        return Verdict.OPEN
    return Verdict.HOLDS if true else Verdict.FAILS


def _names(contests: Sequence[Contrast], winner: int) -> list[str]:
    return [contest.a.rules for contest in contests if contest.comparison.winner == winner]


def _clear(contests: Sequence[Contrast]) -> int:
    """How many are won even with Holm's correction."""
    return sum(one.comparison.winner == 1 and one.p_holm < SIGNIFICANCE for one in contests)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) if names else "none"


def _best_of_the_paper(results: Results) -> Claim:
    contest = against_hand_coded(results)[-1]
    means = [results.performance[case].mean for case in (contest.a, contest.b)]
    place = 1 + sum(results.by_rules[name].mean > means[0] for name in results.evolved)
    return Claim(
        "3.2.1, Fig. 2b",
        "EVO 8 outperforms the hand-coded behaviour where it evolved.",
        f"{means[0]:.1f} against {means[1]:.1f}, {_statistics(contest)}; "
        f"by mean, place {place} of {len(results.evolved) + 1} with those evolved here",
        _decided([contest]),
    )


def _generalises(results: Results, figure: str, samples: Samples) -> Claim:
    ahead = _always_ahead(results, results.best, figure, samples)
    return Claim(
        ahead.where,
        "The best evolved behaviour generalises: it outperforms the hand-coded one in all cases.",
        f"{results.best} is {ahead.found}",
        ahead.verdict if results.plan.is_whole else Verdict.OPEN,
    )


def _always_ahead(results: Results, rules: str, figure: str, samples: Samples) -> Claim:
    contests = [
        one
        for one in in_larger_swarms(results)
        if one.a in samples and (one.a.rules, one.b.rules) == (rules, HAND_CODED)
    ]
    won = len(_names(contests, 1))
    least = min(one.comparison.effect for one in contests)
    each = "; ".join(
        f"{samples[c.a].mean:.1f} to {samples[c.b].mean:.1f} with {c.a.scenario.robots}"
        for c in contests
    )
    return Claim(
        f"3.2.2, Fig. {figure}",
        "EVO 8 outperforms the hand-coded behaviour with 5, 10 and 20 robots.",
        f"ahead in {won} of {len(contests)} (p < 0.001), {_clear(contests)} with Holm's "
        f"correction, smallest A = {least:.2f}: {each} robots",
        _decided(contests),
    )


def _decided(contests: Sequence[Contrast]) -> Verdict:
    """Whether the first of each pair is ahead: in all cases, not in all, or without telling."""
    winners = {contest.comparison.winner for contest in contests}
    if -1 in winners:
        return Verdict.FAILS
    return Verdict.HOLDS if winners == {1} else Verdict.OPEN


def _statistics(contest: Contrast) -> str:
    found = contest.comparison
    return (
        f"p = {found.p_value:#.2g} ({contest.p_holm:#.2g} with Holm's correction), "
        f"A = {found.effect:.2f}"
    )


def _scales(plan: Plan, rules: str, figure: str, samples: Samples) -> Claim:
    line = scaling(samples, rules)
    verdict = _linear(line)
    evolved_here = rules not in (EVO_8, HAND_CODED)
    name = f"the best evolved ({rules})" if evolved_here else rules
    if math.isnan(line.gain):
        found = "more robots do not collect more"
    else:
        found = (
            f"{line.slope:.1f} objects per robot, R² = {line.r2:.3f}; a robot beyond 10 adds "
            f"{line.gain:.0%} ({line.low:.0%} to {line.high:.0%}) of one between 5 and 10"
        )
    return Claim(
        f"3.2.2, Fig. {figure}",
        f"Performance scales approximately linearly with the swarm size: {name}.",
        found,
        Verdict.OPEN if evolved_here and not plan.is_whole else verdict,
    )


def _linear(line: Scaling) -> Verdict:
    if math.isnan(line.gain) or line.high < LINEAR[0] or line.low > LINEAR[1]:
        return Verdict.FAILS
    within = LINEAR[0] <= line.low and line.high <= LINEAR[1]
    return Verdict.HOLDS if within else Verdict.OPEN
