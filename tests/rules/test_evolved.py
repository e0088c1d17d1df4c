"""The preset `evolved` is what the published campaign found."""

from pathlib import Path

from geswarm.rules import load_preset, read_rule_set
from geswarm.rules.compare import same_behaviour

PUBLISHED = Path(__file__).parents[2] / "static" / "reproduction" / "rules" / "seed-5.yaml"


def test_the_preset_is_the_best_of_the_campaign():
    published = read_rule_set(PUBLISHED.read_text(encoding="utf-8"))
    evolved = load_preset("evolved")
    assert same_behaviour(evolved, published)
    assert (evolved.origin.run, evolved.origin.generation) == ("evolution/seed-5", 812)
