"""Everything that logs and black boxes tell of a flight is gathered, and what they do not tell is said."""

import json

import pytest

from mmrs_core.behaviour.box_files import black_boxes
from mmrs_core.cli.protection import ProtectedError
from mmrs_core.cli.simulation import write_boxes, write_logs
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.pictures.flights.gathering import read_flight


def box_line(robot="alpha", **more):
    whole = {"run": "run-0", "robot": robot, "time": 1.0, "wall": "", "kind": "text", **more}
    return json.dumps(whole) + "\n"


@pytest.fixture
def flight(folder, behaviour, types):
    return lambda *paths: read_flight(paths or (folder,), behaviour, types)


def test_a_simulated_run_is_read_back_as_it_was(flight, run):
    read = flight()
    assert read.damages == ()
    assert read.whole
    for robot, track in run.tracks.items():
        flown = read.robots[robot]
        assert flown.simulated
        assert flown.records == tuple(record for record in run.records if record.robot == robot)
        for sample in track:
            assert flown.track.at(sample.time) == pytest.approx(sample.position, abs=0.002)


def test_a_flight_without_black_boxes_has_steps_and_no_places(flight, folder):
    for box in black_boxes([folder]):
        box.parts[0].unlink()
    read = flight()
    assert read.boxes == 0
    assert len(read.robots["alpha"].records) > 10
    assert len(read.robots["alpha"].track.times) == 0


def test_black_boxes_without_logs_are_a_flight_that_is_not_whole(flight, folder):
    for log in folder.glob("*.jsonl"):
        log.unlink()
    read = flight()
    assert not read.whole
    assert read.robots["alpha"].records == ()
    assert len(read.robots["alpha"].track.times) > 5


def test_a_damaged_line_is_told_and_the_rest_is_used(flight, folder):
    box = folder / "alpha.blackbox.ndjson"
    lines = box.read_text().splitlines(keepends=True)
    box.write_text("".join([*lines[:2], lines[2][:20] + "\n", *lines[3:]]))
    fixes = sum('"kind":"fix"' in line for line in lines)
    read = flight()
    assert read.damages == ("alpha.blackbox.ndjson:3: not JSON",)
    assert len(read.robots["alpha"].track.times) == fixes - 1


def test_many_damaged_lines_are_told_in_short(flight, folder):
    with (folder / "alpha.blackbox.ndjson").open("a") as file:
        file.write("rubbish\n" * 1000)
    damages = flight().damages
    assert len(damages) == 21
    assert damages[-1] == "alpha.blackbox.ndjson: 980 more lines cannot be read"


def test_a_robot_of_another_behaviour_is_told_and_left_out(flight, folder):
    (folder / "gamma.blackbox.ndjson").write_text(box_line("gamma"))
    read = flight()
    assert list(read.robots) == ["alpha", "beta"]
    assert "gamma: no such robot in the behaviour; left out" in read.damages


def test_logs_of_none_of_the_robots_are_refused(flight, folder):
    for path in folder.iterdir():
        path.unlink()
    (folder / "gamma.blackbox.ndjson").write_text(box_line("gamma"))
    with pytest.raises(InvalidModelError, match="these are of gamma: the behaviour has only alpha, beta"):
        flight()


def test_logs_of_different_runs_are_told(flight, folder):
    (folder / "alpha.blackbox.ndjson").write_text(box_line(run="yesterday"))
    assert any("different runs: 'run-0', 'yesterday'" in damage for damage in flight().damages)


def test_steps_of_moves_and_actions_that_nobody_has_are_told_and_left_out(flight, folder):
    log = folder / "beta.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    changed = [lines[0].replace('"move":"', '"move":"un'), *lines[1:]]
    index = next(i for i, line in enumerate(changed) if '"pre:0"' in line)
    changed[index] = changed[index].replace("pre:0", "pre:7")
    log.write_text("".join(changed))
    read = flight()
    assert len(read.robots["beta"].records) == len(lines) - 2
    assert "beta: 2 steps are of moves or actions that the behaviour does not have" in read.damages


def test_counts_grow_within_a_process_and_add_up_over_processes(flight, folder):
    start = box_line(kind="start", link="udpin:0.0.0.0:14550", vehicle="copter")
    counts = [box_line(kind="counted", frames={"unreadable": n}) for n in (3, 5)]
    (folder / "alpha.blackbox.ndjson").write_text(start + "".join(counts) + start + counts[0])
    assert flight().robots["alpha"].counted == {"unreadable": 8}


def test_counts_by_type_and_reason_are_told_with_both(flight, folder):
    frames = {"HEARTBEAT": {"wrong system": 3}, "unreadable": 1}
    (folder / "alpha.blackbox.ndjson").write_text(box_line(kind="counted", frames=frames))
    assert flight().robots["alpha"].counted == {"HEARTBEAT: wrong system": 3, "unreadable": 1}


def test_a_folder_with_neither_log_nor_box_is_refused(flight, tmp_path):
    with pytest.raises(UnreadableError, match="contains no log and no black box"):
        flight(tmp_path)


def test_a_folder_that_is_not_there_is_named(flight, tmp_path):
    with pytest.raises(UnreadableError, match="gone: no such file or folder"):
        flight(tmp_path / "gone")


def test_a_simulation_never_replaces_the_black_box_of_a_flight(run, behaviour, types, folder):
    box = folder / "alpha.blackbox.ndjson"
    box.write_text(box_line(kind="start", link="udpin:0.0.0.0:14550", vehicle="copter"))
    before = box.read_text()
    with pytest.raises(ProtectedError, match=r"alpha\.blackbox\.ndjson: is the black box of a flight"):
        write_logs(run, behaviour, folder, types)
    assert box.read_text() == before


def test_a_simulation_replaces_an_earlier_one(run, behaviour, types, folder):
    (folder / "old.blackbox.ndjson").write_text(box_line("old", kind="start", link="simulation"))
    write_logs(run, behaviour, folder, types)
    assert [box.stem for box in black_boxes([folder])] == ["alpha", "beta"]


def test_the_same_run_makes_the_same_boxes(run, behaviour, types, tmp_path):
    written = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        written.append([p.read_bytes() for p in write_boxes(run, behaviour, types, tmp_path / name)])
    assert written[0] == written[1]
