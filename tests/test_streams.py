"""Standard input, output and error of the commands, as other programs give and read them."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from geswarm.cli import main
from geswarm.rules import load_preset, load_rule_set, parse_text

RULES = 'name "Wärme – 群れ"\n\nrule\n  do p = 0.1, RANDOM_WALK\n'
FULL = "geswarm: standard output cannot be written: No space left on device\n"
CLOSED = "geswarm: standard output cannot be written: it is closed\n"
NOT_UTF_8 = ("cp1252", "utf-16")

needs_full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is full")


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "mine.rules"
    path.write_text(RULES, encoding="utf-8")
    return str(path)


def shell(streams, *arguments, module="geswarm.cli", **environment):
    """Status, output and errors of a command with redirections as in a shell."""
    result = subprocess.run(
        ["sh", "-c", f'exec "$0" -m {module} "$@" {streams}', sys.executable, *arguments],
        capture_output=True,
        env={**os.environ, "PYTHONUNBUFFERED": "", **environment},
        stdin=subprocess.DEVNULL,
    )
    return result.returncode, result.stdout.decode("utf-8"), result.stderr.decode("utf-8")


PRINTING = [
    ["--version"],
    ["--help"],
    ["show", "evo8"],
    ["equal", "evo8", "hand-coded", "--json"],
    ["export", "evo8", "--to", "svg"],  # more than fits into a buffer
]


@needs_full
@pytest.mark.parametrize(
    ("arguments", "unbuffered"), [*((one, "") for one in PRINTING), (PRINTING[0], "1")]
)
def test_a_full_disk_behind_the_output_is_one_line_and_a_status(arguments, unbuffered):
    assert shell(">/dev/full", *arguments, PYTHONUNBUFFERED=unbuffered) == (1, "", FULL)


@pytest.mark.parametrize("arguments", PRINTING)
def test_a_closed_output_is_one_line_and_a_status(arguments):
    assert shell(">&-", *arguments) == (1, "", CLOSED)


@pytest.mark.skipif(not Path("/dev/stdout").exists(), reason="no name of standard output")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1"])
def test_a_name_of_standard_output_is_standard_output(name, tmp_path):
    arguments = ["export", "evo8", "--to", "text", "-o", name]
    assert shell(">&-", *arguments) == (1, "", CLOSED)
    log = tmp_path / "log"
    log.write_text("before\n")
    assert shell(f">>{log}", *arguments) == (0, "", "")
    assert log.read_text() == "before\n" + shell("", *arguments[:-2])[1]
    assert shell(">&-", *arguments[:-1], os.devnull) == (0, "", "")


@pytest.mark.parametrize("module", ["geswarm.cli", "geswarm.app.main"])
def test_nothing_to_print_needs_no_output(module):
    status, out, err = shell(">&-", "nonsense", "--nonsense", module=module)
    assert (status, out) == (2, "")
    assert "error: " in err


@needs_full
def test_a_table_is_lost_with_one_line(tmp_path):
    (tmp_path / "quick.yaml").write_text("extends: paper\nduration: 20\n")
    arguments = ["evaluate", "evo8", "--runs", "2", "--scenario", str(tmp_path / "quick.yaml")]
    status, _, err = shell(">/dev/full", *arguments)
    assert status == 1
    assert err.endswith(f"\n{FULL}")
    assert "Traceback" not in err


@needs_full
def test_a_page_is_written_even_if_the_table_is_lost(tmp_path):
    (tmp_path / "quick.yaml").write_text("extends: paper\nduration: 20\n")
    page = tmp_path / "page.html"
    arguments = ["compare", "evo8", "--runs", "2", "--scenario", str(tmp_path / "quick.yaml")]
    assert shell(">/dev/full", *arguments, "--html", str(page))[0] == 1
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


@pytest.mark.parametrize("arguments", [["show", "evo8"], ["export", "evo8", "--to", "svg"]])
def test_who_has_read_enough_is_no_error(arguments):
    read, write = os.pipe()
    os.close(read)
    result = subprocess.run(
        [sys.executable, "-m", "geswarm.cli", *arguments],
        stdout=write,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONUNBUFFERED": ""},
    )
    os.close(write)
    assert (result.returncode, result.stderr) == (1, b"")


@pytest.mark.parametrize("streams", ["2>&-", pytest.param("2>/dev/full", marks=needs_full)])
def test_what_is_said_on_the_side_may_get_lost(streams):
    arguments = ["export", "evo8", "--to", "automode"]
    status, out, err = shell("", *arguments)
    assert "warning: AutoMoDe" in err
    assert shell(streams, *arguments) == (status, out, "") == (0, out, "")


@pytest.mark.slow
@pytest.mark.parametrize(
    "streams", [">&- 2>&- <&-", pytest.param(">/dev/full 2>&1", marks=needs_full)]
)
def test_evolution_goes_on_without_anybody_to_tell(streams, tmp_path):
    (tmp_path / "quick.yaml").write_text("extends: paper\nduration: 20\n")
    arguments = ["--no-ui", "--generations", "2", "--population", "8", "--evaluations", "1"]
    arguments += ["--scenario", str(tmp_path / "quick.yaml"), "--out", str(tmp_path / "run")]
    assert shell(streams, *arguments, module="geswarm.app.main") == (0, "", "")
    assert load_rule_set(str(tmp_path / "run" / "best.yaml")).rules


def test_files_are_not_taken_for_streams_that_are_closed(tmp_path):
    path = tmp_path / "out.json"
    arguments = ["export", "evo8", "--to", "json", "-o", str(path)]
    assert shell(">&- 2>&- <&-", *arguments) == (0, "", "")
    assert load_rule_set(str(path)) == load_preset("evo8")


def test_a_closed_input_is_told():
    assert shell("<&-", "show", "-") == (
        2,
        "",
        "geswarm: <stdin>: cannot be read: it is closed\n",
    )


@pytest.mark.parametrize("encoding", NOT_UTF_8)
def test_it_reads_back_what_it_wrote_whatever_the_locale(mine, tmp_path, encoding):
    for verb, option, form in (("show", "--as", "yaml"), ("export", "--to", "json")):
        path = tmp_path / f"again.{form}"
        again = f">{path}"
        status = shell(again, verb, mine, option, form, PYTHONIOENCODING=encoding)
        assert status == (0, "", "")
        assert load_rule_set(str(path)) == parse_text(RULES)
    out = shell(f"<{mine}", "show", "-", "--as", "text", PYTHONIOENCODING=encoding)[1]
    assert out == RULES


def test_pictures_and_tables_are_utf_8_in_the_plainest_locale(mine):
    plain = {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    assert "Wärme – 群れ" in shell("", "export", mine, "--to", "svg", **plain)[1]
    status, out, err = shell(f"<{mine}", "equal", "-", "evo8", "--json", **plain)
    assert (status, err) == (1, "")
    assert json.loads(out)["equal"] is False
    assert "─" in shell("", "show", mine, **plain)[1]


def test_input_that_is_not_utf_8_is_told(tmp_path):
    path = tmp_path / "latin.rules"
    path.write_bytes(RULES.encode("cp1252", "ignore"))
    status, out, err = shell(f"<{path}", "show", "-", LC_ALL="C", PYTHONIOENCODING="cp1252")
    assert (status, out) == (2, "")
    assert err.startswith("geswarm: <stdin>: not a text file, not UTF-8 at byte 7")


@pytest.mark.parametrize("arguments", [["evaluate", "evo8", "--runs", "1"], ["bench"]])
def test_a_compiler_that_is_switched_off_is_told_in_one_line(arguments):
    status, out, err = shell("", *arguments, NUMBA_DISABLE_JIT="1")
    said = "NUMBA_DISABLE_JIT is set, but the simulator runs only compiled: unset it"
    assert (status, out, err) == (2, "", f"geswarm: {said}\n")


def test_streams_of_a_notebook_stay_as_they_are(monkeypatch):
    out = io.StringIO()
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stdin", io.StringIO(RULES))
    assert main(["show", "-", "--as", "text"]) == 0
    assert sys.stdout is out
    assert out.getvalue() == RULES
