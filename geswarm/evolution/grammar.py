"""The paper's grammar over a vocabulary: its sentences are rule sets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from importlib import resources

from geswarm.ge import Grammar
from geswarm.rules import FORAGING, Vocabulary
from geswarm.rules.arguments import Argument
from geswarm.rules.elements import format_probability
from geswarm.rules.model import Value, format_value


@lru_cache(maxsize=64)
def rule_grammar(vocabulary: Vocabulary = FORAGING) -> Grammar:
    """The grammar whose sentences are the rule sets that a vocabulary allows (section 2.2)."""
    text = resources.files(__package__).joinpath("geswarm.bnf").read_text(encoding="utf-8")
    productions = [f"<{name}> ::= {' | '.join(each)}" for name, each in _productions(vocabulary)]
    return Grammar.parse("\n".join([text, *productions, ""]), source="geswarm.bnf")


def _productions(vocabulary: Vocabulary) -> Iterator[tuple[str, list[str]]]:
    """Productions 7, 9 and 11, the words, and the numbers in the parentheses of terms."""
    truths, compared, arguments = [], [], []
    for entry in vocabulary.percepts.values():
        values = vocabulary.values_of(entry.name)
        term = _term(entry.name, entry.arguments)
        arguments += [(f"{entry.name}.{each.name}", each) for each in entry.arguments]
        if isinstance(values[0], bool):
            truths.append(term)
        else:
            compared.append((entry.name, term, values))
    names = ['<P_name> "== true"', '<P_name> "== false"'] if truths else []
    yield "P", names + [f"{term} <{name}.is> <{name}.value>" for name, term, _ in compared]
    if truths:
        yield "P_name", truths
    for name, _, values in compared:
        ordered = not isinstance(values[0], str)
        yield f"{name}.is", ['">="', '"<"', '"=="'] if ordered else ['"=="', '"!="']
        yield f"{name}.value", _words(values[1:] if ordered else values)
    yield "B_name", [_term(entry.name, entry.arguments) for entry in vocabulary.behaviours]
    for behaviour in vocabulary.behaviours:
        arguments += [(f"{behaviour.name}.{each.name}", each) for each in behaviour.arguments]
    yield from _changes(vocabulary)
    yield "value", _words(map(format_probability, vocabulary.probabilities))
    for name, argument in arguments:
        yield name, _words(argument.offered)


def _changes(vocabulary: Vocabulary) -> Iterator[tuple[str, list[str]]]:
    """Actions: without internal states, all change the behaviour."""
    states = vocabulary.internal_states
    yield "A", ["<A_B>", "<A_IS>"] if states else ["<A_B>"]
    if not states:
        return
    flags = [entry.name for entry in states if isinstance(entry.values[0], bool)]
    others = [entry for entry in states if entry.name not in flags]
    changes = ['<IS_name> "=" <new_value>'] if flags else []
    changes += [f"<{entry.name}.change>" for entry in others]
    yield "A_IS", [f'"p =" <value>"," {change}' for change in changes]
    if flags:
        yield "IS_name", _words(flags)
        yield "new_value", ['"true"', '"false"']
    for entry in others:
        steps = [f"{entry.name} += 1", f"{entry.name} -= 1"] if entry.counts else []
        values = entry.values[:1] if entry.counts else entry.values
        sets = [f"{entry.name} = {format_value(value)}" for value in values]
        yield f"{entry.name}.change", _words([*steps, *sets])


def _term(name: str, arguments: Iterable[Argument]) -> str:
    inside = '", "'.join(f"<{name}.{argument.name}>" for argument in arguments)
    return f'"{name}("{inside}")"' if inside else f'"{name}"'


def _words(values: Iterable[Value]) -> list[str]:
    return [f'"{format_value(value)}"' for value in values]
