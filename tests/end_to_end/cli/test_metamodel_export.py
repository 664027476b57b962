"""An export of the languages replaces what an export wrote, and nothing else."""

import json
from hashlib import sha256

import pytest

from mmrs_core.resources import shipped


@pytest.fixture
def exported(mmrs, tmp_path):
    """Return a folder with the languages in it."""
    folder = tmp_path / "languages"
    assert mmrs("metamodel", "export", folder)[0] == 0
    return folder


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_exporting_again_writes_what_is_missing_and_changes_nothing_else(mmrs, exported):
    before = contents(exported)
    (exported / "mission.ecore").unlink()
    assert mmrs("metamodel", "export", exported)[0] == 0
    assert contents(exported) == before


def test_files_that_were_edited_are_listed_and_replaced_only_when_forced(mmrs, exported):
    whole = contents(exported)
    for name in ("mission.ecore", ".project"):
        (exported / name).write_text("mine")
    (exported / "robot.ecore").unlink()
    before = contents(exported)
    code, _, err = mmrs("metamodel", "export", exported)
    assert code == 1
    assert str(exported / "mission.ecore") in err
    assert str(exported / ".project") in err
    assert "context.ecore" not in err
    assert "--force" in err
    assert contents(exported) == before
    assert mmrs("metamodel", "export", exported, "--force")[0] == 0
    assert contents(exported) == whole


def test_a_project_or_a_broken_link_that_was_there_before_is_not_replaced(mmrs, tmp_path):
    (tmp_path / ".project").write_text("<projectDescription/>")
    assert mmrs("metamodel", "export", tmp_path)[0] == 1
    assert [path.name for path in tmp_path.iterdir()] == [".project"]
    (tmp_path / ".project").unlink()
    (tmp_path / ".project").symlink_to("nowhere")
    assert mmrs("metamodel", "export", tmp_path)[0] == 1
    assert not (tmp_path / "nowhere").exists()


def test_what_an_older_export_wrote_is_replaced(mmrs, exported):
    file, record = exported / "mission.ecore", exported / ".mmrs-export.json"
    before = file.read_bytes()
    file.write_bytes(b"of another version")
    hashes = json.loads(record.read_text())
    hashes["mission.ecore"] = sha256(b"of another version").hexdigest()
    record.write_text(json.dumps(hashes))
    assert mmrs("metamodel", "export", exported)[0] == 0
    assert file.read_bytes() == before


@pytest.mark.parametrize("words", ["", "[]", "{", '{"mission.ecore": 3}'])
def test_a_record_that_is_broken_vouches_for_nothing(mmrs, exported, words):
    (exported / ".mmrs-export.json").write_text(words)
    (exported / "mission.ecore").write_text("mine")
    assert mmrs("metamodel", "export", exported)[0] == 1


def test_an_installed_metamodel_is_not_replaced_even_when_forced(mmrs, tmp_path):
    source = shipped("metamodels") / "mission.ecore"
    before = source.read_bytes()
    (tmp_path / "mission.ecore").symlink_to(source)
    code, _, err = mmrs("metamodel", "export", tmp_path, "--force")
    assert code == 1
    assert "installed from there" in err
    assert source.read_bytes() == before
