"""What fits on a narrow terminal, and into the name of a file."""

import re

import pytest
from rich.console import Console
from rich.progress import MofNCompleteColumn, Progress, TaskProgressColumn

from geswarm.cli.output import print_table, progress_columns, shortened

FIGURES = ["1234.5", "0.00012", "-17.25"]


@pytest.mark.parametrize("columns", [120, 80, 40, 20])
def test_a_table_folds_names_and_leaves_figures_whole(columns, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", str(columns))
    names = [f"{'long/' * 30}{number}" for number in (1, 2)]
    headings = ["mean", "p (Holm)", "lost (mean)"]
    print_table("Title", ["rules"], headings, [[name, *FIGURES] for name in names])
    out = capsys.readouterr().out
    assert all(out.split().count(figure) == 2 for figure in FIGURES)
    assert all(word in out.split() for heading in headings for word in heading.split())
    for figure in FIGURES:
        out = out.replace(figure, "")
    assert all(name in re.sub(r"\s+", "", out) for name in names)
    if columns >= 40:
        assert max(map(len, out.splitlines())) <= columns


@pytest.mark.parametrize("columns", [120, 80, 40, 30])
@pytest.mark.parametrize(
    ("count", "shown"), [(MofNCompleteColumn, "1723/3000"), (TaskProgressColumn, "57%")]
)
def test_progress_is_whole_in_a_narrow_terminal(columns, count, shown):
    console = Console(width=columns)
    text = "best 123.4, mean 100.1, [invalid 12], 2.3 generations/s,"
    progress = Progress(
        *progress_columns(count, "{task.description}"), console=console, expand=True
    )
    progress.add_task(text, total=3000, completed=1723)
    with console.capture() as capture:
        console.print(progress.get_renderable())
    lines = capture.get().splitlines()
    assert lines[0].split()[0] == shown
    assert lines[0].split()[-2:] == ["--:--", "left"]
    assert max(map(len, lines)) <= columns
    folded = re.sub(r"\s+|--:--|left|[━╸╺]", "", capture.get())
    assert folded == shown + text.replace(" ", "")


def test_names_are_shortened_only_if_they_are_long():
    for stem in ("paper", "n" * 100, "群" * 33):
        assert shortened(stem) == stem
    for stem in ("n" * 101, "群" * 34, "\udcff" * 200):
        short = shortened(stem)
        assert len(short.encode()) <= 100
        assert short != shortened(stem + "1")
