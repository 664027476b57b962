"""Commands on a behaviour that somebody wrote by hand."""

import json
import re

import pytest
from lxml import etree

CHOICE = "energy_above_100_kJ"


def test_validate_takes_the_file_or_a_folder_without_a_mission(mmrs, project):
    assert mmrs("validate", project / "behaviour.xmi")[0] == 0
    assert mmrs("validate", project) == (0, f"{project}: valid\n", "")
    (project / "mission.xmi").write_text("<no/>")
    assert "mission.xmi:1: error" in mmrs("validate", project)[2]


def test_check_takes_the_folder_or_the_file_and_lists_every_property_as_json(mmrs, project):
    of_folder, of_file = mmrs("check", project), mmrs("check", project / "behaviour.xmi")
    assert of_folder == of_file
    assert of_folder[0] == 0
    told = json.loads(mmrs("check", project, "--json")[1])
    assert told["safe"] is True
    assert {"structure", "synchronisation", "clearance"} <= {each["property"] for each in told["verdicts"]}


def test_check_refuses_a_wait_that_nobody_ends(mmrs, project):
    file = project / "behaviour.xmi"
    tree = etree.parse(file)
    for notify in list(tree.iter("postActions", "preActions")):
        if "Notify" in notify.get("{http://www.w3.org/2001/XMLSchema-instance}type", ""):
            notify.getparent().remove(notify)
    tree.write(file)
    code, out, err = mmrs("check", file)
    assert code == 1
    assert "synchronisation" in out + err


def test_check_without_robot_types_says_what_is_missing(mmrs, project, tmp_path):
    alone = tmp_path / "alone"
    alone.mkdir()
    (project / "behaviour.xmi").rename(alone / "behaviour.xmi")
    code, out, err = mmrs("check", alone)
    assert code == 1
    assert "type" in out + err


def test_robot_types_and_place_can_be_named(mmrs, project, tmp_path):
    alone = tmp_path / "alone"
    alone.mkdir()
    (project / "behaviour.xmi").rename(alone / "behaviour.xmi")
    types = sorted((project / "robots").glob("*.xmi"))
    named = ("--context", project / "context.xmi", "--robots", *types)
    assert mmrs("check", alone, *named)[0] == 0
    assert mmrs("check", alone, "--context", project / "context.xmi", "--robots", project / "robots")[0] == 0


def test_a_simulation_by_name_is_the_same_as_without(mmrs, project):
    assert mmrs("simulate", project, "--backend", "simulation") == mmrs("simulate", project)


@pytest.mark.parametrize(("command", "option"), [("simulate", "-o"), ("run", "--log")])
def test_a_backend_that_nobody_contributed_is_named(mmrs, project, command, option):
    code, _, err = mmrs(command, project, "--backend", "simulaton", option, project / "logs")
    assert code == 2
    assert "backend 'simulaton': unknown; there are " in err
    assert "did you mean simulation?" in err
    assert not (project / "logs").exists()


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--backend-option", "rain=1", "option 'rain': unknown"),
        ("--backend-option", "rain", "--backend-option rain: expected KEY=VALUE"),
        ("--assume", f"{CHOICE}=perhaps", f"--assume {CHOICE}=perhaps: expected CONDITION=yes or"),
        ("--assume", "raining=yes", f"condition 'raining': no Choice uses it; conditions in use: '{CHOICE}'"),
    ],
)
def test_an_option_with_a_value_that_makes_no_sense_is_wrong_usage(mmrs, project, option, value, said):
    code, _, err = mmrs("simulate", project, option, value)
    assert code == 2
    assert said in err


def test_a_simulated_run_replays(mmrs, project):
    code, out, _ = mmrs("simulate", project, "-o", project / "logs")
    assert code == 0
    assert out.startswith("success after ")
    assert mmrs("replay", project, project / "logs")[0] == 0


def test_the_same_simulation_gives_the_same_logs(mmrs, project):
    for name in ("one", "two"):
        mmrs("simulate", project, "-o", project / name)
    logs = [sorted(path.read_bytes() for path in (project / name).iterdir()) for name in ("one", "two")]
    assert logs[0] == logs[1]


def test_conditions_can_be_told_what_to_answer(mmrs, project):
    mmrs("simulate", project, "--assume", f"{CHOICE}=yes", "-o", project / "yes")
    mmrs("simulate", project, "--assume", f"{CHOICE}=no", "-o", project / "no")
    logs = ["".join(path.read_text() for path in (project / name).iterdir()) for name in ("yes", "no")]
    assert '"detail":"true"' in logs[0]
    assert '"detail":"false"' in logs[1]


def test_an_altered_log_does_not_replay(mmrs, project):
    mmrs("simulate", project, "-o", project / "logs")
    log = next((project / "logs").iterdir())
    lines = log.read_text().splitlines()
    log.write_text("\n".join(lines[:3] + lines[4:]) + "\n")
    code, out, _ = mmrs("replay", project, project / "logs")
    assert code == 1
    assert "not what the behaviour says" in out


def test_a_log_that_was_cut_off_replays_as_partial(mmrs, project):
    mmrs("simulate", project, "-o", project / "logs")
    for log in (project / "logs").iterdir():
        log.write_text("".join(log.read_text().splitlines(keepends=True)[:2]))
    assert mmrs("replay", project, project / "logs")[0] == 1
    assert mmrs("replay", "--partial", project, project / "logs")[0] == 0


def test_a_log_that_was_cut_off_inside_a_character_replays_as_partial_and_tells_so(mmrs, project):
    mmrs("simulate", project, "-o", project / "logs")
    for log in (project / "logs").iterdir():
        log.write_bytes(b"".join(log.read_bytes().splitlines(keepends=True)[:2]) + '{"run": "Ä'.encode()[:-1])
    code, _, err = mmrs("replay", "--partial", project, project / "logs")
    assert code == 0
    assert ".jsonl:3: cut off while it was written" in err


def test_logs_of_an_earlier_run_go_away_and_other_files_stay(mmrs, project):
    mmrs("simulate", project, "-o", project / "logs")
    log = next((project / "logs").iterdir())
    log.rename(log.with_name("ghost.jsonl"))
    (project / "logs" / "mine.jsonl").write_text('{"not": "a log"}\n')
    mmrs("simulate", project, "-o", project / "logs")
    names = {path.name for path in (project / "logs").iterdir()}
    assert "ghost.jsonl" not in names
    assert "mine.jsonl" in names


def test_a_behaviour_can_be_drawn(mmrs, project):
    code, out, _ = mmrs("preview", project / "behaviour.xmi", "-o", project / "pictures")
    assert code == 0
    page = (project / "pictures" / "preview.html").read_bytes()
    assert mmrs("preview", project, "-o", project / "of-folder")[0] == 0
    assert (project / "of-folder" / "preview.html").read_bytes() == page
    assert out.count("written: ") == 2
    svg = etree.parse(project / "pictures" / "preview.svg")
    words = "".join(svg.getroot().itertext())
    assert "town hall" in words
    assert "move to my side" in words


def test_show_prints_a_tree_down_to_a_depth_or_one_object(mmrs, project):
    code, out, _ = mmrs("show", project / "behaviour.xmi")
    assert code == 0
    assert out.startswith("Behaviour ")
    assert "\n├─ robots: Robot id=left" in out
    shallow = mmrs("show", "--depth", "1", project / "behaviour.xmi")[1]
    assert "robots: Robot id=left" in shallow
    assert "moves: " not in shallow
    told = json.loads(mmrs("show", "--json", project / "behaviour.xmi")[1])
    assert told["roots"][0]["$type"] == "urn:mmrs:behaviour:1.0#Behaviour"


def test_generate_refuses_what_a_target_cannot_express_and_writes_nothing(mmrs, project):
    out_folder = project / "out"
    code, out, err = mmrs(project, "--target", "qgc-plan", "-o", out_folder, program="mmrs-gen")
    assert (code, out) == (1, "")
    assert "waits for" in err
    assert not out_folder.exists()


def test_generate_leaves_out_what_it_must_when_told_so(mmrs, project):
    code, _, _ = mmrs("generate", project, "--target", "qgc-plan", "-o", project / "out", "--allow-lossy")
    assert code == 0
    assert list((project / "out").glob("*.plan"))


def test_wheels_are_downloaded_for_targets_that_need_any(mmrs, project):
    lossy = ("--target", "qgc-plan", "-o", project / "out", "--allow-lossy")
    code, _, err = mmrs("generate", project, *lossy, "--wheels", "manylinux2014_aarch64")
    assert code == 1
    assert "has no requirements.txt" in err


@pytest.mark.parametrize(("program", "command"), [("mmrs", ["generate"]), ("mmrs-gen", [])])
def test_an_unknown_target_is_told_with_the_known_ones(mmrs, project, program, command):
    code, _, err = mmrs(*command, project, "--target", "toaster", "-o", project / "out", program=program)
    assert code == 2
    assert "qgc-plan" in err


def test_generate_does_not_write_for_an_unsafe_behaviour(mmrs, project):
    context = project / "context.xmi"
    wide = re.sub(r'safetyDistance="[\d.]+"', 'safetyDistance="15"', context.read_text(encoding="utf-8"))
    context.write_text(wide, encoding="utf-8")
    code, _, err = mmrs("generate", project, "--target", "qgc-plan", "-o", project / "out", "--allow-lossy")
    assert code == 1
    assert "the behaviour is not safe\n  - clearance: violated" in err
    assert not (project / "out").exists()
