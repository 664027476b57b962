"""Several files are replaced together, or nothing is: whichever step fails, all is as it was."""

import errno
import os
import signal
from pathlib import Path

import pytest

from mmrs_core.cli import run
from mmrs_core.languages.writing import make_folder, replace_files


def all_in(folder):
    """Return everything below a folder: content by file, None by folder."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
        for path in sorted(folder.rglob("*"))
    }


@pytest.fixture
def before(tmp_path):
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "old").write_bytes(b"old")
    return all_in(tmp_path)


@pytest.fixture
def texts(tmp_path):
    """Return texts for an old file, one in a folder of two new ones, and one beside it."""
    new = tmp_path / "new" / "deep"
    return {tmp_path / "kept" / "old": b"younger", new / "a": b"a", new / "b": b"b"}


class Failing:
    """Does what a function does, but for one call, counted from 1."""

    def __init__(self, function, number):
        self.function, self.number, self.calls = function, number, 0

    def __call__(self, *given, **more):
        self.calls += 1
        if self.calls == self.number:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return self.function(*given, **more)

    def __get__(self, instance, owner):
        return self if instance is None else lambda *given, **more: self(instance, *given, **more)


def test_files_and_their_folders_are_made(tmp_path, texts, before):
    replace_files(texts)
    assert {path: path.read_bytes() for path in texts} == texts
    assert sorted(all_in(tmp_path)) == ["kept", "kept/old", "new", "new/deep", "new/deep/a", "new/deep/b"]


STEPS = {(Path, "mkdir"): 2, (os, "fdopen"): 3, (os, "fsync"): 3, (Path, "replace"): 3}
"""What is done to make two folders and three files, and how often."""


@pytest.mark.parametrize(
    ("module", "step", "number"),
    [(*step, number) for step, count in STEPS.items() for number in range(1, count + 1)],
)
def test_a_step_that_fails_leaves_all_as_it_was(tmp_path, texts, before, monkeypatch, module, step, number):
    with monkeypatch.context() as patched:
        patched.setattr(module, step, Failing(getattr(module, step), number))
        with pytest.raises(OSError, match="No space"):
            replace_files(texts)
    assert all_in(tmp_path) == before


def test_a_file_that_cannot_be_read_is_not_replaced(tmp_path, texts, before):
    (tmp_path / "folder").mkdir()
    with pytest.raises(IsADirectoryError):
        replace_files({**texts, tmp_path / "folder": b"no file"})
    assert all_in(tmp_path) == {**before, "folder": None}


def test_an_interrupt_leaves_all_as_it_was(tmp_path, texts, before, monkeypatch):
    replace = Path.replace

    def interrupted(part, target):
        if target.name == "b":
            raise KeyboardInterrupt
        return replace(part, target)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", interrupted)
        with pytest.raises(KeyboardInterrupt):
            replace_files(texts)
    assert all_in(tmp_path) == before


def test_a_folder_that_somebody_else_has_filled_meanwhile_stays(tmp_path, texts, monkeypatch):
    replace = Path.replace

    def filled(part, target):
        if target.name == "b":
            (target.parent / "another's").write_bytes(b"keep me")
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return replace(part, target)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", filled)
        with pytest.raises(OSError, match="No space"):
            replace_files(texts)
    assert all_in(tmp_path / "new") == {"deep": None, "deep/another's": b"keep me"}


def test_what_cannot_be_put_back_is_named_and_all_else_is_put_back(tmp_path, texts, before, monkeypatch):
    replace = Path.replace

    def full(part, target):
        if target.name == "b" or (target.name == "old" and target.read_bytes() == b"younger"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return replace(part, target)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", full)
        with pytest.raises(OSError, match=r"No space .*; and not as before: .*/kept/old$"):
            replace_files(texts)
    assert all_in(tmp_path) == {**before, "kept/old": b"younger"}


@pytest.mark.skipif(os.name != "posix" or not os.geteuid(), reason="root may do everything")
def test_a_folder_that_may_not_be_written_to_leaves_all_as_it_was(tmp_path, texts, before):
    locked = tmp_path / "locked"
    locked.mkdir(mode=0o500)
    with pytest.raises(PermissionError):
        replace_files({**texts, locked / "in" / "it": b"no"})
    assert all_in(tmp_path) == {**before, "locked": None}


def killed_at(owner, name, monkeypatch, write, *given, after=0):
    """Call a function in a process that is killed when another is called once more than so often."""
    child = os.fork()
    if not child:
        function, calls = getattr(owner, name), iter(range(after))

        def counted(*arguments):
            if next(calls, None) is None:
                os.kill(os.getpid(), signal.SIGKILL)
            return function(*arguments)

        monkeypatch.setattr(owner, name, counted)
        write(*given)
        os._exit(0)
    assert os.waitpid(child, 0)[1] == signal.SIGKILL


@pytest.mark.parametrize(("owner", "name"), [(os, "fsync"), (Path, "replace"), (Path, "rename")])
def test_a_new_folder_is_whole_or_not_there(owner, name, tmp_path, monkeypatch):
    folder = tmp_path / "farm"
    killed_at(owner, name, monkeypatch, make_folder, folder, {folder / "a": b"a", folder / "in" / "b": b"b"})
    assert not folder.exists()


def test_no_file_is_replaced_before_all_are_on_the_disk(tmp_path, texts, before, monkeypatch):
    killed_at(Path, "replace", monkeypatch, replace_files, texts)
    assert {path.exists() and path.read_bytes() for path in texts} == {b"old", False}


@pytest.mark.parametrize("renamed", [1, 2])
def test_an_import_that_is_killed_between_files_leaves_a_valid_project_that_the_next_completes(
    renamed, tmp_path, monkeypatch
):
    farm, rover = str(tmp_path / "farm"), "--robot=R=Clearpath Husky A300@43.0637,11.6525"
    drawing = str(Path(__file__).parents[3] / "examples" / "drawings" / "farm.kml")
    (tmp_path / "gate.csv").write_text("lat,lon\n43.0636,11.652\n")
    kite = "--robot=K=Freefly Astro LR1@43.0635,11.652"
    assert run(["import", str(tmp_path / "gate.csv"), "-o", farm, kite]) == 0
    killed_at(Path, "replace", monkeypatch, run, ["import", drawing, "--into", farm, rover], after=renamed)
    assert (tmp_path / "farm" / "robots" / "clearpath-husky-a300.xmi").exists()
    assert ("barn" in (tmp_path / "farm" / "context.xmi").read_text()) is (renamed == 2)
    assert "lane" not in (tmp_path / "farm" / "mission.xmi").read_text()
    assert run(["validate", farm]) == 0
    assert run(["import", drawing, "--into", farm, rover]) == 0
    assert run(["validate", farm]) == 0
    assert "lane" in (tmp_path / "farm" / "mission.xmi").read_text()
