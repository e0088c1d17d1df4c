"""The paper's tables in LaTeX: their form, and that they compile whatever the comments say."""

import re
import shutil
import subprocess
from dataclasses import replace

import pytest
from hypothesis import given

from geswarm.exports import format_latex
from geswarm.rules import Rule, RuleSet, load_preset
from tests import strategies
from tests.exports.test_exports import EVO8, HAND_CODED, NASTY

LATEX_COMMANDS = set(re.findall(r"\w+", """
    documentclass usepackage begin end centering hline multicolumn textwidth raggedright textit
    mathcal mathit varepsilon leftarrow cdot caption quad ifdefined fi DeclareUnicodeCharacter
    texttt renewcommand arraystretch footnotesize scriptsize itshape mbox setlength tabcolsep
    textbackslash textasciitilde
    textasciicircum textless textgreater textbar textquotedbl textasciigrave
"""))  # fmt: skip


LATIN = " ".join(map(chr, range(0xA0, 0x250)))
WORST = replace(
    NASTY,
    rules=(
        *NASTY.rules,
        Rule(comment="\\ {} # % & _ $ ^ ~ ä → – \u200b \u0301 \U0001f916\n\nend"),
        Rule(comment=LATIN),
    ),
    name="100 %_of & #1 \\ {ä → 中}",
)

MANY = RuleSet(10 * EVO8.rules, name="Forty rules")


def test_latex_has_the_form_of_the_papers_tables():
    text = format_latex(EVO8)
    rows = [re.sub(r"\s+", " ", line.strip()) for line in text.splitlines()]
    at = rows.index(
        r"$\mathcal{B}_{2}$ & $B_{\mbox{\scriptsize\itshape RANDOM\_WALK}}$ & "
        r"$B_{\mbox{\scriptsize\itshape ANTI{-}PHOTOTAXIS}}$ & \\"
    )
    nest = r"P_{\mbox{\scriptsize\itshape ON\_NEST}}"
    assert rows[at - 1] == rf"$\mathcal{{P}}_{{2}}$ & ${nest} == \mathit{{true}}$ & & \\"
    assert rows[at + 1 : at + 4] == [
        r"$\mathcal{A}_{2}$ & $A_B$ & $p = 1$ & "
        r"$B \leftarrow B_{\mbox{\scriptsize\itshape PHOTOTAXIS}}$ \\",
        r"& $A_{IS}$ & $p = 1$ & "
        r"$IS_{\mbox{\scriptsize\itshape DROP\_OBJECT}} \leftarrow \mathit{true}$ \\",
        r"\hline",
    ]
    assert r"$\mathcal{P}_{1}$ & $\varepsilon$ & & \\" in rows
    assert r"\begin{table}" in rows


def test_more_rules_than_fit_on_a_page_go_on_on_the_next():
    text = format_latex(MANY)
    assert r"\usepackage{longtable}" in text
    assert r"\begin{table}" not in text
    assert all(f"$R_{{{number}}}$:" in text for number in range(1, 41))


@given(strategies.documented_rule_sets)
def test_latex_stays_in_balance_whatever_the_comments(rule_set):
    text = format_latex(rule_set)
    plain = re.sub(r"\\[\\{}$&#%_]", "", text)
    depth = 0
    for character in plain:
        depth += (character == "{") - (character == "}")
        assert depth >= 0
    assert depth == 0
    assert plain.count("$") % 2 == 0
    assert "%" not in plain
    assert "#" not in plain
    commands = set(re.findall(r"\\([a-zA-Z]+)", plain))
    assert commands <= LATEX_COMMANDS, commands - LATEX_COMMANDS
    rows = [line for line in plain.split(r"\begin{document}")[1].splitlines() if " & " in line]
    assert all(row.count("&") in (1, 3) for row in rows)


@pytest.mark.skipif(not shutil.which("pdflatex"), reason="pdflatex (texlive) is not installed")
@pytest.mark.parametrize(
    "rule_set", [EVO8, HAND_CODED, load_preset("evolved"), WORST, MANY, RuleSet()]
)
def test_latex_compiles_and_fits_the_page(rule_set, tmp_path):
    (tmp_path / "table.tex").write_text(format_latex(rule_set), encoding="utf-8")
    command = ["pdflatex", "-halt-on-error", "-interaction=nonstopmode", "table.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True)
    said = done.stdout.decode(errors="replace")
    assert done.returncode == 0, said
    assert "Overfull" not in said
    assert "too large for page" not in said
    assert "Missing character" not in said
