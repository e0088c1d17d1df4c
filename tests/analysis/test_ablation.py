from dataclasses import replace

from hypothesis import given

from geswarm.analysis import Piece, pieces, without, worth_of_pieces
from geswarm.rules import RuleSet, load_preset
from geswarm.sim import load_scenario
from tests.strategies import plain_rule_sets

EVO8 = load_preset("evo8")
PARTS = ("preconditions", "behaviours", "actions")


def size(rule_set):
    return sum(len(getattr(rule, part)) for rule in rule_set.active_rules for part in PARTS)


@given(plain_rule_sets())
def test_each_piece_takes_out_exactly_itself(rule_set):
    found = list(pieces(rule_set))
    assert len(found) == len(set(found)) == len(rule_set.rules) + size(rule_set)
    for piece in found:
        rest = without(rule_set, piece)
        rule = rule_set.rules[piece.rule]
        lost = size(RuleSet((rule,))) if piece.part == "rule" else 1
        assert size(rest) == size(rule_set) - lost


def test_rules_switched_off_have_no_pieces():
    off = replace(EVO8, rules=tuple(replace(rule, enabled=False) for rule in EVO8.rules))
    assert list(pieces(off)) == []


def test_dropping_in_the_nest_is_what_evo8_lives_by():
    quick = load_scenario("paper").with_changes(duration=1000.0)
    worths = {found.piece: found.change for found in worth_of_pieces(EVO8, quick, runs=10)}
    whole_rule_2, dropping = worths[Piece(1)], worths[Piece(1, "actions", 1)]
    assert whole_rule_2.high < -10
    assert dropping.high < -10
    assert worths[Piece(3)].difference > -10  # R4 is nearly superfluous
