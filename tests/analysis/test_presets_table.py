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
    rows = [line.split("|")[1:3] for line in table.splitlines()[2:]]
    assert [(preset.strip(), mark.strip()) for preset, mark in rows] == [
        ("`paper`", "1"),
        ("`paper`", "2"),
        ("`modern`", "1"),
        ("`modern`", "2"),
    ]
    assert "of 2" in table
    assert presets_table.main(arguments) == 0
    assert capsys.readouterr().out == table
