"""Decision centres in Ada, compiled with warnings as errors, on the bus of a simulated vehicle."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from ada_centres import build, run, write
from dives import dive, rehearse, swim
from mmrs_auv.vessel.api import Craft
from mmrs_auv.vessel.goals import Goal

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Heading, Target, Transition
from mmrs_core.behaviour.replay import Outcome
from mmrs_core.contributions.execution import Condition
from mmrs_core.testing.programs import feedback, move
from mmrs_core.testing.small_programs import notify

pytestmark = pytest.mark.xdist_group("vessels in real time")

CHARGED = {"charged": Condition("charged", lambda state: True)}
PHOTO = Action(((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action")), "TakePicture", "front-camera")


@pytest.fixture(scope="module", autouse=True)
def compiler(need_program):
    return need_program("gnatmake", "compiles decision centres in Ada")


def journey():
    """Return a behaviour with all kinds of moves and actions, and a choice."""
    turn = replace(move('turn "x"\n', "HeadTo"), heading=Heading(Target((0.0, 10.0, -1.0))))
    near = swim("é", 0.0, 0.0, 1.0, before=(PHOTO,), task="home", distance=0.5)
    looking = replace(near, heading=Heading(Target((5.0, 5.0, -1.0)), "", 30.0))
    there = swim("a", 1.0, 1.0, 1.0, after=(notify(("naiad", "go")), feedback("there")))
    hold = move("h", "HoldPosition", duration=1.0)
    return dive(
        there, hold, turn, looking, slots=("go",),
        transitions={2: Transition(2, 3, waits=("go",), condition="charged", otherwise=4)},
    )  # fmt: skip


def test_a_dive_ends_well_and_its_log_replays(tmp_path: Path, monkeypatch) -> None:
    behaviour = journey()
    robot = write(behaviour, tmp_path / "out")
    conditions = robot / "conditions.adb"
    mine = conditions.read_text().replace("Undecided.Nobody_Says (Condition, Known)", "Known.Charge > 0.3", 1)
    conditions.write_text(mine)
    found = run(build(robot), behaviour, tmp_path)
    assert found.status == 0, found.errors
    assert found.replayed.accepted, found.replayed.complaints
    assert found.replayed.outcome is Outcome.SUCCESS
    places = [each.values for each in found.world.said("GoalPlace")]
    assert {"North": 1.0, "East": 1.0} in places

    begun: list[Goal] = []
    plain = Craft._begin
    monkeypatch.setattr(Craft, "_begin", lambda self, goal: (begun.append(goal), plain(self, goal))[1])
    assert rehearse(behaviour, tmp_path / "sim", conditions=CHARGED, noise="no").accepted
    told = [each.values for each in found.world.said("GoalPose") if each.values["Mode"] != "IDLE"]
    wanted = [goal for goal in begun if goal.mode != "IDLE"]
    assert [each["Mode"] for each in told] == [goal.mode for goal in wanted]
    for each, goal in zip(told, wanted, strict=True):
        assert each["Speed"] == pytest.approx(goal.speed, abs=0.011)
        assert each["FaceAlong"] == goal.along
        if goal.mode == "GO_TO":
            assert each["Depth"] == pytest.approx(goal.depth, abs=0.15)
        if not goal.along:
            assert abs((each["Heading"] - goal.heading + 180.0) % 360.0 - 180.0) < 5.0


def test_the_vehicle_is_given_up_when_its_mission_stands_still(tmp_path: Path) -> None:
    behaviour = journey()
    robot = write(behaviour, tmp_path / "out")
    conditions = robot / "conditions.adb"
    mine = conditions.read_text().replace("      if Condition", "      delay 6.0;\n      if Condition", 1)
    conditions.write_text(mine)
    found = run(build(robot), behaviour, tmp_path)
    assert found.status == 1
    reasons = [each.values["Reason"] for each in found.world.said("Emergency")]
    assert reasons[0] == "COMMANDS_SILENT"
    assert found.replayed.faults
    assert found.replayed.accepted, found.replayed.complaints


def test_a_lost_bus_is_a_fault_of_the_move_that_was_under_way(tmp_path: Path) -> None:
    behaviour = dive(swim("far", 30.0, 0.0, 1.0))
    found = run(build(write(behaviour, tmp_path / "out")), behaviour, tmp_path, cut=5.0)
    assert found.status == 1
    assert found.replayed.faults == {"naiad": "LINK_LOST"}
    assert found.replayed.accepted, found.replayed.complaints
