import json
from pathlib import Path

import pytest
from mmrs_multicopter.testing import target_input, two_drones

from mmrs_core.contributions.targets import FileSpec, Target, TracedStep
from mmrs_core.errors import UnreadableError
from mmrs_core.generation.explaining import explain, places_of
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin import mmrs_targets

BY_NAME = {target.name: target for target in mmrs_targets()}


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the files of all targets of the core."""
    for target in mmrs_targets():
        write(render(target, target_input(two_drones()), allow_lossy=True), tmp_path)
    return tmp_path


def line_of(file, text):
    return next(number for number, line in enumerate(file.read_text().splitlines(), 1) if text in line)


def serving(folder, file, text):
    """Return the step, robot and move of a line that holds a text."""
    found = explain(folder / file, line_of(folder / file, text))
    return [(entry.step.step, entry.step.robot, entry.step.move) for entry in found.entries]


def test_a_line_of_a_controller_comes_from_a_move(folder):
    assert serving(folder, "robot_alpha.py", '            "a3"') == [("step 4", "alpha", "a3")]
    assert serving(folder, "robot_alpha.py", "Operate(") == [("step 5", "alpha", "a4")]


def test_a_line_of_a_plan_comes_from_a_move(folder):
    assert serving(folder, "alpha.plan", '"doJumpId": 7') == [("item 7", "alpha", "a4")]


def test_a_line_of_a_list_of_waypoints_comes_from_a_move(folder):
    assert serving(folder, "alpha.waypoints", "7\t") == [("item 7", "alpha", "a4")]
    assert serving(folder, "alpha.waypoints", "720.0") == [("home", "alpha", "")]


def test_a_line_about_a_robot_comes_from_no_move(folder):
    assert serving(folder, "robot_beta.py", "slots=") == [("slots", "beta", "")]
    assert serving(folder, "fleet.py", "import robot_beta") == [("controller", "beta", "")]


def test_a_line_of_the_requirements_serves_no_robot_in_particular(folder):
    found = explain(folder / "requirements.txt", 1)
    assert (found.target, found.entries) == ("mavlink-python", ())


def test_task_rule_slots_and_what_follows_are_told(folder):
    found = explain(folder / "robot_alpha.py", line_of(folder / "robot_alpha.py", "Notify(("))
    (entry,) = found.entries
    assert (entry.step.task, entry.step.rule) == ("photos", "by_hand")
    assert (entry.facts.sets, entry.facts.then) == (("beta.go",), ("back",))


def test_a_file_that_was_changed_is_said_to_be(folder):
    file = folder / "robot_alpha.py"
    assert not explain(file, 1).changed
    file.write_text("# mine\n" + file.read_text())
    assert explain(file, 1).changed
    assert {place.changed for place in places_of(folder, move="a1")} == {False, True}


@pytest.mark.parametrize("line", [0, 10_000])
def test_a_line_that_is_not_there_is_unreadable(folder, line):
    with pytest.raises(UnreadableError, match=f"no line {line}"):
        explain(folder / "robot_alpha.py", line)


def test_a_file_that_nobody_generated_is_unreadable(folder):
    (folder / "mine.txt").write_text("x\n")
    with pytest.raises(UnreadableError, match="no manifest"):
        explain(folder / "mine.txt", 1)


def test_a_file_is_found_by_whatever_way_leads_to_it(folder, monkeypatch, tmp_path_factory):
    link = tmp_path_factory.mktemp("elsewhere") / "link"
    link.symlink_to(folder)
    monkeypatch.chdir(folder / "wheels")
    ways = (folder / "wheels" / ".." / "fleet.py", link / "fleet.py", Path("..") / "fleet.py")
    assert [explain(way, 1).target for way in ways] == ["mavlink-python"] * 3


def test_a_folder_without_a_manifest_is_unreadable(tmp_path):
    with pytest.raises(UnreadableError, match="has no manifest"):
        places_of(tmp_path, move="a1")


def test_a_move_is_found_in_the_files_of_every_target(folder):
    found = places_of(folder, robot="alpha", move="a2")
    assert sorted(place.file.name for place in found) == ["alpha.plan", "alpha.waypoints", "robot_alpha.py"]


def test_every_place_of_a_task_leads_back_to_it(folder):
    places = places_of(folder, task="photos")
    assert {place.entry.step.move for place in places} == {"a1", "a2", "a3", "a4"}
    for place in places:
        for line in range(place.entry.first, place.entry.last + 1):
            assert place.entry in explain(place.file, line).entries


def test_every_move_of_a_controller_has_lines(folder):
    manifest = json.loads((folder / "mavlink-python.manifest.json").read_text())
    steps = [entry for entry in manifest["trace"] if entry["move"]]
    assert len(steps) == 18
    assert all(entry["lines"] for entry in manifest["trace"])


def test_the_files_of_a_plugins_target_are_explained_too(tmp_path):
    (tmp_path / "card.jinja").write_text("card\n{% serves step %}\nfly\n{% endserves %}\n")
    spec = FileSpec("card.txt", "card.jinja", {"step": TracedStep("line", "alpha", "a1", "photos")})
    target = Target("cards", "cards", tmp_path, lambda given: [spec], lambda given: [])
    write(render(target, target_input(two_drones())), tmp_path / "out")
    (entry,) = explain(tmp_path / "out" / "card.txt", 2).entries
    assert (entry.step.move, entry.facts.then) == ("a1", ("a2",))
