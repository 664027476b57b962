"""What `mmrs import` refuses before it reads anything."""

import pytest

from mmrs_core.cli import run


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ([], 2, "where to? -o FOLDER makes a project, --into PROJECT adds to one"),
        (["-o", "new", "--into", "old"], 2, "give one of them"),
        (["-o", "."], 2, ".: exists and is not empty; --into . adds to a project"),
        (["-o", "new", "--as", "x"], 2, "--as 'x': expected PATTERN=TYPE"),
        (["-o", "new", "--mapping", "no.toml"], 3, "no.toml: no such file"),
        (["-o", "new", "--robot", "Kite=Camera"], 2, "robot 'Kite': no robot type 'Camera'"),
        (["-o", "new"], 3, "drawing.xyz: of no format that is known"),
    ],
)
def test_what_cannot_be_meant_is_refused_and_nothing_written(
    arguments, code, words, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drawing.xyz").write_text("?")
    assert run(["import", "drawing.xyz", *arguments]) == code
    assert words in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["drawing.xyz"]
