"""Where a robot is in its program, by its log."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from mmrs_mavlink.program import (
    Choose,
    Geographic,
    GoTo,
    Land,
    Local,
    Notify,
    Operate,
    Recharge,
    Robot,
    Start,
    Step,
    Stop,
    TakeOff,
    Then,
)
from mmrs_mavlink.steps.resuming import (
    Progress,
    began_at,
    progress_of,
    slots_of,
    starts_of,
    still_on,
    track_of,
)
from mmrs_runtime.faults import Fault, Refused
from mmrs_runtime.records.log import Log, read
from mmrs_runtime.records.steps import StepRecord

FAR, NEAR = Local(100.0, 0.0, 10.0), Local(0.0, 50.0, 10.0)
TRIGGER = Operate("camera", "every metre", 206, (1.0,))
ROBOT = Robot(
    "r",
    "r.jsonl",
    "copter",
    Local(0.0, 0.0, 0.0),
    "start",
    (
        Step("start", Start(), then=Then("up")),
        Step("up", TakeOff(10.0), then=Choose("calm", "far", "near")),
        Step("far", GoTo(FAR), before=(TRIGGER,), after=(Notify((("s", "go"),)),), then=Then("near")),
        Step("near", GoTo(NEAR), then=Then("down")),
        Step("down", Land(), then=Then("stop")),
        Step("stop", Stop()),
    ),
)
WAY = (
    ("begin", "start", ""),
    ("end", "start", ""),
    ("take", "start", "up"),
    ("begin", "up", ""),
    ("end", "up", ""),
    ("choose", "up", "true"),
    ("act", "far", "pre:0"),
    ("begin", "far", ""),
    ("end", "far", ""),
    ("ntf", "far", "post:0"),
    ("take", "far", "near"),
    ("begin", "near", ""),
)


def records(count=12, *more):
    return logged((*WAY[:count], *more))


def logged(lines):
    """Return steps of these labels, moves and details."""
    return [StepRecord("run-0", "r", n, n + 1, float(n), *line) for n, line in enumerate(lines)]


@pytest.mark.parametrize(
    ("count", "expected"),
    [
        (0, Progress("start")),
        (3, Progress("up")),
        (6, Progress("far")),
        (7, Progress("far", before=1)),
        (8, Progress("far", before=1, begun=True)),
        (9, Progress("far", before=1, begun=True, ended=True)),
        (10, Progress("far", before=1, begun=True, ended=True, after=1)),
        (12, Progress("near", begun=True)),
    ],
)
def test_every_prefix_of_a_log_says_where_the_robot_is(count, expected):
    assert progress_of(ROBOT, records(count)) == expected


def test_the_other_arm_of_a_choice_is_gone_on_with():
    assert progress_of(ROBOT, records(5, ("choose", "up", "false"))).move == "near"


def test_a_log_that_ends_by_a_fault_or_at_the_end_is_over():
    assert progress_of(ROBOT, records(8, ("fault", "far", "TAKEN_OVER"))).over == "it has ended by TAKEN_OVER"
    rest = (("end", "near", ""), ("take", "near", "down"), ("begin", "down", ""), ("end", "down", ""))
    last = (("take", "down", "stop"), ("begin", "stop", ""), ("end", "stop", ""))
    assert progress_of(ROBOT, records(12, *rest, *last)).over == "it has come to its end"


@pytest.mark.parametrize(
    "line", [("begin", "near", ""), ("take", "start", "down"), ("act", "start", "pre:x"), ("ntf", "up", "")]
)
def test_a_log_of_another_program_is_refused(line):
    with pytest.raises(Refused, match="is no step of this program"):
        progress_of(ROBOT, records(1, line, ("end", "start", "")))


def test_the_way_of_a_sortie_begins_at_its_take_off_and_ends_where_the_last_leg_did():
    assert track_of(ROBOT, records()) == [("up", Local(0.0, 0.0, 10.0)), ("far", FAR)]


def test_a_sortie_ends_where_the_robot_has_landed():
    landed = (("end", "near", ""), ("take", "near", "down"), ("begin", "down", ""))
    assert track_of(ROBOT, records(12, *landed)) != []
    assert track_of(ROBOT, records(12, *landed, ("end", "down", ""))) == []


def test_a_sortie_begins_where_the_program_has_landed():
    there = Geographic(42.3705, 13.35, 15.0)
    moves = {
        "up": TakeOff(10.0),
        "out": GoTo(there),
        "down": Land(),
        "again": TakeOff(20.0),
        "on": GoTo(there),
    }
    names = [*moves, None]
    steps = tuple(
        Step(name, movement, then=Then(following) if following else None)
        for (name, movement), following in zip(moves.items(), names[1:], strict=True)
    )
    robot = Robot("r", "r.jsonl", "copter", Geographic(42.37, 13.35, 0.0), "up", steps)
    log = logged((label, name, "") for name in moves for label in ("begin", "end"))
    assert began_at(robot, log[:4]) == robot.home
    assert began_at(robot, log[:6]) == Geographic(42.3705, 13.35, 0.0)
    assert track_of(robot, log[:8]) == [("again", Geographic(42.3705, 13.35, 20.0))]


@pytest.mark.parametrize(
    ("begun", "north"),
    [
        ("up", [0.0]),
        ("on", [0.0]),
        ("down", [0.0, 70.0]),
        ("charge", [70.0]),
        ("again", [70.0]),
        ("back", [70.0]),
        ("end", [70.0, 0.0]),
    ],
)
def test_a_robot_on_the_ground_stands_where_it_began_its_sortie_or_was_to_land(begun, north):
    moves = {
        "up": TakeOff(10.0),
        "on": GoTo(Local(70.0, 0.0, 10.0)),
        "down": Land(),
        "charge": Recharge(5.0),
        "again": TakeOff(20.0),
        "back": GoTo(Local(3.0, 0.0, 20.0)),
        "end": Land(),
    }
    robot = replace(ROBOT, steps=tuple(Step(name, movement) for name, movement in moves.items()))
    log = logged((label, name, "") for name in moves for label in ("begin", "end"))
    until = 2 * list(moves).index(begun) + 1
    assert starts_of(robot, log[:until]) == tuple(Local(each, 0.0, 0.0) for each in north)


def test_what_a_camera_did_by_itself_is_told_again():
    assert list(still_on(ROBOT, records())) == [TRIGGER]
    assert list(still_on(ROBOT, records(6))) == []


def test_slots_are_as_the_logs_leave_them():
    assert slots_of([ROBOT], records()) == ({("s", "go")}, 12)
    assert slots_of([ROBOT], records(9)) == (set(), 9)


def test_a_log_goes_on_after_its_last_whole_line(tmp_path):
    path = tmp_path / "r.jsonl"
    log = Log(path, "run-0", "r")
    log.write("begin", "start", lamport=1, time=1.0)
    log.close()
    with path.open("a") as file:
        file.write('{"run": "run-0", ')
    again = Log(path, "run-0", "r", resume=True)
    again.write("end", "start", lamport=2, time=0.5)
    again.close()
    assert [(step.seq, step.time) for step in read(path)] == [(0, 1.0), (1, 1.0)]


def test_a_log_with_a_gap_is_not_gone_on_with(tmp_path):
    path = tmp_path / "r.jsonl"
    line = {"run": "x", "robot": "r", "seq": 1, "lamport": 1, "time": 0, "label": "begin", "move": "start"}
    path.write_text(json.dumps(line | {"detail": "", "slot": ""}) + "\n", "ascii")
    with pytest.raises(Fault, match=r"r\.jsonl:1: is not the next step"):
        read(path)


@pytest.mark.parametrize("rest", [b'{"run": "r', b"\xff\xfe\0", b"\xffA\n\0\0\n"])
def test_a_log_goes_on_after_its_last_whole_line_whatever_a_loss_of_power_has_left(tmp_path, rest):
    path = tmp_path / "r.jsonl"
    first = Log(path, "run", "r")
    first.write("begin", "start", lamport=1, time=0.0)
    first.close()
    with path.open("ab") as file:
        file.write(rest)
    again = Log(path, "run", "r", resume=True)
    again.write("end", "start", lamport=2, time=1.0)
    again.close()
    assert [step.label for step in read(path)] == ["begin", "end"]
