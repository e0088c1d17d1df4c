import pytest

from geswarm.ge.grammar import Grammar, GrammarError, NonTerminal


def findings(text, vocabulary=None):
    with pytest.raises(GrammarError) as caught:
        Grammar.parse(text, "toy.bnf", vocabulary)
    return list(caught.value.findings)


def test_reads_the_common_subset():
    grammar = Grammar.parse(
        """
        # a comment with <names> ::= and | in it
        <expr> ::= <expr> <op> <expr>   # the rest of a line
                 | "(" <expr> ')'
                 | x | 1.0 |
                   "two words" | ""
        <op> ::= +|'|'|"#"
        """
    )
    expr, op, space = NonTerminal("expr"), NonTerminal("op"), " "
    assert grammar.start == "expr"
    assert grammar.rules == {
        "expr": (
            (expr, space, op, space, expr),
            ("(", space, expr, space, ")"),
            ("x",),
            ("1.0",),
            ("two", space, "words"),
            (),
        ),
        "op": (("+",), ("|",), ("#",)),
    }
    assert grammar.warnings == ()


def test_white_space_is_kept_between_symbols_only():
    grammar = Grammar.parse("<a> ::=  <b>x   y <b>\n  # comment\n  | ' x ' \n<b> ::= z ")
    b = NonTerminal("b")
    assert grammar.rules["a"] == ((b, "x", " ", "y", " ", b), (" ", "x", " "))
    assert grammar.rules["b"] == (("z",),)


def test_symbols_need_no_space_between_them():
    grammar = Grammar.parse("<e> ::= sin(<e>)+<e>|x<y\n")
    e = NonTerminal("e")
    assert grammar.rules["e"] == (("sin(", e, ")+", e), ("x<y",))


def test_escapes_in_quotes_mean_what_they_mean_in_ponyge2():
    grammar = Grammar.parse(
        r"""<a> ::= 'if x:\n\ty  = "\\d"\n' | "\"" | '\'' | "\\" "\r\f\v\a\b" """
    )
    assert grammar.rules["a"] == (
        ("if", " ", "x:\n\ty", " ", " ", "=", " ", '"\\d"\n'),
        ('"',),
        ("'",),
        ("\\", " ", "\r\f\v\a\b"),
    )


def test_a_line_break_between_symbols_stays():
    grammar = Grammar.parse("<a> ::= 'x'  \n  y<b>\n\n\tz\n  | # c\n  u\n<b> ::= ''\n v\n\n# end")
    b = NonTerminal("b")
    assert grammar.rules["a"] == (("x", "\n", "y", b, "\n\n\t", "z"), ("u",))
    assert grammar.rules["b"] == (("\n", "v"),)


@pytest.mark.parametrize("name", ["0_9", "1st", "größe", "a+b", "a.b:c-d", "=", "日本"])
def test_names_are_those_of_ponyge2_and_geva(name):
    grammar = Grammar.parse(f"<s> ::= -<{name}>x | y\n<{name}>::=z")
    assert grammar.rules["s"][0] == ("-", NonTerminal(name), "x")
    first = findings(f"<s> ::= <{name}> | x")[0]
    assert first.startswith(f"toy.bnf:1: <{name}> is not defined")


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", 1, "there is no rule"),
        ("# nothing\n\n", 1, "there is no rule"),
        ("# one\nhello <a> ::= b", 2, "expected <name> ::= to begin a rule, got 'hello'"),
        ("<a> ::= 'b\n | c", 1, "expected a closing '"),
        ("<a> ::= b\n\n<c> ::= d\n<a> ::= e\n", 4, "<a> is already defined in line 1"),
        ("<a> ::= b\n  | <c> <c>", 2, "<c> is not defined"),
        ("<a> ::= b |\n<c> ::= d", 2, "expected an alternative, got nothing"),
        ("<a> ::= b | | c", 1, "expected an alternative, got nothing"),
        ("<a> ::= b <c> ::= d", 1, "<c> ::= must begin a line"),
        ("<a> ::= b ::= c", 1, "unexpected ::="),
        ("<a> ::= b\n<c> ::= <d>\n<d> ::= <c> x", 2, "<c> never ends"),
        ("<a> ::= <GECodonValue{1, 2}>", 1, "GECodonValue is not supported"),
        ("<a> ::= b\\n", 1, "unexpected backslash"),
        (r"<a> ::= '\d'", 1, r"expected \\ for a backslash"),
        (r"<a> ::= '\x41'", 1, r"or \n \t"),
        (r"<a> ::= 'b\'", 1, "expected a closing '"),
        ("<a> ::= x # c\n  y", 2, "expected | or the end of the rule after a comment, got 'y'"),
        ("<my name> ::= x", 1, "expected a name without white space"),
        ("<a> ::= x\n<it's> ::= x", 2, "expected a name without white space, |, quotes"),
        ("<> ::= x", 1, "expected a name"),
        ("<a> ::= x <my name> | y", 1, "expected a name without white space, or quotes"),
        ("<a> ::= x[<b>]\n<b> ::= GE_RANGE:n_vars", 2, "GE_RANGE is not supported"),
    ],
)
def test_an_error_says_where_and_what_was_expected(text, line, message):
    first = findings(text)[0]
    assert first.startswith(f"toy.bnf:{line}: ")
    assert message in first


def test_all_errors_come_at_once_in_the_order_of_the_file():
    found = findings('<a> ::= "b | c\n<b> ::= <nowhere>\n<a> ::= d\n<d> ::= | e\n')
    assert [text.split(":")[1] for text in found] == ["1", "2", "3", "4"]


def test_expansion_without_choices_is_bounded():
    doubling = "<s> ::= <a0> | x\n" + "".join(
        f"<a{i}> ::= <a{i + 1}> <a{i + 1}>\n" for i in range(40)
    )
    assert "without a choice" in findings(doubling + "<a40> ::= y\n")[0]


def test_an_unreachable_rule_is_a_warning():
    grammar = Grammar.parse("<a> ::= b\n<c> ::= <d>\n<d> ::= e", "toy.bnf")
    assert [text.split(" ")[1] for text in grammar.warnings] == ["<c>", "<d>"]
    assert grammar.warnings[0].startswith("toy.bnf:2: ")


def test_vocabulary_fills_open_names():
    grammar = Grammar.parse("<a> ::= <b> | x", vocabulary={"b": ["one", "two words"]})
    assert grammar.rules["b"] == (("one",), ("two", " ", "words"))


def test_vocabulary_errors():
    text = "<a> ::= <b> | x"
    assert "<b> is not defined" in findings(text)[0]
    assert "empty" in findings(text, {"b": []})[0]
    assert "no rule uses" in findings(text, {"b": ["y"], "c": ["z"]})[0]
    assert "defined here" in findings(text, {"b": ["y"], "a": ["z"]})[0]


def test_a_file_that_cannot_be_read(tmp_path):
    with pytest.raises(GrammarError, match=r"nowhere\.bnf: cannot be read"):
        Grammar.load(tmp_path / "nowhere.bnf")
    (tmp_path / "latin.bnf").write_bytes(b"<a> ::= \xe9")
    with pytest.raises(GrammarError, match="cannot be read"):
        Grammar.load(tmp_path / "latin.bnf")


def test_load_reports_the_file(tmp_path):
    path = tmp_path / "mine.bnf"
    path.write_text("<a> ::= <b>\n")
    with pytest.raises(GrammarError) as caught:
        Grammar.load(path)
    assert str(caught.value).startswith(f"{path}:1: <b> is not defined")
