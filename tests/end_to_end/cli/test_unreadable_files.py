"""A file that cannot be read at all is a fault like others, told together with those of the other files."""

import json
import shutil

import pytest

from mmrs_core.resources import shipped


@pytest.fixture
def field(tmp_path, monkeypatch):
    """Return a project in which one file is cut short and another says what it may not."""
    folder = shutil.copytree(shipped("examples") / "handwritten", tmp_path / "field")
    context = folder / "context.xmi"
    context.write_text(context.read_text().replace("<context:Context ", '<context:Context colour="red" '))
    robot = next((folder / "robots").glob("*.xmi"))
    robot.write_text(robot.read_text()[:300])
    (folder / "mission.xmi").write_text('<mission:Mission xmlns:mission="urn:mmrs:mission:1.0" name="m"/>')
    monkeypatch.chdir(tmp_path)
    return "field"


def test_it_is_told_with_code_place_and_hint_beside_the_faults_of_other_files(field, mmrs):
    code, out, err = mmrs("validate", field)
    assert code == 3
    assert out == "field: incompletely read (4 errors)\n"
    assert "context.xmi:" in err
    assert "colour: no feature of Context" in err
    assert "Mission 'm': team is missing" in err
    assert "error: not well-formed XML: unclosed token [FIL004]\n    expected: well-formed XML" in err
    code, _, err = mmrs("validate", field, "--fix", "--yes")
    assert code == 3
    assert "[FIL004]" in err


def test_it_stands_among_the_diagnostics_of_json_and_sarif(field, mmrs, tmp_path):
    code, out, _ = mmrs("validate", field, "--json", "--sarif", tmp_path / "log.sarif")
    assert code == 3
    assert "FIL004" in {each["code"] for each in json.loads(out)["diagnostics"]}
    results = json.loads((tmp_path / "log.sarif").read_text())["runs"][0]["results"]
    assert {"FIL004", "XMI004", "ECO001"} <= {each["ruleId"] for each in results}


@pytest.mark.parametrize(
    "line",
    [["plan", "field"], ["preview", "field"], ["check", "field/behaviour.xmi"]],
    ids=lambda line: line[0],
)
def test_no_command_continues_without_it(field, mmrs, line):
    code, out, err = mmrs(*line)
    assert (code, out) == (3, "")
    assert "[FIL004]" in err
    assert "[XMI004]" in err


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("mission.xmi", b"", "FIL004"),
        ("mission.xmi", b"<!DOCTYPE a><a/>", "FIL005"),
        ("mission.xmi", b"<a>" * 500, "FIL006"),
        ("mission.json", b'{"$type": }', "FIL007"),
        ("mission.json", b"[" * 5000, "FIL006"),
        ("mission.json", b"\xff\xfe\xff", "FIL007"),
        ("notes.txt", b"", "PRJ003"),
    ],
)
@pytest.mark.parametrize("given", ["file", "folder"])
def test_each_reason_has_its_code(tmp_path, mmrs, name, content, code, given):
    (tmp_path / name).write_bytes(content)
    place = tmp_path if given == "folder" or code == "PRJ003" else tmp_path / name
    ended, out, _ = mmrs("validate", place, "--json")
    assert ended == 3
    assert [each["code"] for each in json.loads(out)["diagnostics"]] == [code]
