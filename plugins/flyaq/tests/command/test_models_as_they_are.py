"""Models of FLYAQ 2015, which every command takes as they are."""

import json
import shutil
from pathlib import Path

import pytest
from mmrs_flyaq.importing import importer_of

FLYAQ = Path(__file__).parents[1] / "fixtures" / "flyaq"
DIALECTS = FLYAQ.parent / "dialects"
HERON = FLYAQ / "Heron.xmi"
QUIET = "--quiet-migration"
FILES = {
    "mission.json": "orchard-mission.json",
    "context.json": "orchard-context.json",
    "behaviour.xmi": "round.xmi",
    "robots/Heron.xmi": "Heron.xmi",
}


@pytest.fixture
def orchard(tmp_path):
    """Return a folder of theirs only, with the names that ours have."""
    folder = tmp_path / "orchard"
    (folder / "robots").mkdir(parents=True)
    for name, source in FILES.items():
        shutil.copy(FLYAQ / source, folder / name)
    return folder


def held(folder):
    return {file: file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


def told(err, code):
    return [line for line in err.splitlines() if line.endswith(f"[{code}]")]


def test_validate_finds_a_mission_valid_and_lists_what_is_not_as_it_was(mmrs, orchard):
    before = held(orchard)
    code, out, err = mmrs("validate", orchard)
    assert code == 0
    assert "valid (" in out
    words = "a model of FLYAQ 2015, migrated while it was read; 'mmrs migrate' makes a project of it [MIG003]"
    places = ("context.json:1", "mission.json:1", "robots/Heron.xmi:2")
    assert told(err, "MIG003") == [f"{orchard / place}: note: {words}" for place in places]
    assert (
        f"{orchard / 'mission.json'}:63: note: defaulted: name is not given: Heron_2 (name of Drone) [MIG005]"
        in err
    )
    assert len(err.splitlines()) == len(set(err.splitlines()))
    assert held(orchard) == before


@pytest.mark.parametrize("name", ["behaviour.xmi", "mission.json", "context.json", "robots/Heron.xmi"])
def test_validate_takes_each_file_by_itself(mmrs, orchard, name):
    code, out, err = mmrs("validate", orchard / name, QUIET)
    assert (code, "valid" in out) == (0, True)
    assert told(err, "MIG003") + told(err, "MIG005") == []


def test_quiet_migration_counts_what_was_lost_and_lists_nothing(mmrs, orchard):
    _, _, err = mmrs("validate", orchard / "robots" / "Heron.xmi", QUIET)
    file = orchard / "robots" / "Heron.xmi"
    words = "values not carried over: 2; --quiet-migration hides the list [MIG006]"
    assert err.splitlines() == [f"{file}:2: warning: {words}"]


def test_faults_of_the_mission_stand_on_the_lines_of_the_file_as_it_is(mmrs, orchard):
    file = orchard / "mission.json"
    file.write_text(file.read_text().replace('"Heron"', '"Egret"', 1))
    code, _, err = mmrs("validate", orchard, QUIET)
    (fault,) = told(err, "MML004")
    assert code == 1
    assert fault.startswith(f"{file}:57: error: Robot 'heron_1': unknown robot type 'Egret'")
    assert '"heron_1"' in "".join(file.read_text().splitlines()[56:59])


def test_show_prints_what_a_behaviour_becomes(mmrs):
    code, out, err = mmrs("show", FLYAQ / "round.xmi", "--path", "robots[0].moves[0].name")
    assert (code, out) == (0, "/robots[0]/moves[0]/name: begin\n")
    assert len(told(err, "MIG003")) == 1


def test_plan_writes_the_behaviour_and_leaves_the_mission_as_it_is(mmrs, orchard):
    (orchard / "behaviour.xmi").unlink()
    before = held(orchard)
    code, out, _ = mmrs("plan", orchard, QUIET)
    planned = orchard / "behaviour.xmi"
    assert code == 0
    assert out.endswith(f"written: {planned}\n")
    after = held(orchard)
    assert b"urn:mmrs:behaviour:1.0" in after.pop(planned)
    assert after == before
    code, out, _ = mmrs("simulate", planned, QUIET)
    assert (code, out.partition(" ")[0]) == (0, "success")


def test_plan_does_not_replace_a_behaviour_of_theirs(mmrs, orchard):
    before = held(orchard)
    code, _, err = mmrs("plan", orchard, QUIET)
    assert code == 2
    assert f"{orchard / 'behaviour.xmi'}: was not planned but written by hand, and is not replaced" in err
    assert held(orchard) == before


def test_check_and_simulate_take_a_behaviour_with_its_robot_type(mmrs, orchard):
    code, out, err = mmrs("check", orchard / "behaviour.xmi")
    assert (code, "behaviour.xmi: safe" in out) == (0, True)
    assert "no robot type 'Heron' is known" not in err
    code, out, _ = mmrs("simulate", FLYAQ / "round.json", "--robots", HERON, QUIET)
    assert (code, out.partition(" ")[0]) == (0, "success")


def test_a_behaviour_alone_says_which_robot_type_is_missing(mmrs, tmp_path):
    lone = shutil.copy(FLYAQ / "round.xmi", tmp_path)
    code, _, err = mmrs("simulate", lone)
    assert code == 1
    assert "no robot type 'Heron' is known: give the file that describes it by --robots" in err
    assert "migrate the file" not in err


@pytest.mark.parametrize("name", ["mission.json", "behaviour.xmi"])
def test_preview_draws_them(mmrs, orchard, tmp_path, name):
    code, out, _ = mmrs("preview", orchard / name, "-o", tmp_path / "pictures", QUIET, "--json")
    assert code == 0
    assert [Path(file).name for file in json.loads(out)["files"]] == ["preview.html", "preview.svg"]


def test_mmrs_gen_writes_the_code_of_their_behaviour(mmrs, orchard, tmp_path):
    arguments = ("--target", "mavlink-python", "-o", tmp_path / "code", "--allow-lossy", QUIET, "--json")
    code, out, _ = mmrs(orchard / "behaviour.xmi", *arguments, program="mmrs-gen")
    assert code == 0
    assert {"robot_scout.py", "robot_follower.py"} <= {Path(file).name for file in json.loads(out)["files"]}


def test_json_is_one_object_with_the_list_in_it(mmrs, orchard):
    code, out, _ = mmrs("validate", orchard, "--json")
    faults = json.loads(out)["diagnostics"]
    assert code == 0
    assert {"MIG003", "MIG005", "MIG006"} <= {fault["code"] for fault in faults}
    code, out, _ = mmrs("validate", orchard, "--json", QUIET)
    assert {fault["code"] for fault in json.loads(out)["diagnostics"]} == {"MIG006"}


def test_fix_leaves_their_files_alone_and_names_what_migrates_them(mmrs, orchard):
    before = held(orchard)
    code, out, err = mmrs("validate", orchard, "--fix", "--yes", QUIET)
    assert (code, out) == (2, "")
    file = orchard / "mission.json"
    assert f"mmrs: {file}: a model of FLYAQ 2015, which cannot be fixed; 'mmrs migrate' makes" in err
    assert held(orchard) == before


def test_fix_mends_ours_beside_theirs(mmrs, orchard):
    from mmrs_core.resources import shipped

    drone = orchard / "robots" / "small-drone.xmi"
    shutil.copy(shipped("examples") / "handwritten" / "robots" / "small-drone.xmi", drone)
    code, out, err = mmrs("validate", orchard, "--fix", "--yes", QUIET)
    assert (code, "valid" in out) == (0, True)
    theirs = ("mission.json", "context.json", "robots/Heron.xmi")
    assert [name for name in theirs if f"{orchard / name}: a model of FLYAQ 2015" not in err] == []
    assert f"{drone}: a model" not in err


def test_convert_refuses_and_names_what_migrates(mmrs, tmp_path):
    for arguments in (
        (FLYAQ / "round.xmi", tmp_path / "x.json"),
        (FLYAQ / "round.xmi", "-o", tmp_path / "x"),
    ):
        code, _, err = mmrs("convert", *arguments)
        assert code == 1
        words = "a model of FLYAQ 2015, not converted; 'mmrs migrate' makes a project of it"
        assert f"{FLYAQ / 'round.xmi'}: {words}" in err
    assert list(tmp_path.iterdir()) == []


def test_diff_compares_what_they_become(mmrs):
    code, out, _ = mmrs("diff", FLYAQ / "round.xmi", FLYAQ / "round.json")
    assert (code, out) == (0, "the models say the same\n")


def test_an_ecore_file_that_is_named_goes_before_migration(mmrs):
    finch, ecore = FLYAQ / "workspace" / "Finch.xmi", FLYAQ / "workspace" / "drone.ecore"
    _, out, err = mmrs("show", finch, "--metamodel", ecore)
    assert told(err, "MIG003") == []
    assert "hull: Hull" in out
    _, out, err = mmrs("show", finch)
    assert len(told(err, "MIG003")) == 1
    assert "hull: Hull" not in out


@pytest.mark.parametrize("command", ["validate", "show", "check", "simulate", "plan", "preview"])
def test_what_holds_no_model_is_refused_in_the_words_of_mmrs_migrate(mmrs, command):
    code, _, err = mmrs(command, FLYAQ / "palette.json")
    assert code == 3
    assert f"{FLYAQ / 'palette.json'}: " in err
    assert "a palette of the 2015 editor: nothing to migrate" in err


def test_without_plug_ins_it_is_said_what_is_missing(mmrs):
    _, _, err = mmrs("--no-plugins", "show", FLYAQ / "round.xmi")
    assert "http://www.flyaql.it/behaviour: no such metamodel, needed for Behaviour [XMI001]" in err


def test_the_python_api_takes_them(contributions, orchard):
    from mmrs_core.pipeline import valid_models

    models, warnings = valid_models(orchard, contributions)
    assert models.mission.name == "orchard"
    assert set(models.robots) == {"Heron"}
    assert {"MIG003", "MIG005", "MIG006"} == {fault.code for fault in warnings}


def test_robot_types_of_ours_serve_a_mission_of_theirs(mmrs, orchard, tmp_path):
    assert mmrs("migrate", HERON, "-o", tmp_path / "ours")[0] == 0
    shutil.move(tmp_path / "ours" / "robots" / "Heron.xmi", orchard / "robots" / "Heron.xmi")
    code, _, err = mmrs("validate", orchard)
    assert code == 0
    assert "no robot type" not in err
    assert f"{orchard / 'robots'}" not in err


def test_a_dialect_of_a_plug_in_enters_the_same_way(mmrs, monkeypatch, tmp_path):

    from mmrs_core.cli.settings import Settings
    from mmrs_core.hookspecs import hookimpl
    from mmrs_core.plugins import load_plugins

    class Harbour:
        @hookimpl
        def mmrs_importers(self):
            return (importer_of("Harbour", DIALECTS / "harbour.toml"),)

    def plugins(settings):
        return load_plugins(extra={"harbour": Harbour()}, quiet_migration=settings.quiet_migration)

    monkeypatch.setattr(Settings, "plugins", plugins)
    code, out, err = mmrs("show", DIALECTS / "tug.xmi")
    assert (code, out.partition(" ")[0]) == (0, "Robot")
    assert "a model of Harbour, migrated while it was read" in err
    _, _, quiet = mmrs("show", DIALECTS / "tug.xmi", QUIET)
    assert told(quiet, "MIG003") + told(quiet, "MIG005") == []
    code, out, _ = mmrs("migrate", DIALECTS / "tug.xmi", "-o", tmp_path / "harbour")  # by the same mapping
    assert code == 0
    assert (tmp_path / "harbour" / "robots").is_dir()
