"""A context is never overlooked without a word."""

import os
import shutil
from pathlib import Path

import pytest

from mmrs_core.resources import shipped

NOTE = "no context: nothing is known of obstacles and forbidden areas"


@pytest.fixture
def pool(tmp_path):
    """Return a copy of the smallest example."""
    return shutil.copytree(shipped("examples") / "pool", tmp_path / "pool")


@pytest.mark.parametrize("command", ["validate", "plan", "preview"])
def test_a_mission_without_a_context_is_noted(mmrs, pool, command):
    (pool / "context.xmi").unlink()
    _, _, err = mmrs(command, pool)
    assert err.count(NOTE) == 1


@pytest.mark.parametrize("command", ["check", "simulate"])
def test_a_behaviour_without_a_context_is_noted(mmrs, project, command):
    (project / "context.xmi").unlink()
    _, _, err = mmrs(command, project)
    assert err.count(NOTE) == 1


@pytest.mark.parametrize("command", ["validate", "plan", "preview"])
def test_a_context_that_is_there_is_not_missed(mmrs, pool, command):
    assert NOTE not in mmrs(command, pool)[2]


def other_name(file):
    file.rename(file.with_name("Context.xmi"))


def broken_link(file):
    file.unlink()
    file.symlink_to("nowhere.xmi")


def folder(file):
    file.unlink()
    file.mkdir()


def pipe(file):
    file.unlink()
    os.mkfifo(file)


SPOILT = pytest.mark.parametrize("spoil", [other_name, broken_link, folder, pipe])


@SPOILT
@pytest.mark.parametrize("command", ["validate", "plan", "check"])
def test_a_context_that_cannot_be_read_is_an_error(mmrs, pool, project, spoil, command):
    folder = project if command == "check" else pool
    spoil(folder / "context.xmi")
    code, _, err = mmrs(command, folder)
    assert code == 3
    assert "ontext.xmi" in err


def test_a_context_that_may_not_be_read_is_an_error(mmrs, pool, monkeypatch):
    read = Path.read_bytes

    def refuse(path):
        if path.name == "context.xmi":
            raise PermissionError(13, "Permission denied", str(path))
        return read(path)

    monkeypatch.setattr(Path, "read_bytes", refuse)
    code, _, err = mmrs("plan", pool)
    assert code == 3
    assert "context.xmi: cannot be read: permission denied" in err


def test_a_context_file_that_holds_none_is_an_error_for_a_behaviour(mmrs, project):
    shutil.copy(next((project / "robots").iterdir()), project / "context.xmi")
    code, _, err = mmrs("check", project)
    assert code == 1
    assert "expected one context" in err


@pytest.mark.parametrize("name", ["._quad.xmi", ".b.xmi"])
def test_hidden_files_are_no_types_of_robot(mmrs, pool, project, name):
    for folder in (pool, project):
        (folder / "robots" / name).write_bytes(b"\x00\x05\x16\x07")
    assert mmrs("validate", pool)[0] == 0
    assert mmrs("check", project)[0] == 0
    assert mmrs("check", project, "--robots", project / "robots")[0] == 0
