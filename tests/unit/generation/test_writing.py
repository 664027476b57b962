import json

import pytest

from mmrs_core.contributions.targets import GeneratedFile
from mmrs_core.errors import InternalError, MmrsError, UnreadableError
from mmrs_core.generation.manifest import recorded
from mmrs_core.generation.writing import write


def output(*files: GeneratedFile) -> tuple[GeneratedFile, ...]:
    entries = [
        {"path": r.path, "sha256": r.sha256, "once": r.once} for r in (recorded(file) for file in files)
    ]
    manifest = json.dumps({"format": "mmrs-manifest-1", "files": entries})
    return (*files, GeneratedFile("t.manifest.json", manifest.encode()))


def test_files_are_written_with_their_folders(tmp_path):
    written = write(output(GeneratedFile("a/b.py", b"1")), tmp_path / "new")
    assert (tmp_path / "new/a/b.py").read_bytes() == b"1"
    assert written == (tmp_path / "new/a/b.py", tmp_path / "new/t.manifest.json")


def test_writing_twice_is_writing_once(tmp_path):
    files = output(GeneratedFile("a.py", b"1"))
    write(files, tmp_path)
    write(files, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.py", "t.manifest.json"]


def test_a_file_of_its_own_is_overwritten(tmp_path):
    write(output(GeneratedFile("a.py", b"1")), tmp_path)
    write(output(GeneratedFile("a.py", b"2")), tmp_path)
    assert (tmp_path / "a.py").read_bytes() == b"2"


def test_a_file_changed_by_hand_stops_everything(tmp_path):
    write(output(GeneratedFile("a.py", b"1"), GeneratedFile("b.py", b"1")), tmp_path)
    (tmp_path / "b.py").write_bytes(b"mine")
    with pytest.raises(MmrsError, match=r"b\.py: was changed by hand"):
        write(output(GeneratedFile("a.py", b"2"), GeneratedFile("b.py", b"2")), tmp_path)
    assert (tmp_path / "a.py").read_bytes() == b"1"


def test_a_file_that_nobody_generated_stops_everything(tmp_path):
    (tmp_path / "a.py").write_bytes(b"mine")
    with pytest.raises(MmrsError, match=r"a\.py: was not generated"):
        write(output(GeneratedFile("a.py", b"1")), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["a.py"]


def test_force_overwrites_strangers(tmp_path):
    (tmp_path / "a.py").write_bytes(b"mine")
    write(output(GeneratedFile("a.py", b"1")), tmp_path, force=True)
    assert (tmp_path / "a.py").read_bytes() == b"1"


def test_a_file_that_is_written_once_is_never_overwritten(tmp_path):
    write(output(GeneratedFile("mine.py", b"1", once=True)), tmp_path)
    (tmp_path / "mine.py").write_bytes(b"edited")
    write(output(GeneratedFile("mine.py", b"2", once=True)), tmp_path, force=True)
    assert (tmp_path / "mine.py").read_bytes() == b"edited"


def test_files_that_are_no_longer_generated_go(tmp_path):
    write(output(GeneratedFile("a.py", b"1"), GeneratedFile("b.py", b"1")), tmp_path)
    write(output(GeneratedFile("a.py", b"1")), tmp_path)
    assert not (tmp_path / "b.py").exists()


def test_files_that_are_no_longer_generated_stay_if_somebody_changed_them(tmp_path):
    write(output(GeneratedFile("a.py", b"1"), GeneratedFile("b.py", b"1")), tmp_path)
    (tmp_path / "b.py").write_bytes(b"mine")
    write(output(GeneratedFile("a.py", b"1")), tmp_path)
    assert (tmp_path / "b.py").read_bytes() == b"mine"


def test_a_forged_manifest_removes_nothing_outside(tmp_path):
    outside = tmp_path / "keep.txt"
    outside.write_bytes(b"1")
    folder = tmp_path / "out"
    write(output(GeneratedFile("a.py", b"1")), folder)
    forged = output(GeneratedFile("../keep.txt", b"1"))[-1]
    (folder / forged.path).write_bytes(forged.content)
    with pytest.raises(InternalError, match="leads out"):
        write(output(GeneratedFile("a.py", b"1")), folder)
    assert outside.exists()


def test_a_link_that_leads_out_is_not_followed(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "a").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InternalError, match="leads out"):
        write(output(GeneratedFile("a/b.py", b"1")), folder)
    assert not list((tmp_path / "elsewhere").iterdir())


def test_a_manifest_that_is_none_is_refused(tmp_path):
    (tmp_path / "t.manifest.json").write_text("hello", "utf-8")
    with pytest.raises(UnreadableError, match="is not a manifest"):
        write(output(GeneratedFile("a.py", b"1")), tmp_path)
    assert not (tmp_path / "a.py").exists()
