"""Whatever is given to read: a clear error, the promised exit code, no traceback, nothing written."""

import pytest

MISSION = (
    '<mission:Mission xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:mission="urn:mmrs:mission:1.0"'
)
UNREADABLE = {
    "empty": b"",
    "no xml": b"these are words",
    "binary": bytes(range(256)) * 40,
    "half": f'{MISSION} name="a"><team>'.encode(),
    "doctype": b'<!DOCTYPE m [<!ENTITY x SYSTEM "file:///etc/passwd">]><m>&x;</m>',
    "entities": b'<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><m>&b;</m>',
    "wrong bytes": b'<?xml version="1.0" encoding="UTF-8"?><m name="\xff\xfe"/>',
    "deep": b"<a>" * 5000 + b"</a>" * 5000,
}
INVALID = {
    "no team": f'{MISSION} name="a"/>',
    "another root": '<context:Context xmlns:context="urn:mmrs:context:1.0"/>',
    "unknown feature": f'{MISSION} nmae="a"><team/></mission:Mission>',
    "wrong type": f'{MISSION} reserve="much"><team/></mission:Mission>',
    "unknown class": f'{MISSION}><tasks xsi:type="kites:Fly" xmlns:kites="urn:kites:9.9"/></mission:Mission>',
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "field").mkdir()
    return tmp_path / "field"


@pytest.mark.parametrize("command", ["validate", "plan", "preview"])
@pytest.mark.parametrize("content", UNREADABLE.values(), ids=UNREADABLE)
def test_what_is_no_model_ends_with_3(mmrs, folder, command, content):
    (folder / "mission.xmi").write_bytes(content)
    code, out, err = mmrs(command, folder)
    told = f"{folder}: incompletely read (1 error)\n" if command == "validate" else ""
    assert (code, out) == (3, told)
    assert "mission.xmi" in err
    assert "[FIL00" in err
    assert "Traceback" not in err
    assert [path.name for path in folder.iterdir()] == ["mission.xmi"]


@pytest.mark.parametrize("content", INVALID.values(), ids=INVALID)
def test_a_mission_that_is_wrong_ends_with_1_and_a_place(mmrs, folder, content):
    (folder / "mission.xmi").write_text(content, encoding="utf-8")
    code, out, err = mmrs("plan", folder)
    assert (code, out) == (1, "")
    assert "mission.xmi:1: error: " in err
    assert [path.name for path in folder.iterdir()] == ["mission.xmi"]


@pytest.mark.parametrize("command", ["check", "simulate", "show"])
@pytest.mark.parametrize("content", UNREADABLE.values(), ids=UNREADABLE)
def test_what_is_no_behaviour_ends_with_3(mmrs, folder, command, content):
    (folder / "behaviour.xmi").write_bytes(content)
    code, out, err = mmrs(command, folder / "behaviour.xmi")
    assert (code, out) == (3, "")
    assert "behaviour.xmi" in err


@pytest.mark.parametrize("command", ["validate", "plan", "check", "simulate", "preview", "show"])
def test_a_missing_file_ends_with_3_and_is_named(mmrs, folder, command):
    code, out, err = mmrs(command, folder / "lost.xmi")
    told = f"{folder / 'lost.xmi'}: incompletely read (1 error)\n" if command == "validate" else ""
    assert (code, out) == (3, told)
    assert "lost.xmi" in err


@pytest.mark.parametrize("megabytes", [2, pytest.param(50, marks=pytest.mark.thorough)])
def test_megabytes_of_junk_end_soon(mmrs, folder, megabytes):
    (folder / "mission.xmi").write_bytes(b"<m>" + b"<a b='c'/>" * (megabytes * 100_000))
    code, _, err = mmrs("validate", folder)
    assert code == 3
    assert "mission.xmi" in err


def test_a_log_of_junk_ends_with_its_lines(mmrs, project):
    (project / "bad.jsonl").write_text('{"robot": 1}\nnot json\n', encoding="utf-8")
    code, _, err = mmrs("replay", project, project / "bad.jsonl")
    assert code == 1
    assert "bad.jsonl:1: error: " in err
    assert "bad.jsonl:2: error: " in err


def test_names_that_steer_a_terminal_are_shown_by_code(mmrs, folder):
    (folder / "mission.xmi").write_text(f'{MISSION} name="&#155;31m&#8238;"><team/></mission:Mission>')
    _, out, err = mmrs("show", folder / "mission.xmi")
    assert "\x9b" not in out + err
    assert "\u202e" not in out + err
    assert "\\x9b31m\\u202e" in out


def test_a_folder_that_cannot_be_written_ends_with_3(mmrs, project):
    (project / "taken").write_text("a file, not a folder")
    code, _, err = mmrs("simulate", project, "-o", project / "taken")
    assert code == 3
    assert "taken" in err
