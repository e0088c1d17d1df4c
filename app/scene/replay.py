"""What a replay tells besides its picture: a name, where it was, and the rules while they held."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from geswarm.rules import RuleSet, format_text
from geswarm.sim import Scenario

from ..state.playback import clock
from ..state.session import Session

THESE_RULES = "these rules"
"""What the rules being edited are called beside others."""

_LONGEST_NAME = 100  # characters of a file's name

_STYLE = """
#geswarm { position: fixed; top: 1rem; right: 1rem; z-index: 50; max-width: min(20rem, 40vw);
  max-height: calc(100vh - 6rem); overflow: auto; border-radius: 0.4rem; padding: 0.5rem 0.9rem;
  background: rgb(255 255 255 / 92%); color: #1c2230; font: 13px/1.4 system-ui, sans-serif; }
#geswarm summary { cursor: pointer; font-weight: 600; }
#geswarm h2 { font-size: 1em; margin: 0.9em 0 0.3em; }
#geswarm p { margin: 0.3em 0; }
#geswarm pre { margin: 0; font: 12px/1.4 ui-monospace, monospace; white-space: pre-wrap; }
"""


@dataclass(frozen=True)
class Setting:
    """Who runs what where.

    Attributes:
        scenario: Where.
        changed: Whether the scenario is another than its name says.
        seed: Of the run.
        rules: Heading and rule set, of each swarm.
    """

    scenario: Scenario
    changed: bool
    seed: int
    rules: tuple[tuple[str, RuleSet], ...]

    @classmethod
    def of(cls, session: Session) -> Setting:
        """The setting of a session now."""
        rules = [session.document.rule_set]
        if session.rival is not None:
            rules.append(session.rival.swarm.world.rule_set)
        headings = ("", "") if session.rival is None else ("these rules: ", "beside them: ")
        return cls(
            session.scenario,
            session.scenario != session.loaded,
            session.world.seed,
            tuple(
                (f"{head}{_name(each)}", each) for head, each in zip(headings, rules, strict=False)
            ),
        )

    @property
    def place(self) -> str:
        """Scenario, robots and seed, in words."""
        changed = ", changed" if self.changed else ""
        robots = self.scenario.robots
        return (
            f"{self.scenario.name}{changed}, {robots} robot{'s' * (robots > 1)}, seed {self.seed}"
        )


@dataclass(frozen=True)
class Passage:
    """A part of a recording through which the setting stays the same.

    Attributes:
        start: Simulated time at which it begins (s).
        setting: Who forages where.
    """

    start: float
    setting: Setting


def title_of(passages: Sequence[Passage]) -> str:
    """What a replay is called: rules, scenario and when it begins."""
    first = passages[0]
    names = " and ".join(_name(rule_set) for _, rule_set in first.setting.rules)
    return f"{names} in {first.setting.scenario.name} from {clock(first.start)}"


def file_name(passages: Sequence[Passage]) -> str:
    """The same as the name of a file that any system allows."""
    words = re.findall(r"\w+", f"geswarm {title_of(passages)}".lower())
    return f"{'-'.join(words)[:_LONGEST_NAME]}.html"


def told(page: str, passages: Sequence[Passage]) -> str:
    """A replay's page with its name, and with the rules beside the picture.

    Args:
        page: HTML, as viser makes it.
        passages: At least one, in order.
    """
    title = escape(title_of(passages))
    told = "".join(_passage_html(passage) for passage in passages)
    aside = (
        f"<style>{_STYLE}</style>"
        f'<aside id="geswarm"><details open><summary>{title}</summary>{told}</details></aside>'
    )
    name = f"<title>{title} – GESwarm</title>"
    page = re.sub(r"<title>.*?</title>", lambda _: name, page, count=1, flags=re.DOTALL)
    end = page.rindex("</body>")
    return page[:end] + aside + page[end:]


def _passage_html(passage: Passage) -> str:
    rules = "".join(
        f"<h2>{escape(heading)}</h2><pre>{escape(format_text(rule_set))}</pre>"
        for heading, rule_set in passage.setting.rules
    )
    place = escape(passage.setting.place)
    return f"<section><p>from {clock(passage.start)}: {place}</p>{rules}</section>"


def _name(rule_set: RuleSet) -> str:
    return rule_set.name or "rules without a name"
