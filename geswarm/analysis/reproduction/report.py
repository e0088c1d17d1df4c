"""The report of a campaign: one page, and the tables that it is made of as CSV."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from html import escape
from itertools import cycle

from geswarm import __version__
from geswarm.analysis.cases import Contrast, Samples
from geswarm.analysis.figures import PALETTE, best_so_far, box_plots, sensitivity_curves
from geswarm.analysis.page import figure_html, page, table_html
from geswarm.analysis.reproduction.claims import (
    LINEAR,
    Claim,
    Verdict,
    against_hand_coded,
    claims,
    format_claims,
    in_larger_swarms,
)
from geswarm.analysis.reproduction.results import Results, format_csv, format_histories
from geswarm.analysis.reproduction.scaling import scaling
from geswarm.analysis.reproduction.sensitivity import crossings, verdict_on_zone_miss
from geswarm.analysis.reproduction.studies import (
    EVO_8,
    HAND_CODED,
    argos,
    argos_over_zone_miss,
)
from geswarm.exports import format_html
from geswarm.rules import format_yaml
from geswarm.sim import load_scenario

_EVOLVED = "#8fc9b4"
_SENSITIVITY_WIDTH = 640  # pixels: as wide as fits on A4 and on small screens
_TITLE = "GESwarm: the paper's experiments, repeated"
_PAPER = (
    "E. Ferrante, E. Duéñez-Guzmán, A. E. Turgut, T. Wenseleers: GESwarm: Grammatical Evolution "
    "for the Automatic Synthesis of Swarm Robotics Collective Behaviors. GECCO 2013"
)

_METHOD = f"""<h2>How it is judged</h2>
<ul>
<li>Differences: two-sided Mann-Whitney test; the paper does not name its own. Significant at
p &lt; 0.001, as in the paper; p (Holm) is corrected for all comparisons of its table. A: Vargha and
Delaney's effect size, the probability that a run of the first collects more than one of the second;
ties count half.</li>
<li>A behaviour is functional if it collects objects in every run. <i>7 of 10</i> holds from that
share on, <i>only 1 of 10</i> up to that share. <i>In all cases</i> holds if every difference is
significant, and does not if one is significant the other way.</li>
<li>Claims about evolution cannot be told from fewer than 10 runs of 1000 generations. The best
evolved rule set is the one with the highest mean in Figure 2b; it is compared with the others in
Figure 3 by other runs.</li>
<li>Scaling is approximately linear if the whole 95 % interval of the gain lies within
{LINEAR[0]:.0%} to {LINEAR[1]:.0%}, and is not if the whole interval lies outside.</li>
<li>Not judged, since no figure can: that evolved rules are easy to read.</li>
<li>Every single run is in <code>data/</code>, the rule sets are in <code>rules/</code>, the
evolutionary runs in <code>evolution/</code>.</li>
</ul>"""


def files_of(results: Results) -> dict[str, str]:
    """Everything that is made of the results, by the path within the campaign's directory."""
    found = claims(results)
    rule_sets = {**results.rule_sets, "best": results.rule_sets[results.best]}
    return {
        "data/history.csv": format_histories(results.histories),
        "data/contrasts.csv": _contrasts_csv(results),
        "data/scaling.csv": format_csv(_SCALING, _scaling_rows(results)),
        "data/claims.csv": format_claims(found),
        **{
            f"rules/{name.lower().replace(' ', '-')}.yaml": format_yaml(rule_set)
            for name, rule_set in rule_sets.items()
        },
        "report.html": report(results, found),
    }


def report(results: Results, found: Sequence[Claim]) -> str:
    """The page.

    Args:
        results: Of the campaign.
        found: `claims(results)`.
    """
    sections = (
        _summary(results, found),
        _claims_section(results, found),
        _figures_section(results),
        _comparisons_section(results),
        _rules_section(results),
        _sensing_section(results),
        _agreement_section(results),
        _METHOD,
    )
    return page(_TITLE, "\n".join(sections))


def _summary(results: Results, found: Sequence[Claim]) -> str:
    plan = results.plan
    count = Counter(claim.verdict for claim in found)
    return f"""<h1>{_TITLE}</h1>
<p class="lead">Of {len(found)} claims of the paper, {count[Verdict.HOLDS]} hold,
{count[Verdict.FAILS]} do not hold, and {count[Verdict.OPEN]} cannot be told.</p>
<p class="muted">{plan.runs} evolutionary runs (seeds {plan.seeds[0]} to {plan.seeds[-1]}) of
{plan.generations} generations, preset paper, scenario paper; then {plan.evaluations} runs of every
rule set in every setting. GESwarm {__version__}. The paper: {_PAPER}.</p>"""


def _claims_section(results: Results, found: Sequence[Claim]) -> str:
    rows = "\n".join(map(_claim_row, found))
    note = ""
    if crossings(results.sensitivity):
        note = (
            '\n<p class="muted">Whether EVO 8 outperforms hand-coded depends on how well robots '
            'sense zones: see <a href="#sensing">below</a>.</p>'
        )
    return f"""<h2>Claims</h2>
<div class="scroll"><table class="data" id="claims">
<thead><tr><th>section</th><th>the paper</th><th>found here</th><th>verdict</th></tr></thead>
<tbody>
{rows}
</tbody></table></div>{note}"""


def _claim_row(claim: Claim) -> str:
    verdict = claim.verdict.value
    kind = verdict.replace(" ", "-")
    return (
        f'<tr><td class="name">{escape(claim.where)}</td><td>{escape(claim.paper)}</td>'
        f"<td>{escape(claim.found)}</td>"
        f'<td><span class="verdict {kind}">{verdict}</span></td></tr>'
    )


def _figures_section(results: Results) -> str:
    starred = [one.a.rules for one in against_hand_coded(results) if one.comparison.winner == 1]
    means = {name: evaluation.mean for name, evaluation in results.by_rules.items()}
    histories = {
        name: [record.best_so_far for record in records]
        for name, records in results.histories.items()
    }
    colours = _colours(results)
    levels = {name: means[name] for name in (HAND_CODED, EVO_8)}
    curves = best_so_far(histories, levels, _colours_of_runs(results))
    boxes = box_plots(results.performance, colours, baseline=means[HAND_CODED], starred=starred)
    scalability, flexibility = (
        box_plots(samples, colours, label=lambda one: str(one.robots), axis="robots")
        for samples in (results.scalability, results.flexibility)
    )
    runs = results.plan.evaluations
    drawn = {
        "2a": (
            curves,
            "Best fitness so far in each run. Dashed: means of the paper's rules in 2b.",
        ),
        "2b": (
            boxes,
            f"{runs} runs of each evolved rule set and of the paper's. Dashed: mean of hand-coded. "
            "* outperforms hand-coded, p &lt; 0.001.",
        ),
        "3a": (scalability, "Scalability: larger swarms, the same density of 0.23 robots per m²."),
        "3b": (flexibility, "Flexibility: about 0.9 robots per m², half the objects."),
    }
    figures = "\n".join(
        figure_html(figure, f"figure-{number}", f"<b>{number}</b> {caption}")
        for number, (figure, caption) in drawn.items()
    )
    return f'<h2 id="figures">Figures 2 and 3</h2>\n<div class="side-by-side">\n{figures}\n</div>'


def _comparisons_section(results: Results) -> str:
    both = results.scalability | results.flexibility
    return f"""<h2>Comparisons</h2>
<h3>Where they evolved (Figure 2b)</h3>
{table_html(_CONTRASTS, _contrast_rows(results.performance, against_hand_coded(results)), texts=3)}
<h3>Larger swarms (Figure 3)</h3>
{table_html(_CONTRASTS, _contrast_rows(both, in_larger_swarms(results)), texts=3)}
<h3>Linear scaling (Figure 3)</h3>
{table_html(_SCALING, _scaling_rows(results), texts=2)}
<p class="muted">Least squares over all runs. Gain: what a robot adds from 10 to 20 robots, relative
to one from 5 to 10; 1 on a straight line, less if robots hinder each other.</p>"""


def _rules_section(results: Results) -> str:
    shown = {
        "Table 1: hand-coded": HAND_CODED,
        "Table 2: EVO 8": EVO_8,
        f"The best evolved here: {results.best}": results.best,
    }
    tables = "\n".join(
        f"<div><h3>{escape(heading)}</h3>\n{format_html(results.rule_sets[name])}</div>"
        for heading, name in shown.items()
    )
    return f'<h2>Rules</h2>\n<div class="side-by-side rules">{tables}</div>'


def _sensing_section(results: Results) -> str:
    zone_miss = load_scenario("paper").zone_miss
    marks = {f"this campaign {zone_miss:g}": zone_miss}
    marks |= {f"crossing {at:.3f}": at for at in crossings(results.sensitivity)}
    curves = sensitivity_curves(
        results.sensitivity, _colours(results), argos_over_zone_miss(), marks
    )
    curves.update_layout(width=_SENSITIVITY_WIDTH, height=420)
    caption = (
        "Means, bands and bars of one standard deviation. Diamonds: ARGoS 3, 20 runs each, the two "
        "rule sets drawn a little apart."
    )
    return f"""<h2 id="sensing">Sensing of zones</h2>
<p>{escape(verdict_on_zone_miss(results.sensitivity, zone_miss))} The value was chosen with the
paper's order in view.</p>
{figure_html(curves, "figure-sensitivity", caption)}"""


def _agreement_section(results: Results) -> str:
    rows, differences = [], []
    for case, there in argos().items():
        here = results.agreement[case]
        difference = (here.mean - there.mean) / there.mean
        error = math.sqrt(sum(one.fitness.var(ddof=1) / one.fitness.size for one in (here, there)))
        reach = 1.96 * error / there.mean
        differences.append(difference)
        figures = [f"{one.mean:.1f} ± {one.summary()['sd']:.1f}" for one in (there, here)]
        interval = f"{_percent(difference - reach)} to {_percent(difference + reach)}"
        rows.append([case.scenario.name, case.rules, *figures, _percent(difference), interval])
    headings = ("scenario", "rules", "ARGoS 3", "GESwarm", "difference", "95 % interval")
    return f"""<h2>Agreement with ARGoS 3</h2>
<p>Collected objects, mean ± standard deviation: 20 runs in ARGoS 3 (foot-bot, dynamics2d),
{results.plan.evaluations} here. The largest difference of means is
{_percent(max(differences, key=abs))}.</p>
{table_html(headings, rows, texts=2)}"""


def _percent(share: float) -> str:
    return f"{share:+.1%}".replace("-", "−")


def _colours(results: Results) -> dict[str, str]:
    """Of the rule sets: one for all that evolved, another for the best of them."""
    hand_coded, evo8, best, *_ = PALETTE
    evolved = dict.fromkeys(results.evolved, _EVOLVED)
    return {**evolved, results.best: best, EVO_8: evo8, HAND_CODED: hand_coded}


def _colours_of_runs(results: Results) -> dict[str, str]:
    """Of the evolutionary runs: up to ten all different; the best as elsewhere."""
    *_, best = PALETTE[:3]
    others = [name for name in results.evolved if name != results.best]
    return {**dict(zip(others, cycle(PALETTE[3:]), strict=False)), results.best: best}


_CONTRASTS = ("scenario", "rules", "against", "mean", "mean of the other", "p", "p (Holm)", "A")
_SCALING = ("experiment", "rules", "slope", "intercept", "R²", "gain", "95 % low", "95 % high")


def _contrast_rows(samples: Samples, found: Sequence[Contrast]) -> list[Sequence[str]]:
    return [
        (
            one.a.scenario.name,
            one.a.rules,
            one.b.rules,
            f"{samples[one.a].mean:.1f}",
            f"{samples[one.b].mean:.1f}",
            f"{one.comparison.p_value:#.2g}",
            f"{one.p_holm:#.2g}",
            f"{one.comparison.effect:.2f}",
        )
        for one in found
    ]


def _contrasts_csv(results: Results) -> str:
    families = {
        "2b": (results.performance, against_hand_coded(results)),
        "3": (results.scalability | results.flexibility, in_larger_swarms(results)),
    }
    rows = [
        (figure, *row)
        for figure, (samples, found) in families.items()
        for row in _contrast_rows(samples, found)
    ]
    return format_csv(("figure", *_CONTRASTS), rows)


def _scaling_rows(results: Results) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for name, samples in (("3a", results.scalability), ("3b", results.flexibility)):
        for rules in (results.best, EVO_8, HAND_CODED):
            line = scaling(samples, rules)
            figures = [f"{line.slope:.2f}", f"{line.intercept:.1f}", f"{line.r2:.3f}"]
            gains = [f"{value:.2f}" for value in (line.gain, line.low, line.high)]
            rows.append([name, rules, *figures, *gains])
    return rows
