"""From phenotypes to rule sets and back.

genome --mapping--> phenotype text --parse--> RuleSet --compile--> ControlTable
   ^------inverse mapping---------------------|
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from geswarm.evolution.grammar import rule_grammar
from geswarm.ge import Grammar, NotASentenceError, genome_of
from geswarm.rules import (
    FORAGING,
    ControlTable,
    Rule,
    RuleSet,
    Vocabulary,
    format_text,
    parse_text,
)
from geswarm.rules.arguments import Argument
from geswarm.rules.elements import format_probability
from geswarm.rules.model import Action, BehaviourChange, Term, Value
from geswarm.rules.reachability import reachable_situations
from geswarm.sim import Scenario, vocabulary_of


class InjectionError(ValueError):
    """A rule set cannot enter a population; says which rule and why."""


@dataclass(frozen=True)
class Composition:
    """From phenotypes to rule sets: rules that evolution must not change, then the evolved ones.

    Attributes:
        frozen: The rules that come first; usually none.
        vocabulary: What rules may mention.
    """

    frozen: tuple[Rule, ...] = ()
    vocabulary: Vocabulary = FORAGING

    @classmethod
    def of(cls, scenario: Scenario, frozen: tuple[Rule, ...] = ()) -> Composition:
        """What phenotypes become in a scenario."""
        return cls(frozen, vocabulary_of(scenario))

    @property
    def grammar(self) -> Grammar:
        """The grammar of the phenotypes."""
        return rule_grammar(self.vocabulary)

    def rule_set(self, phenotype: str) -> RuleSet:
        """The whole rule set."""
        return _rule_set(self, phenotype)

    def phenotype(self, rule_set: RuleSet) -> str:
        """The phenotype that becomes a rule set; rules that are switched off are left out.

        Raises:
            InjectionError: It does not begin with the frozen rules, has none besides them, or the
                grammar does not derive the others: says which rule and why.
        """
        rules = tuple(map(_bare, rule_set.active_rules))
        frozen = len(self.frozen)
        for number, (rule, expected) in enumerate(zip(rules, self.frozen, strict=False), start=1):
            if rule != _bare(expected):
                raise InjectionError(f"rule {number} is frozen, expected it unchanged")
        if len(rules) <= frozen:
            raise InjectionError(f"expected more than {frozen} rules switched on, got {len(rules)}")
        for number, rule in enumerate(rules[frozen:], start=frozen + 1):
            for action in rule.actions:
                _require_listed(action.p, number, self.vocabulary)
        text = format_text(RuleSet(rules[frozen:])).removeprefix('name ""')
        phenotype = " ".join(text.split())
        try:
            genome_of(self.grammar, phenotype)
        except NotASentenceError as error:
            raise InjectionError(f"the grammar does not derive these rules: {error}") from error
        return phenotype

    def behaviour(self, phenotype: str) -> bytes:
        """Equal for phenotypes under which robots decide the same: an engine's `identity`.

        The control table in the situations that robots can get into, to twelve decimals.
        """
        return _behaviour(self, phenotype)


def nearest_offered(rule_set: RuleSet, vocabulary: Vocabulary) -> tuple[RuleSet, dict[str, str]]:
    """Rules with each number of a term as the nearest on offer, as the grammar derives them.

    Args:
        rule_set: In the words of the vocabulary.
        vocabulary: What is on offer.

    Returns:
        The rules, and each term that is another one now with what it has become.
    """
    changed: dict[str, str] = {}

    def near(term: Term) -> Term:
        known = vocabulary.percepts.get(term.name) or vocabulary.behaviour_names.get(term.name)
        declared = known.arguments if known else ()
        arguments = tuple(map(_nearest, declared, term.arguments))
        found = replace(term, arguments=arguments) if arguments else term
        if found != term:
            changed[str(term)] = str(found)
        return found

    def action_near(action: Action) -> Action:
        if isinstance(action, BehaviourChange):
            return replace(action, behaviour=near(action.behaviour))
        return action

    rules = tuple(
        replace(
            rule,
            preconditions=tuple(
                replace(each, percept=near(each.percept)) for each in rule.preconditions
            ),
            behaviours=tuple(map(near, rule.behaviours)),
            actions=tuple(map(action_near, rule.actions)),
        )
        for rule in rule_set.rules
    )
    return replace(rule_set, rules=rules), changed


def _nearest(argument: Argument, value: Value) -> Value:
    if value in argument.offered or not argument.admits(value):
        return value
    number = argument.number(value)
    return min(argument.offered, key=lambda each: abs(argument.number(each) - number))


def _require_listed(p: float, rule: int, vocabulary: Vocabulary) -> None:
    listed = vocabulary.probabilities
    if p not in listed:
        nearest = format_probability(min(listed, key=lambda one: abs(one - p)))
        raise InjectionError(
            f"rule {rule}: p = {format_probability(p)} cannot evolve, expected one of "
            f"{', '.join(map(format_probability, listed))}; the nearest is {nearest}"
        )


def _bare(rule: Rule) -> Rule:
    return replace(rule, comment="", enabled=True)


@lru_cache(maxsize=1024)  # evolution asks for its behaviour, then runs it
def _rule_set(composition: Composition, phenotype: str) -> RuleSet:
    return RuleSet(
        (*composition.frozen, *parse_text(phenotype, vocabulary=composition.vocabulary).rules)
    )


@lru_cache(maxsize=4096)
def _behaviour(composition: Composition, phenotype: str) -> bytes:
    table = ControlTable.compile(composition.rule_set(phenotype), composition.vocabulary)
    decisions = table.by_percepts.round(12)
    reachable = reachable_situations(decisions, table.space)
    told_apart = table.space.signature.encode()
    return told_apart + np.packbits(reachable).tobytes() + (decisions[reachable] + 0.0).tobytes()
