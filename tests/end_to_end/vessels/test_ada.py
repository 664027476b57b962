"""Decision centres in Ada, compiled with warnings as errors, on the bus of a simulated vehicle."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import pytest
from ada_centres import build, gateways, run, write
from dives import dive, rehearse, swim
from mmrs_auv.plugin import mmrs_metamodels
from mmrs_auv.vessel.api import Craft
from mmrs_auv.vessel.eyes import Detection, to_datagram
from mmrs_auv.vessel.goals import Goal

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Heading, Move, Target, Transition
from mmrs_core.behaviour.reading import program_of
from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.contributions.execution import Condition
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import registry_with
from mmrs_core.testing.programs import feedback, move
from mmrs_core.testing.small_programs import notify

pytestmark = pytest.mark.xdist_group("vessels in real time")

CHARGED = {"charged": Condition("charged", lambda state: True)}
PHOTO = Action(((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action")), "TakePicture", "front-camera")

PAIR = """<?xml version="1.0" encoding="UTF-8"?>
<bl:Behaviour xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:bl="urn:mmrs:behaviour:1.0" name="pair">
  <targets xsi:type="bl:RelativeCoordinate" name="here" x="0.0" y="0.0"/>
  <robots id="a" typeName="Pool AUV" home="//@targets.0">
    <moves xsi:type="bl:Start" name="start"/>
    <moves xsi:type="bl:HoldPosition" name="hold" duration="1.0">
      <postActions xsi:type="bl:UnicastNotify" slot="//@robots.1/@slots.0"/>
    </moves>
    <moves xsi:type="bl:Stop" name="stop"/>
    <moveTransitions from="//@robots.0/@moves.0" to="//@robots.0/@moves.1" waitFor="//@robots.0/@slots.0"/>
    <moveTransitions from="//@robots.0/@moves.1" to="//@robots.0/@moves.2"/>
    <slots name="ready"/>
  </robots>
  <robots id="b" typeName="Pool AUV" home="//@targets.0">
    <moves xsi:type="bl:Start" name="start"/>
    <moves xsi:type="bl:HoldPosition" name="hold" duration="1.0">
      <preActions xsi:type="bl:UnicastNotify" slot="//@robots.0/@slots.0"/>
    </moves>
    <moves xsi:type="bl:Stop" name="stop"/>
    <moveTransitions from="//@robots.1/@moves.0" to="//@robots.1/@moves.1"/>
    <moveTransitions from="//@robots.1/@moves.1" to="//@robots.1/@moves.2" waitFor="//@robots.1/@slots.0"/>
    <slots name="go"/>
  </robots>
</bl:Behaviour>
"""


@pytest.fixture(scope="module", autouse=True)
def compiler(need_program):
    return need_program("gnatmake", "compiles decision centres in Ada")


def feedback_move(name: str) -> Move:
    return replace(move(name, "HoldPosition", duration=0.1), before=(feedback(name),))


@contextmanager
def telling(port: int, detection: Detection) -> Iterator[None]:
    """Send a detection again and again, and rubbish between."""
    over = threading.Event()

    def tell() -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as camera:
            while not over.wait(0.2):
                for data in (b"\xff{", b'{"name": "', to_datagram(detection)):
                    with suppress(OSError):
                        camera.sendto(data, ("127.0.0.1", port))

    teller = threading.Thread(target=tell)
    teller.start()
    yield
    over.set()
    teller.join()


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


def test_a_choice_goes_by_what_cameras_detect(tmp_path: Path) -> None:
    hold = move("h", "HoldPosition", duration=2.0)
    ways = {1: Transition(1, 2, condition="detected:a buoy", otherwise=3)}
    behaviour = dive(hold, feedback_move("seen"), feedback_move("unseen"), transitions=ways)
    program = build(write(behaviour, tmp_path / "out"))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as camera:
        camera.bind(("127.0.0.1", 0))
        port = camera.getsockname()[1]
    with telling(port, Detection(0.0, "a buoy", 0.9, 1.0, 2.0, 3.0, "front")):
        found = run(program, behaviour, tmp_path, detections=port)
    assert found.status == 0, found.errors
    assert [each.detail for each in read_logs([found.log]) if each.label == "choose"] == ["true"]


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


def test_two_decision_centres_wait_for_each_other_over_the_bus_between_robots(tmp_path: Path) -> None:
    file = tmp_path / "pair.xmi"
    file.write_text(PAIR)
    registry = registry_with(mmrs_metamodels())
    root = read_model(file, registry).roots[0]
    behaviour = program_of(root, registry=registry)  # type: ignore[arg-type]
    out = write(behaviour, tmp_path / "out").parent
    programs = {name: build(out / f"robot-{name}") for name in ("a", "b")}
    with gateways(file, tmp_path, ("a", "b")) as files, ThreadPoolExecutor(2) as pool:
        begun = [
            pool.submit(run, programs[name], behaviour, tmp_path, robot=number, gateway=files[name])
            for number, name in enumerate(("a", "b"))
        ]
        dives = [each.result() for each in begun]
    assert [dive.status for dive in dives] == [0, 0], [dive.errors for dive in dives]
    result = replay(behaviour, read_logs([tmp_path / "logs"]))
    assert result.accepted, result.complaints
    assert result.outcome is Outcome.SUCCESS
