"""The command that makes projects of models of other dialects."""

import json
from pathlib import Path

import pytest

FIXTURES = Path(__file__).parents[1] / "fixtures"
FLYAQ = FIXTURES / "flyaq"
ORCHARD = (FLYAQ / "orchard-mission.json", FLYAQ / "orchard-context.json", FLYAQ / "Heron.xmi")


@pytest.fixture
def project(tmp_path):
    return tmp_path / "project"


def test_a_migrated_mission_is_a_project_that_can_be_planned(mmrs, project, tmp_path):
    code, out, err = mmrs("migrate", *ORCHARD, "-o", project)
    assert (code, err) == (0, "")
    assert out.endswith(f"{project}: valid\n")
    assert mmrs("validate", project)[0] == 0
    assert mmrs("plan", project, "-o", tmp_path / "behaviour.xmi")[0] == 0


def test_a_migrated_behaviour_can_be_simulated(mmrs, project):
    assert mmrs("migrate", FLYAQ / "round.json", FLYAQ / "Heron.xmi", "-o", project)[0] == 0
    code, out, _ = mmrs("simulate", project)
    assert code == 0
    assert out.startswith("success")


def test_types_that_a_project_has_already_are_known_to_what_is_migrated_later(mmrs, project):
    mmrs("migrate", FLYAQ / "Heron.xmi", "-o", project)
    code, out, _ = mmrs("migrate", FLYAQ / "orchard-mission.json", "-o", project)
    assert code == 0
    assert "no robot type" not in out


def test_a_mission_without_its_robot_types_is_not_valid(mmrs, project):
    code, out, err = mmrs("migrate", FLYAQ / "orchard-mission.json", "-o", project)
    assert code == 1
    assert "no robot type 'Heron' is known: migrate the file that describes it, too" in out
    assert out.endswith(f"{project}: not valid\n")
    assert "Heron" in err


def test_what_holds_nothing_to_migrate_is_named_and_nothing_is_written(mmrs, project):
    code, out, err = mmrs(
        "migrate", FLYAQ / "palette.json", FLYAQ / "workspace" / "drone.ecore", "-o", project
    )
    assert (code, err) == (0, "")
    assert "a palette of the 2015 editor: nothing to migrate" in out
    assert "a metamodel, http://www.flyaq.it/drone: nothing to migrate" in out
    assert out.endswith("nothing to migrate, nothing written\n")
    assert not project.exists()


def test_a_file_that_cannot_be_read_is_told_and_the_others_are_migrated(mmrs, project, tmp_path):
    broken = tmp_path / "broken.json"
    broken.write_text("{")
    code, out, err = mmrs("migrate", broken, FLYAQ / "Heron.xmi", "-o", project)
    assert code == 3
    assert f"mmrs: {broken}:1: not well-formed JSON" in err
    assert f"{broken}: not readable" in out
    assert (project / "robots" / "Heron.xmi").is_file()


def test_a_model_of_another_language_comes_to_nothing(mmrs, project, tmp_path):
    other = tmp_path / "other.xmi"
    other.write_text('<b:Book xmlns:b="http://example.org/books" title="x"/>')
    code, out, _ = mmrs("migrate", other, "-o", project)
    assert code == 1
    assert "the mapping has no rule for this class" in out


def test_what_a_project_says_already_is_only_replaced_by_force(mmrs, project):
    mmrs("migrate", FLYAQ / "Heron.xmi", "-o", project)
    assert mmrs("migrate", FLYAQ / "Heron.xmi", "-o", project)[0] == 0
    file = project / "robots" / "Heron.xmi"
    file.write_text(file.read_text().replace("1500.0", "900.0"))
    code, _, err = mmrs("migrate", FLYAQ / "Heron.xmi", "-o", project)
    assert code == 2
    assert "has other content" in err
    assert "900.0" in file.read_text()
    assert mmrs("migrate", FLYAQ / "Heron.xmi", "-o", project, "--force")[0] == 0
    assert "1500.0" in file.read_text()


def test_a_source_is_never_replaced(mmrs, tmp_path):
    source = tmp_path / "robots" / "Heron.xmi"
    source.parent.mkdir()
    source.write_bytes((FLYAQ / "Heron.xmi").read_bytes())
    code, _, err = mmrs("migrate", source, "-o", tmp_path, "--force")
    assert code != 0
    assert "Heron.xmi" in err
    assert source.read_bytes() == (FLYAQ / "Heron.xmi").read_bytes()


def test_the_whole_report_is_one_json_object(mmrs, project):
    code, out, _ = mmrs("migrate", *ORCHARD, FLYAQ / "palette.json", "-o", project, "--json")
    told = json.loads(out)
    assert code == 0
    assert told["valid"] is True
    assert [source["what"] for source in told["sources"]][
        -1
    ] == "a palette of the 2015 editor: nothing to migrate"
    assert {finding["category"] for finding in told["findings"]} == {
        "not carried over",
        "doubtful",
        "changed in meaning",
        "defaulted",
    }
    assert all(finding["place"]["line"] > 0 for finding in told["findings"])
    assert [Path(file).name for file in told["files"]] == ["Heron.xmi", "mission.xmi", "context.xmi"]


def test_the_text_tells_every_finding_with_its_line(mmrs, project):
    findings = json.loads(mmrs("migrate", *ORCHARD, "-o", project, "--json")[1])["findings"]
    text = mmrs("migrate", *ORCHARD, "-o", project)[1]
    assert findings
    for finding in findings:
        assert finding["reason"] in text
        assert finding["subject"] in text
        assert str(finding["place"]["line"]) in text


def test_a_dialect_of_ones_own_needs_a_mapping_only(mmrs, project):
    folder = FIXTURES / "dialects"
    models = [folder / name for name in ("voyage.json", "tug.xmi", "chart.xmi")]
    assert mmrs("migrate", *models, "--mapping", folder / "harbour.toml", "-o", project)[0] == 0
    assert mmrs("simulate", project)[0] == 0


def test_a_name_may_be_said_to_stand_for_a_robot_type(mmrs, project):
    files = (FLYAQ / "orchard-mission.json", FLYAQ / "drones.json")
    _, out, _ = mmrs("migrate", *files, "-o", project, "--type", "Heron=Wren")
    assert "the robot type 'Heron' is taken for 'Wren'" in out
    code, _, err = mmrs("migrate", *files, "-o", project, "--type", "Heron")
    assert code == 2
    assert "'Heron' is not written as OLD=NAME" in err


def test_a_name_that_occurs_nowhere_stands_for_no_robot_type(mmrs, project):
    code, _, err = mmrs("migrate", FLYAQ / "orchard-mission.json", "-o", project, "--type", "nix=Foo")
    assert code == 2
    assert "'nix': no robot type of this name occurs; these files name 'Heron'" in " ".join(err.split())
    assert not project.exists()


def test_a_behaviour_without_its_robot_type_says_what_it_needs(mmrs, project):
    code, out, _ = mmrs("migrate", FLYAQ / "round.json", "-o", project)
    assert code == 0
    assert f"{project}/behaviour.xmi: to simulate or generate it, the robot type 'Heron' is needed" in out
    assert out.endswith(f"{project}/behaviour.xmi: valid\n")
    assert mmrs("simulate", project)[0] != 0
    told = json.loads(mmrs("migrate", FLYAQ / "round.json", "-o", project, "--json")[1])
    assert [verdict["missing"] for verdict in told["verdicts"]] == [["Heron"]]
    _, out, _ = mmrs("migrate", FLYAQ / "round.json", FLYAQ / "Heron.xmi", "-o", project, "--force")
    assert "is needed" not in out
    assert "no mission" not in out
    assert mmrs("simulate", project)[0] == 0


def test_what_a_folder_holds_already_is_judged_with_what_is_migrated_into_it(mmrs, project):
    mmrs("migrate", FLYAQ / "orchard-mission.json", "-o", project)
    assert mmrs("validate", project)[0] == 1
    code, out, err = mmrs("migrate", FLYAQ / "orchard-context.json", "-o", project)
    assert code == 1
    assert out.endswith(f"{project}: not valid\n")
    assert "unknown robot type 'Heron'" in err


def test_a_folder_that_cannot_be_judged_is_not_called_valid(mmrs, project):
    mmrs("migrate", *ORCHARD, "-o", project)
    (project / "context.json").write_text("{}")
    code, out, err = mmrs("migrate", FLYAQ / "orchard-mission.json", "-o", project)
    assert code == mmrs("validate", project)[0] == 3
    assert out.endswith(f"{project}: incompletely read\n")
    assert "has both context.xmi and context.json" in err


def test_robot_types_alone_are_valid_but_no_mission_yet(mmrs, project):
    code, out, _ = mmrs("migrate", FLYAQ / "Heron.xmi", "-o", project)
    assert code == 0
    assert out.endswith(f"{project}: valid, with no mission beside it yet\n")


def test_a_mapping_that_is_none_is_refused_before_anything_is_written(mmrs, project):
    code, _, err = mmrs("migrate", FLYAQ / "Heron.xmi", "--mapping", FLYAQ / "palette.json", "-o", project)
    assert code == 3
    assert "palette.json:1: not TOML" in err
    assert not project.exists()
