"""``mmrs validate --fix`` changes all that it showed, or nothing."""

import shutil
from pathlib import Path

import pytest

from mmrs_core.analysis.fixes.repair import Diagnosis, FileChange, Repair
from mmrs_core.cli import run
from mmrs_core.cli.fixing import write
from mmrs_core.errors import UnreadableError

DAM = Path(__file__).parents[3] / "examples" / "mixed-team"


@pytest.fixture
def project(tmp_path, monkeypatch):
    """Go to a folder with a project whose mission is in JSON."""
    shutil.copytree(DAM, tmp_path / "dam")
    monkeypatch.chdir(tmp_path)
    assert run(["convert", "dam/mission.xmi", "dam/mission.json"]) == 0
    (tmp_path / "dam" / "mission.xmi").unlink()
    return tmp_path / "dam"


def repair_of(*files):
    changes = tuple(FileChange(file.name, file, file.read_bytes(), b"new") for file in files)
    return Repair(changes, {}, (), (), Diagnosis(True, ()))


def test_a_json_mission_is_mended_and_nothing_else_of_it_changes(project, capsys):
    file = project / "mission.json"
    sound = file.read_text(encoding="utf-8")
    spoilt = sound.replace("photoDistance", "photoDistanse", 1).replace('"reserve": 0.3', '"reserve": 30')
    file.write_text(spoilt, encoding="utf-8")
    assert run(["validate", "dam", "--fix", "--yes"]) == 0
    assert file.read_text(encoding="utf-8") == sound
    assert '+      "photoDistance": 20.0,' in capsys.readouterr().out


def test_a_fault_whose_fix_sees_no_single_answer_is_told_with_its_place(project, capsys):
    file = project / "mission.json"
    text = file.read_text(encoding="utf-8").replace('"type": "Crawler"', '"type": "qqqqqq"')
    file.write_text(text, encoding="utf-8")
    assert run(["validate", "dam", "--fix", "--yes"]) == 1
    told = capsys.readouterr().err
    assert "dam/mission.json:11: not fixed: several fixes are possible [MML004]" in told


def test_a_file_that_somebody_changed_meanwhile_is_left_alone(tmp_path):
    one, other = tmp_path / "a.xmi", tmp_path / "b.xmi"
    one.write_bytes(b"a")
    other.write_bytes(b"b")
    repair = repair_of(one, other)
    other.write_bytes(b"theirs")
    with pytest.raises(UnreadableError, match=r"b\.xmi: was changed meanwhile"):
        write(repair)
    assert (one.read_bytes(), other.read_bytes()) == (b"a", b"theirs")


def test_all_files_are_as_they_were_if_one_cannot_be_written(tmp_path, monkeypatch):
    one, other = tmp_path / "a.xmi", tmp_path / "b.xmi"
    one.write_bytes(b"a")
    other.write_bytes(b"b")
    repair = repair_of(one, other)
    from mmrs_core.languages import writing

    part_of = writing.part_of

    def full(file, text):
        if file == other:
            raise OSError(28, "no space left on device", str(file))
        return part_of(file, text)

    monkeypatch.setattr(writing, "part_of", full)
    with pytest.raises(OSError, match="no space left"):
        write(repair)
    assert (one.read_bytes(), other.read_bytes()) == (b"a", b"b")
