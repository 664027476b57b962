"""What decision centres in Ada do when something goes wrong: in real time, on a simulated vehicle's bus."""

import signal
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest
from ada_centres import STILL, Dive, Meddle, build, gateways, run, telling, unused_port, write
from dives import dive, swim
from mmrs_auv.plugin import mmrs_metamodels
from waiting_pair import finding_pair, waiting_pair

from auv_vessel.body.surroundings import Obstacle
from auv_vessel.eyes import Detection
from auv_vessel.wire.catalogue import EMERGENCIES
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, Program, Transition
from mmrs_core.behaviour.reading import program_of
from mmrs_core.behaviour.replay import replay
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import registry_with
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import move

pytestmark = [pytest.mark.real_time("vessels"), pytest.mark.thorough]

PHOTO = Action(((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action")), "TakePicture", "front-camera")
FAR = swim("far", 0.0, 12.0, 1.0)
WALL = Obstacle(7.0, 0.0, 1.0, 0.0, 5.0)


@pytest.fixture(scope="module", autouse=True)
def compiler(need_program):
    return need_program("gnatmake", "compiles decision centres in Ada")


def bound(policies: Sequence[Policy], *moves: Move) -> Program:
    """Return a dive with policies of its mission."""
    made = dive(*moves)
    return replace(made, robots=(replace(made.robots[0], policies=tuple(policies)),))


def at(seconds: float, happens: Callable) -> Meddle:
    """Return what happens once, after so many seconds."""
    done = []

    def meddle(world, process) -> None:
        if world.rehearsal.now >= seconds and not done:
            done.append(seconds)
            happens(world, process)

    return meddle


def drained(world, process) -> None:
    world.vehicle.charge *= 0.1


def without_health(world, process) -> None:
    world.vehicle.faults.silent |= {"Health"}


def ways(dive: Dive) -> list[str]:
    return [goal.values["Mode"] for goal in dive.world.trace.told]


def done_by(tmp_path: Path, behaviour: Program, **how) -> Dive:
    found = run(build(write(behaviour, tmp_path / "out")), behaviour, tmp_path, **how)
    assert found.replayed.accepted, found.replayed.complaints
    return found


def test_the_vehicle_goes_back_by_the_way_that_it_came_and_comes_up(tmp_path):
    corner = (swim("a", 0.0, 2.0, 1.0), swim("b", 2.0, 2.0, 1.0), swim("c", 2.0, 9.0, 1.0))
    behaviour = bound([Policy("BATTERY_LOW", "RETURN")], *corner)
    found = done_by(tmp_path, behaviour, meddle=at(12.0, drained))
    assert found.replayed.faults == {"naiad": "BATTERY_LOW"}
    assert ways(found)[-1] == "SURFACE"
    assert found.world.said("GoalPose")[-1].values["Mode"] == "IDLE"
    assert {drive.thrust for drive in found.world.vehicle.drives} == {0.0}
    truth = found.world.vehicle.truth
    assert abs(truth.north) < 1.0
    assert abs(truth.east) < 1.0


def stalled(*spells: tuple[float, float]) -> Meddle:
    """Return what stops the decision centre for spells of time, each from a second to a second."""
    signals = [each for begin, end in spells for each in ((begin, signal.SIGSTOP), (end, signal.SIGCONT))]

    def meddle(world, process) -> None:
        while signals and world.rehearsal.now >= signals[0][0]:
            process.send_signal(signals.pop(0)[1])

    return meddle


def test_a_decision_centre_that_was_stalled_does_not_take_its_own_lateness_for_silence(tmp_path):
    found = done_by(tmp_path, bound([], swim("a", 0.0, 5.0, 1.0)), meddle=stalled((4.0, 4.7), (6.0, 9.0)))
    assert (found.status, found.errors) == (0, "")
    assert not any(found.world.said(name) for name in EMERGENCIES)


def test_the_vehicle_holds_before_an_obstacle_until_nobody_is_there_any_more(tmp_path):
    found = done_by(
        tmp_path,
        bound([Policy("OBSTACLE", "HOLD")], FAR),
        options=("--clearance", "3.0"),
        surroundings=replace(STILL, obstacles=(WALL,)),
        cut=15.0,
    )
    assert found.replayed.faults == {"naiad": "OBSTACLE"}
    assert ways(found) == ["GO_TO", "HOLD"]
    assert found.world.vehicle.truth.north < 4.0


def test_what_goes_wrong_while_it_holds_is_answered_too(tmp_path):
    found = done_by(
        tmp_path,
        bound([Policy("OBSTACLE", "HOLD")], FAR),
        options=("--clearance", "3.0"),
        surroundings=replace(STILL, obstacles=(WALL,)),
        meddle=at(12.0, drained),
    )
    assert found.replayed.faults == {"naiad": "OBSTACLE"}
    assert ways(found) == ["GO_TO", "HOLD", "SURFACE"]


def test_a_condition_that_fails_has_the_vehicle_hold(tmp_path):
    turn = {1: Transition(1, 2, condition="charged", otherwise=2)}
    behaviour = dive(FAR, transitions=turn)
    robot = write(behaviour, tmp_path / "out")
    conditions = robot / "conditions.adb"
    asked = "return Undecided.Nobody_Says (Condition, Known);\n      end if;"
    fails = "return Known.Charge > Long_Float'Value (Condition);\n      end if;"
    text = conditions.read_text()
    assert asked in text
    conditions.write_text(text.replace(asked, fails))
    found = run(build(robot), behaviour, tmp_path, meddle=at(45.0, drained))
    assert found.replayed.accepted, found.replayed.complaints
    assert found.replayed.faults == {"naiad": "CONDITION_FAILED"}
    assert ways(found) == ["GO_TO", "HOLD", "SURFACE"]


def test_a_fault_that_is_borne_does_not_end_the_plan(tmp_path):
    found = done_by(
        tmp_path,
        bound([Policy("BATTERY_LOW", "CONTINUE")], swim("a", 0.0, 3.0, 1.0)),
        meddle=at(2.0, drained),
    )
    assert (found.status, found.replayed.faults) == (0, {})


@pytest.mark.parametrize(("response", "status"), [("CONTINUE", 0), ("SURFACE", 1)])
def test_a_silent_device_ends_the_plan_unless_that_is_borne(tmp_path, response, status):
    found = done_by(
        tmp_path,
        bound([Policy("DEVICE_SILENT", response, 1.0)], swim("a", 0.0, 1.0, 1.0, after=(PHOTO,))),
        extra={f"device{number}.seconds": 1000.0 for number in range(3)},
    )
    assert found.status == status
    assert found.replayed.faults == ({"naiad": "DEVICE_SILENT"} if status else {})


def test_thrust_is_stopped_where_a_policy_says_so(tmp_path):
    found = done_by(tmp_path, bound([Policy("BATTERY_LOW", "STOP_THRUST")], FAR), meddle=at(4.0, drained))
    assert found.replayed.faults == {"naiad": "BATTERY_LOW"}
    assert found.world.said("GoalPose")[-1].values["Mode"] == "IDLE"


def test_batteries_are_charged_at_the_surface(tmp_path):
    found = done_by(
        tmp_path,
        bound([], swim("a", 0.0, 1.0, 1.0), move("r", "Recharge", duration=2.0), swim("b", 0.0, 2.0, 1.0)),
    )
    assert found.status == 0
    assert ways(found)[:3] == ["GO_TO", "SURFACE", "GO_TO"]


def test_the_dive_is_given_up_when_nobody_tells_of_leaks_and_battery(tmp_path):
    """The actuator controller of this vehicle does not care; the decision centre does."""

    def careless(world, process) -> None:
        without_health(world, process)
        world.actuators._health_at = None

    found = done_by(tmp_path, bound([], FAR), meddle=at(3.0, careless))
    assert found.replayed.faults == {"naiad": "CRASHED"}
    assert [each.values["Reason"] for each in found.world.said("DecisionEmergency")] == ["SENSORS_SILENT"]


def test_a_log_that_cannot_be_written_ends_the_plan(tmp_path):
    program = build(write(bound([], FAR), tmp_path / "out"))
    limited = tmp_path / "limited"
    limited.write_text(f"#!/bin/bash\ntrap '' XFSZ\nulimit -f 0\nexec {program} \"$@\"\n")
    limited.chmod(0o755)
    found = run(limited, dive(FAR), tmp_path)
    assert found.status == 1
    assert ways(found) == ["SURFACE"]
    assert "cannot write the log" in found.errors


def test_the_vehicle_surfaces_when_its_decision_centre_is_killed(tmp_path):
    found = run(
        build(write(dive(FAR), tmp_path / "out")),
        dive(FAR),
        tmp_path,
        meddle=at(5.0, lambda world, process: process.kill()),
    )
    assert found.world.vehicle.truth.depth > 0.7
    found.world.rehearsal.kill("Bridge")
    found.world.rehearsal.run(40.0)
    assert found.world.vehicle.truth.antenna < 0.1


def test_the_vehicle_surfaces_when_its_bus_is_cut(tmp_path):
    found = done_by(tmp_path, bound([], FAR), cut=5.0)
    assert found.replayed.faults == {"naiad": "LINK_LOST"}
    found.world.rehearsal.kill("Bridge")
    found.world.rehearsal.run(40.0)
    assert found.world.vehicle.truth.antenna < 0.1


def pair_in(file: Path) -> Program:
    registry = registry_with(mmrs_metamodels())
    root = read_model(file, registry).roots[0]
    return program_of(root, registry=registry)  # type: ignore[arg-type]


def test_the_vehicle_comes_up_when_its_gateway_dies(tmp_path):
    file = tmp_path / "pair.xmi"
    file.write_text(waiting_pair("Pool AUV").replace('duration="1.0"', 'duration="60.0"'))
    behaviour = pair_in(file)
    out = write(behaviour, tmp_path / "out").parent
    programs = {name: build(out / f"robot-{name}") for name in ("a", "b")}
    with ExitStack() as stack, ThreadPoolExecutor(2) as pool:
        files = stack.enter_context(gateways(file, tmp_path, ("a", "b")))
        log = tmp_path / "logs" / "a.jsonl"

        def meddle(world, process) -> None:
            if log.exists() and '"move":"hold"' in log.read_text():
                stack.close()

        begun = [
            pool.submit(
                run, programs[name], behaviour, tmp_path, robot=number, gateway=files[name], meddle=meddle
            )
            for number, name in enumerate(("a", "b"))
        ]
        dives = [each.result() for each in begun]
    result = replay(behaviour, read_logs([tmp_path / "logs"]))
    assert result.accepted, result.complaints
    assert result.faults == {"a": "PEER_LOST", "b": "PEER_LOST"}
    assert [each.world.said("GoalPose")[-1].values["Mode"] for each in dives] == ["IDLE", "IDLE"]
    assert all(each.world.vehicle.truth.depth < 0.3 for each in dives)


def test_what_one_vehicle_has_found_another_knows_that_it_has_notified(tmp_path):
    file = tmp_path / "pair.xmi"
    file.write_text(finding_pair("Pool AUV"))
    behaviour = pair_in(file)
    out = write(behaviour, tmp_path / "out").parent
    programs = {name: build(out / f"robot-{name}") for name in ("a", "b")}
    port = unused_port()
    seen = Detection(0.0, "a buoy", 0.9, 0.4, 1.2, 1.2, "front")
    with gateways(file, tmp_path, ("a", "b")) as files, ThreadPoolExecutor(2) as pool, telling(port, seen):
        begun = [
            pool.submit(
                run, programs[name], behaviour, tmp_path, robot=number, gateway=files[name], detections=eyes
            )
            for number, (name, eyes) in enumerate((("a", port), ("b", 0)))
        ]
        dives = [each.result() for each in begun]
    assert [dive.status for dive in dives] == [0, 0], [dive.errors for dive in dives]
    chosen = [each.detail for each in read_logs([tmp_path / "logs"]) if each.label == "choose"]
    assert chosen == ["true"]
