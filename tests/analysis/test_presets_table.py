"""The table of the presets: restartable, and judged by simulations that no evolution has seen."""

import pytest

from geswarm.analysis import presets_table


def test_the_table_is_made_and_made_again_without_evolving(tmp_path, capsys):
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: paper\nduration: 20\n")
    arguments = [str(tmp_path / "runs"), "--runs", "2", "--generations", "2"]
    arguments += ["--scenario", str(scenario), "--marks", "1", "2", "3"]
    assert presets_table.main(arguments) == 0
    table = capsys.readouterr().out
    rows = [[cell.strip() for cell in line.split("|")[1:4]] for line in table.splitlines()[2:]]
    assert [row[:2] for row in rows] == [
        ["`paper`", "1"],
        ["`paper`", "2"],
        ["`modern`", "1"],
        ["`modern`", "2"],
    ]
    assert rows[0][2] == "300"  # 3 of each individual; the first are all valid
    assert [row[2] for row in rows[2:]] == ["200", "500"]  # 100 are evaluated again
    assert "of 2" in table
    assert presets_table.main(arguments) == 0
    assert capsys.readouterr().out == table
    assert presets_table.main([*arguments, "--generations", "3"]) == 0
    extended = capsys.readouterr().out
    assert "| `paper` | 3 |" in extended
    assert set(table.splitlines()) < set(extended.splitlines())


def test_machines_of_automode_are_rivals_where_the_objective_may_be_negative(tmp_path, capsys):
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: grid-exploration\nduration: 2\n")
    machines = tmp_path / "machines.txt"
    machines.write_text("--fsm-config --nstates 1 --s0 0 --rwm0 5\n--nstates 1 --s0 1\n")
    arguments = [str(tmp_path / "runs"), "--runs", "1", "--generations", "1", "--presets", "modern"]
    arguments += ["--scenario", str(scenario), "--marks", "1", "--evaluations", "1"]
    assert presets_table.main([*arguments, "--rivals", str(machines), "grid-exploration"]) == 0
    head, _, row = capsys.readouterr().out.splitlines()
    names = [f"{machines}#1", f"{machines}#2", "grid-exploration"]
    for name, cell in zip(names, head.split("|")[8:], strict=False):
        assert cell.strip().startswith(f"beats {name} (-")
    preset, generations, simulations, _, mean, least, most, *beats = row.strip("| ").split(" | ")
    assert (preset, generations, simulations) == ("`modern`", "1", "200")
    assert float(mean) == float(least) == float(most) < 0
    assert len(beats) == 3


def test_what_cannot_be_a_rival_is_told(tmp_path, capsys):
    with pytest.raises(SystemExit):
        presets_table.main([str(tmp_path), "--rivals", "nobody"])
    assert "nobody" in capsys.readouterr().err
