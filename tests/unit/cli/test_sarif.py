"""SARIF logs say what the diagnostics say, in the places where editors look for it."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from mmrs_core.analysis.fixes.repair import Proposal
from mmrs_core.cli import run
from mmrs_core.cli.catalogue import Entry
from mmrs_core.cli.sarif import sarif_of
from mmrs_core.contributions.fixes import Edit
from mmrs_core.diagnostics import Diagnostic, Place, Severity

EXAMPLES = Path(__file__).parents[3] / "examples"
ENTRY = Entry("MML001", Severity.ERROR, "broken: it is known", "it is known", "name it")
FAULT = Diagnostic("MML001", Severity.ERROR, "it is not", Place("m.xmi", 2, "/tasks[1]"), "name b", "a")
TEXT = {"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}}
ARTIFACT = {
    "type": "object",
    "required": ["uri"],
    "additionalProperties": False,
    "properties": {"uri": {"type": "string", "pattern": r"^[^ \\\\]+$"}, "uriBaseId": {"type": "string"}},
}
REGION = {
    "type": "object",
    "required": ["startLine"],
    "additionalProperties": False,
    "properties": {
        name: {"type": "integer", "minimum": 1}
        for name in ("startLine", "startColumn", "endLine", "endColumn")
    },
}
LOCATION = {
    "type": "object",
    "additionalProperties": False,
    "properties": {
        "physicalLocation": {
            "type": "object",
            "required": ["artifactLocation"],
            "additionalProperties": False,
            "properties": {"artifactLocation": ARTIFACT, "region": REGION},
        },
        "logicalLocations": {
            "type": "array",
            "items": {
                "type": "object",
                "additionalProperties": False,
                "properties": {"fullyQualifiedName": {"type": "string"}, "kind": {"type": "string"}},
            },
        },
    },
}
REPLACEMENT = {
    "type": "object",
    "required": ["deletedRegion"],
    "additionalProperties": False,
    "properties": {
        "deletedRegion": REGION,
        "insertedContent": {"type": "object", "properties": {"text": {"type": "string"}}},
    },
}
FIX = {
    "type": "object",
    "required": ["artifactChanges"],
    "additionalProperties": False,
    "properties": {
        "description": TEXT,
        "artifactChanges": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "required": ["artifactLocation", "replacements"],
                "properties": {
                    "artifactLocation": ARTIFACT,
                    "replacements": {"type": "array", "minItems": 1, "items": REPLACEMENT},
                },
            },
        },
    },
}
RESULT = {
    "type": "object",
    "required": ["message"],
    "additionalProperties": False,
    "properties": {
        "ruleId": {"type": "string"},
        "ruleIndex": {"type": "integer", "minimum": 0},
        "level": {"enum": ["none", "note", "warning", "error"]},
        "message": TEXT,
        "locations": {"type": "array", "items": LOCATION},
        "fixes": {"type": "array", "items": FIX},
    },
}
RULE = {
    "type": "object",
    "required": ["id"],
    "additionalProperties": False,
    "properties": {
        "id": {"type": "string"},
        "shortDescription": TEXT,
        "help": TEXT,
        "defaultConfiguration": {"type": "object", "properties": {"level": RESULT["properties"]["level"]}},
    },
}
DRIVER = {
    "type": "object",
    "required": ["name"],
    "properties": {
        "name": {"type": "string"},
        "rules": {"type": "array", "uniqueItems": True, "items": RULE},
    },
}
SARIF = {
    "type": "object",
    "required": ["version", "runs"],
    "additionalProperties": False,
    "properties": {
        "$schema": {"type": "string"},
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["tool"],
                "additionalProperties": False,
                "properties": {
                    "tool": {"type": "object", "required": ["driver"], "properties": {"driver": DRIVER}},
                    "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                    "originalUriBaseIds": {"type": "object", "additionalProperties": ARTIFACT},
                    "results": {"type": "array", "items": RESULT},
                },
            },
        },
    },
}
"""What SARIF 2.1.0 demands of the part of it that we write, sections 3.13 to 3.57."""


def only_run(log):
    jsonschema.validate(log, SARIF)
    (run_,) = log["runs"]
    return run_


@pytest.fixture
def spoilt(tmp_path, monkeypatch):
    """Go to a folder with a project that has a fault with a quick fix."""
    for file in (EXAMPLES / "mixed-team").rglob("*.xmi"):
        copy = tmp_path / "the dam" / file.relative_to(EXAMPLES / "mixed-team")
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(file.read_text(encoding="utf-8").replace('reserve="0.3"', 'reserve="30"'), "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path / "the dam" / "mission.xmi"


def test_a_fault_is_told_with_place_path_expectation_and_hint():
    (result,) = only_run(sarif_of([FAULT], {"MML001": ENTRY}))["results"]
    (location,) = result["locations"]
    assert result["message"]["text"] == "it is not\nexpected: a\nhint: name b"
    assert location["physicalLocation"]["artifactLocation"]["uri"] == "m.xmi"
    assert location["physicalLocation"]["region"] == {"startLine": 2}
    assert location["logicalLocations"] == [{"fullyQualifiedName": "/tasks[1]", "kind": "element"}]


def test_results_find_their_rules_by_index():
    other = Diagnostic("ZZZ001", Severity.NOTE, "odd")
    found = only_run(sarif_of([other, FAULT, other], {"MML001": ENTRY}))
    rules = found["tool"]["driver"]["rules"]
    assert [rules[each["ruleIndex"]]["id"] for each in found["results"]] == ["ZZZ001", "MML001", "ZZZ001"]
    assert rules[1]["help"]["text"] == "expected: it is known\nhint: name it"


def test_a_fix_tells_lines_and_columns_of_characters(tmp_path):
    file = tmp_path / "m.xmi"
    file.write_text("<a>\n é x", encoding="utf-8")
    proposal = Proposal(FAULT, "exchange it", file, (Edit(8, 9, "y"),))
    (result,) = only_run(sarif_of([FAULT], {}, [proposal]))["results"]
    (change,) = result["fixes"][0]["artifactChanges"]
    (replacement,) = change["replacements"]
    assert replacement["deletedRegion"] == {"startLine": 2, "startColumn": 4, "endLine": 2, "endColumn": 5}
    assert replacement["insertedContent"] == {"text": "y"}


def test_validate_writes_what_the_schema_takes(spoilt):
    assert run(["validate", "the dam", "--sarif", "out.sarif"]) == 1
    found = only_run(json.loads(Path("out.sarif").read_text(encoding="utf-8")))
    (reserve,) = [each for each in found["results"] if each["ruleId"] == "MML005"]
    assert reserve["locations"][0]["physicalLocation"]["artifactLocation"] == {
        "uri": "the%20dam/mission.xmi",
        "uriBaseId": "PROJECTROOT",
    }
    assert reserve["fixes"][0]["artifactChanges"][0]["replacements"][0]["insertedContent"]["text"] == "0.3"


def test_check_writes_what_the_schema_takes(tmp_path, capsys):
    assert run(["check", str(EXAMPLES / "handwritten"), "--sarif", "-"]) == 0
    only_run(json.loads(capsys.readouterr().out))


def test_check_writes_the_faults_of_a_model_that_it_refuses(tmp_path):
    text = (EXAMPLES / "handwritten" / "behaviour.xmi").read_text(encoding="utf-8")
    (tmp_path / "behaviour.xmi").write_text(text.replace('name="down"', 'name="ready"'), encoding="utf-8")
    log = tmp_path / "out.sarif"
    assert run(["check", str(tmp_path / "behaviour.xmi"), "--sarif", str(log)]) == 1
    found = only_run(json.loads(log.read_text(encoding="utf-8")))
    assert "BL010" in {each["ruleId"] for each in found["results"]}


def test_two_things_are_not_written_to_standard_output():
    assert run(["validate", str(EXAMPLES / "mixed-team"), "--sarif", "-", "--json"]) == 2


def test_a_fix_is_only_shown_where_nobody_can_be_asked(spoilt, capsys):
    before = spoilt.read_bytes()
    assert run(["validate", "the dam", "--fix"]) == 1
    captured = capsys.readouterr()
    assert (
        '+    geoidSeparation="47.5" positionError="0.3" minimumSeparation="3.0" reserve="0.3">'
        in captured.out
    )
    assert "there is no terminal to ask on" in captured.err
    assert spoilt.read_bytes() == before


def test_a_dry_run_changes_nothing(spoilt):
    before = spoilt.read_bytes()
    assert run(["validate", "the dam", "--fix", "--yes", "--dry-run"]) == 1
    assert spoilt.read_bytes() == before


def test_a_fix_changes_the_file_when_told_to(spoilt, capsys):
    assert run(["validate", "the dam", "--fix", "--yes"]) == 0
    assert spoilt.read_bytes() == (EXAMPLES / "mixed-team" / "mission.xmi").read_bytes()
    assert "1 fault mended" in capsys.readouterr().out


def test_json_tells_what_was_mended_and_how(spoilt, capsys):
    assert run(["validate", "the dam", "--fix", "--yes", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["valid"]
    assert told["fix"]["changed"]
    assert [each["code"] for each in told["fix"]["mended"]] == ["MML005"]
    assert told["fix"]["diff"].startswith("--- a/the dam/mission.xmi\n+++ b/the dam/mission.xmi\n@@")


def test_faults_with_a_fix_are_announced(spoilt, capsys):
    assert run(["validate", "the dam"]) == 1
    assert "mmrs validate 'the dam' --fix: mends 1 fault" in capsys.readouterr().err
