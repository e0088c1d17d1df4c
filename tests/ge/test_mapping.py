"""Mapping against a plain twin, and the inverse against the mapping."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geswarm.ge.grammar import Grammar, GrammarError, NonTerminal
from geswarm.ge.inverse import NotASentenceError, choices_of, genome_of
from geswarm.ge.mapping import CODON_LIMIT, Derivation, Mapper

codons = st.lists(st.integers(0, CODON_LIMIT - 1), min_size=1, max_size=60)


def naive_map(grammar, genome, max_wraps):
    """The definition, word by word: rewrite the leftmost non-terminal until none is left."""
    sentence, at, passes = [NonTerminal(grammar.start)], 0, 0
    words, used = [], 0
    while sentence:
        symbol = sentence.pop(0)
        if isinstance(symbol, str):
            words.append(symbol)
            continue
        alternatives = grammar.rules[symbol.name]
        chosen = 0
        if len(alternatives) > 1:
            if at == len(genome):
                at, passes = 0, passes + 1
            if passes > max_wraps:
                return None, used
            chosen = genome[at] % len(alternatives)
            at, used = at + 1, used + 1
        sentence = [*alternatives[chosen], *sentence]
    return spaced("".join(words)), used


def spaced(text):
    """Several spaces are one, but for those that a line after the first begins with."""
    kept = ""
    for character in text.strip(" "):
        indented = kept.rpartition("\n")[1] and not kept.rpartition("\n")[2].strip(" ")
        if character != " " or indented or not kept.endswith(" "):
            kept += character
    return kept


@st.composite
def grammars(draw):
    """Small grammars: recursive on any side, ambiguous, with empty and forced productions."""
    names = ["s", "a", "b", "c"]
    words = ["x", "y", "xy", "x-", ",", "0.1", "0", " "]
    words += ["'x y'", "' '", "'  '", r"'\n'", r"'x\n  '"]
    symbol = st.sampled_from([*words, *(f"<{n}>" for n in names)])
    alternative = st.lists(symbol, max_size=6).map(lambda symbols: "".join(symbols).strip() or '""')
    rules = []
    for name in names:
        alternatives = draw(st.lists(alternative, min_size=1, max_size=4))
        rules.append(f"<{name}> ::= {' | '.join(alternatives)}")
    try:
        return Grammar.parse("\n".join(rules))
    except GrammarError:
        assume(False)


@given(genome=codons, max_wraps=st.integers(0, 4))
def test_geswarm_mapping_equals_its_twin(mapper, grammar, genome, max_wraps):
    assert mapper.map(genome, max_wraps) == naive_map(grammar, genome, max_wraps)


@given(grammar=grammars(), genome=codons, max_wraps=st.integers(0, 3))
def test_any_mapping_equals_its_twin_and_has_an_inverse(grammar, genome, max_wraps):
    mapper = Mapper(grammar)
    derivation = mapper.map(genome, max_wraps)
    twin = naive_map(grammar, genome, max_wraps)
    assert derivation.used == twin[1]
    if derivation.phenotype is None:
        assert twin[0] is None
        return
    assert derivation.phenotype == twin[0]
    assert mapper.map(genome_of(grammar, twin[0]), 0).phenotype == derivation.phenotype


@given(genome=codons, seed=st.integers(0, 2**32))
def test_the_inverse_of_a_rule_set_maps_back_to_it(mapper, grammar, genome, seed):
    phenotype = mapper.map(genome, 30).phenotype
    assume(phenotype is not None)
    drawn = genome_of(grammar, phenotype, np.random.default_rng(seed))
    smallest = genome_of(grammar, phenotype)
    assert all(0 <= codon < CODON_LIMIT for codon in drawn)
    assert mapper.map(drawn, 0) == mapper.map(smallest, 0) == Derivation(phenotype, len(drawn))


def test_codons_are_read_only_at_choices_depth_first():
    grammar = Grammar.parse("<s> ::= <a> mid <b>\n<a> ::= <b> | z\n<b> ::= p | q | r")
    assert Mapper(grammar).map([4, 5, 7, 99]) == Derivation("r mid q", 3)


def test_a_grammar_without_choice_reads_nothing():
    mapper = Mapper(Grammar.parse('<s> ::= a <b> ""\n<b> ::= c'))
    assert mapper.map([7], 0) == Derivation("a c", 0)
    assert mapper.map([], 0) == Derivation("a c", 0)
    assert genome_of(mapper.grammar, "a c") == (0,)


def test_wraps_are_further_passes():
    # GEVA: max_wraps = 3 lets the genome be read four times.
    grammar = Grammar.parse("<s> ::= <s> x | y")
    once_more = [0, 0]  # never ends: every codon chooses the recursion
    assert Mapper(grammar).map(once_more, 3) == Derivation(None, 8)
    bits = Mapper(Grammar.parse("<s> ::= <b> <b> <b> <b>\n<b> ::= 0 | 1"))
    assert bits.map([1], 3) == Derivation("1 1 1 1", 4)
    assert bits.map([1], 2) == Derivation(None, 3)
    assert bits.map([0, 1], 1) == Derivation("0 1 0 1", 4)
    assert bits.map([0, 1, 1], 0).phenotype is None


def test_words_of_the_language(mapper):
    text = "rule if ON_NEST == true and HAS_OBJECT == false while RANDOM_WALK or PHOTOTAXIS "
    text += "do p = 0.1, ANTI-PHOTOTAXIS do p = 1, DROP_OBJECT = true rule do p = 0.05, PHOTOTAXIS"
    assert mapper.map(genome_of(mapper.grammar, text), 0).phenotype == text


def test_the_choices_are_the_papers(grammar):
    text = "rule if HAS_OBJECT == false do p = 0.005, WANT_OBJECT = true"
    assert choices_of(grammar, text) == [
        (1, 2),  # one rule (2)
        (0, 2),  # a precondition (4)
        (1, 2),  # == false (7)
        (2, 3),  # HAS_OBJECT
        (1, 2),  # no further precondition (4)
        (1, 2),  # any behaviour (5)
        (1, 2),  # one action (6)
        (1, 2),  # an internal state (9)
        (1, 8),  # 0.005
        (0, 2),  # WANT_OBJECT
        (0, 2),  # true
    ]


def test_what_touches_in_the_grammar_touches_in_the_sentence():
    grammar = Grammar.parse("<n> ::= <d><d>.<d> | - <n>\n<d> ::= 0 | 1 | 2")
    mapper = Mapper(grammar)
    assert mapper.map([1, 0, 1, 2, 0]) == Derivation("- 12.0", 5)
    assert genome_of(grammar, "- 12.0") == (1, 0, 1, 2, 0)
    assert genome_of(grammar, "-12.0") == (1, 0, 1, 2, 0)
    with pytest.raises(NotASentenceError):
        genome_of(grammar, "1 2.0")


def test_a_space_of_the_grammar_tells_derivations_apart():
    grammar = Grammar.parse("<n> ::= <d> <d> | <d><d>\n<d> ::= 0 | 1 | ''")
    for text in ("1 0", "10", "1", ""):
        assert Mapper(grammar).map(genome_of(grammar, text), 0).phenotype == text


awkward = st.text(st.sampled_from("x0 <>|:='\"\\#\n\t\r\u2028é"), max_size=8)


def quoted(text, quote):
    for character, escaped in (("\\", r"\\"), ("\n", r"\n"), ("\r", r"\r"), (quote, f"\\{quote}")):
        text = text.replace(character, escaped)
    return f"{quote}{text}{quote}"


@given(st.lists(st.lists(awkward, min_size=1, max_size=3), min_size=2, max_size=4), st.data())
def test_a_grammar_that_was_written_derives_its_sentences(alternatives, data):
    def written(texts):
        quotes = (data.draw(st.sampled_from("'\"")) for _ in texts)
        return "".join(map(quoted, texts, quotes))

    grammar = Grammar.parse(f"<s> ::= {' | '.join(map(written, alternatives))}")
    mapper = Mapper(grammar)
    for number, texts in enumerate(alternatives):
        sentence = mapper.map([number]).phenotype
        assert sentence == spaced("".join(texts))
        assert mapper.map(genome_of(grammar, sentence)).phenotype == sentence


def test_lines_keep_their_indentation():
    grammar = Grammar.parse(
        r"<p> ::= 'if  x:\n'<b>'\n' | <b>" + "\n<b> ::= '    ' <c>\n<c> ::= 'y  z'"
    )
    for codon, sentence in ((0, "if x:\n     y z\n"), (1, "y z")):
        assert Mapper(grammar).map([codon]).phenotype == sentence
        assert genome_of(grammar, sentence) == (codon,)


def test_white_space_does_not_matter(mapper):
    text = "\n  rule\tif ON_NEST==true\n  do p=0.1,PHOTOTAXIS  \n"
    genome = genome_of(mapper.grammar, text)
    assert mapper.map(genome, 0).phenotype == "rule if ON_NEST == true do p = 0.1, PHOTOTAXIS"


@pytest.mark.parametrize(
    ("text", "line", "column", "expected"),
    [
        ("", 1, 1, ("'rule'",)),
        ("rule if ON_NEST ==\n  treu do", 2, 3, ("'true'", "'false'")),
        (
            "rule do p = 0.1, PHOTOTAXIS\nrule if",
            2,
            8,
            ("'ON_NEST'", "'ON_SOURCE'", "'HAS_OBJECT'"),
        ),
        ("rule do p = 0.1, PHOTOTAXIS stop", 1, 29, ("'do'", "'rule'", "the end")),
        ("rule do p = 0.1, WANT_OBJECT == true", 1, 31, ("'true'", "'false'")),
    ],
)
def test_what_is_no_sentence(grammar, text, line, column, expected):
    with pytest.raises(NotASentenceError) as caught:
        genome_of(grammar, text)
    error = caught.value
    assert (error.line, error.column) == (line, column)
    assert set(error.expected) == set(expected)
    assert f"line {line}, column {column}" in str(error)


def test_a_word_is_not_the_beginning_of_a_longer_one(grammar):
    with pytest.raises(NotASentenceError, match=r"got '0\.15'"):
        genome_of(grammar, "rule do p = 0.15, PHOTOTAXIS")
    with pytest.raises(NotASentenceError, match=r"after 'rule do p = 0\.1,'"):
        genome_of(grammar, "rule do p = 0.1, PHOTOTAXISrule do p = 0.1, PHOTOTAXIS")


def test_long_sentences_need_no_deep_recursion(mapper):
    text = " ".join(["rule do p = 0.1, PHOTOTAXIS"] * 400)
    genome = genome_of(mapper.grammar, text)
    assert len(genome) == 400 * 7
    assert mapper.map(genome, 0).phenotype == text
