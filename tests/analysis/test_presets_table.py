"""The table of the presets: restartable, and judged by simulations that no evolution has seen."""

from geswarm.analysis import presets_table


def test_the_table_is_made_and_made_again_without_evolving(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(presets_table, "MARKS", (1, 2, 3))
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: paper\nduration: 20\n")
    arguments = [str(tmp_path / "runs"), "--runs", "2", "--generations", "2"]
    arguments += ["--scenario", str(scenario)]
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
