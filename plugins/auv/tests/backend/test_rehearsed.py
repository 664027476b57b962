import re
from collections.abc import Callable
from dataclasses import replace
from math import dist
from pathlib import Path

import dives
import pytest
from dives import POOL, Rehearsed, dive, rehearse, swim
from mmrs_auv.backend.rehearsed import RehearsedRobot
from mmrs_multicopter.testing import robot_program, take_off

from auv_vessel.body.surroundings import BUOY, Surroundings, Thing, to_json
from auv_vessel.movement import guidance, movement
from mmrs_core.behaviour.program import Action, Heading, Move, MoveTarget, Transition
from mmrs_core.contributions.execution import Condition
from mmrs_core.errors import UnsupportedError
from mmrs_core.scene import Area, AreaUse, Device, Policy, RobotType
from mmrs_core.testing.programs import feedback, move, notify, program, use
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.long

SAMPLE = use("ctd", "Sample")
BUOY_NAME = "red buoy"
AFLOAT = 0.4
"""Metres less deep than which the vehicle is at the surface; it floats at 0.2 m."""


def with_parameter(text: str) -> Action:
    return replace(SAMPLE, parameters=(("seconds", text),))


def feedback_move() -> Move:
    return replace(move("tell", "HoldPosition", duration=0.0), after=(feedback("there"),))


def at(robot: RehearsedRobot) -> tuple[float, float, float]:
    truth = robot.stage.vehicle.truth
    return truth.east, truth.north, truth.depth


def test_a_thruster_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    notes: list[object] = []
    monkeypatch.setattr(RehearsedRobot, "note", lambda robot, kind, content: notes.append((kind, content)))
    rehearse(dive(swim("out", 2.0, 0.0, 1.0)), tmp_path, lambda robot: robot.stage.vehicle.faults.dead.add(1))
    said = {"severity": "ERROR", "text": "thruster 'T2' has failed"}
    assert notes.count(("text", said)) == 1


def test_every_move_and_action_is_carried_out(tmp_path: Path) -> None:
    look = Heading(MoveTarget((5.0, 0.0, -1.5)), angle_degrees=90.0)
    out = swim("out", 3.0, 2.0, 1.5, after=(SAMPLE, feedback("there", ("depth", "1.5"))))
    stay = move("stay", "HoldPosition", duration=5.0)
    turn = replace(move("turn", "HeadTo"), heading=look)
    found = rehearse(dive(out, stay, turn, swim("near", 3.0, 4.0, 1.0, distance=0.5)), tmp_path)

    robot = found.robots["naiad"]
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert found.accepted
    assert [each.device for each in robot.stage.vehicle.devices.operations] == [2]
    times = {(each.label, each.move): each.time for each in found.run.records}
    assert times["end", "stay"] - times["begin", "stay"] == pytest.approx(5.0, abs=0.25)
    assert times["begin", "stay"] - times["end", "out"] >= 2.0
    track = [(each.east, each.north, each.up) for each in found.run.tracks["naiad"]]
    assert min(dist(each, (3.0, 2.0, -1.5)) for each in track) < 0.4
    assert dist(at(robot), (3.0, 3.5, 1.0)) < 0.8


def test_a_turn_points_where_it_is_to(tmp_path: Path) -> None:
    look = Heading(MoveTarget((10.0, 0.0, -0.5)))
    found = rehearse(dive(replace(move("turn", "HeadTo"), heading=look)), tmp_path, noise="no")
    assert found.robots["naiad"].stage.vehicle.truth.heading == pytest.approx(90.0, abs=6.0)


def with_a_sonar(properties: dict[str, str]) -> RobotType:
    kind = dives.diver()
    return replace(kind, devices={**kind.devices, "sonar": Device("sonar", {}, properties)})


def test_a_turn_points_a_device_that_looks_aside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kind = with_a_sonar({"mount.yaw": "-90"})
    monkeypatch.setattr(dives, "diver", lambda: kind)
    look = Heading(MoveTarget((10.0, 0.0, -0.5)), "sonar")
    found = rehearse(dive(replace(move("turn", "HeadTo"), heading=look)), tmp_path, noise="no")
    assert found.robots["naiad"].stage.vehicle.truth.heading == pytest.approx(180.0, abs=6.0)


@pytest.mark.parametrize(
    ("properties", "why"),
    [
        ({"mount.yaw": "aside"}, "device 'sonar': mount.yaw is not a number"),
        ({"mavlink.gimbal": "1"}, "device 'sonar' turns on its own, where only the vehicle can be turned"),
    ],
)
def test_what_cannot_point_there_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, properties: dict[str, str], why: str
) -> None:
    kind = with_a_sonar(properties)
    monkeypatch.setattr(dives, "diver", lambda: kind)
    look = Heading(MoveTarget((10.0, 0.0, -0.5)), "sonar")
    with pytest.raises(UnsupportedError) as error:
        rehearse(dive(replace(move("turn", "HeadTo"), heading=look)), tmp_path)
    assert f"move 'turn': {why}" in error.value.elements


def test_moves_that_flow_do_not_stop(tmp_path: Path) -> None:
    moves = [swim(f"m{n}", 2.0 * n, 0.0, 1.0, flows=True) for n in (1, 2, 3)]
    fluid = {index: Transition(index, index + 1, fluid=True) for index in (1, 2)}
    stops = rehearse(dive(*moves), tmp_path / "stops")
    flows = rehearse(dive(*moves, transitions=fluid), tmp_path / "flows")
    assert flows.accepted
    assert flows.run.ending.time < stops.run.ending.time - 2.0


Meddle = Callable[[RehearsedRobot], None]


def leak(robot: RehearsedRobot) -> None:
    robot.stage.vehicle.faults.leak = True


def empty(robot: RehearsedRobot) -> None:
    robot.stage.vehicle.charge *= 0.1


@pytest.mark.parametrize(
    ("meddle", "event"), [(leak, "CRASHED"), (empty, "BATTERY_LOW")], ids=["leak", "battery"]
)
def test_whatever_goes_wrong_the_vehicle_comes_up(tmp_path: Path, meddle: Meddle, event: str) -> None:
    def under_way(robot: RehearsedRobot) -> None:
        look = robot._look

        def meddled(now: float) -> None:
            look(now)
            if now > 8.0:
                meddle(robot)
                robot._look = look  # type: ignore[method-assign]

        robot._look = meddled  # type: ignore[method-assign]

    found = rehearse(dive(swim("out", 12.0, 0.0, 2.0)), tmp_path, under_way)
    assert found.fault == event
    assert found.accepted
    assert at(found.robots["naiad"])[2] < AFLOAT
    assert list(found.run.ending.responses.values()) == ["SURFACE"]
    stage = found.robots["naiad"].stage
    stage.advance(stage.rehearsal.now + 20.0)
    assert [drive.thrust for drive in stage.vehicle.drives] == [0.0] * len(stage.vehicle.drives)
    assert stage.vehicle.truth.depth < AFLOAT


def test_that_the_dive_was_given_up_is_told_once(tmp_path: Path) -> None:
    found = rehearse(dive(swim("out", 12.0, 0.0, 2.0)), tmp_path, leak)
    robot, now = found.robots["naiad"], found.run.ending.time
    assert found.fault == "CRASHED"
    robot.look(now)
    assert robot.trouble is None
    assert robot.done


def test_a_vehicle_that_does_not_get_back_comes_up(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(guidance, "ALLOWANCE", 4.0)
    found = rehearse(dive(swim("out", 0.0, 2.0, 1.0)), tmp_path / "out", noise="no")
    robot, now = found.robots["naiad"], found.run.ending.time
    robot.stage.vehicle.faults.dead |= {0, 1, 2, 3}
    super(type(robot), robot).respond("RETURN", now)
    while robot.trouble is None:
        now += 1.0
        assert now < 120.0
        robot.look(now)
    assert (robot.trouble.which, robot.trouble.instead) == ("NO_PROGRESS", "SURFACE")


def emptied_while_it_holds(folder: Path, *policies: Policy) -> RehearsedRobot:
    """Return a vehicle that holds since a device is silent, and whose battery has become low since."""
    behaviour = dive(swim("out", 1.0, 0.0, 1.0, after=(use("ctd", "Bake"),)))
    holds = replace(behaviour.robots[0], policies=(Policy("DEVICE_SILENT", "HOLD"), *policies))
    found = rehearse(replace(behaviour, robots=(holds,)), folder, noise="no")
    assert list(found.run.ending.responses.values()) == ["HOLD"]
    robot = found.robots["naiad"]
    empty(robot)
    robot.look(found.run.ending.time + 5.0)
    return robot


def test_a_low_battery_that_is_borne_does_not_overtake_a_vehicle_that_holds(tmp_path: Path) -> None:
    assert emptied_while_it_holds(tmp_path, Policy("BATTERY_LOW", "CONTINUE")).trouble is None


def test_a_low_battery_overtakes_a_vehicle_that_holds_until_it_is_answered(tmp_path: Path) -> None:
    robot = emptied_while_it_holds(tmp_path)
    assert robot.trouble is not None
    assert robot.trouble.which == "BATTERY_LOW"
    robot.respond("SURFACE", robot._now)
    robot.look(robot._now)
    assert robot.trouble is None
    assert robot.done


@pytest.mark.thorough
def test_a_bus_that_falls_silent_is_a_lost_link(tmp_path: Path) -> None:
    def deafen(robot: RehearsedRobot) -> None:
        hear = robot.stage.craft.hear
        robot.stage.craft.hear = lambda frame, now: hear(frame, now) if now < 5.0 else None  # type: ignore

    found = rehearse(dive(swim("out", 12.0, 0.0, 2.0)), tmp_path, deafen)
    robot = found.robots["naiad"]
    assert found.fault == "LINK_LOST"
    assert list(found.run.ending.responses.values()) == ["SURFACE"]
    assert at(robot)[2] < AFLOAT
    faults = []
    for _ in range(3):
        robot.look(robot._now)
        faults.append(robot.trouble)
    assert [(each.which, each.instead) for each in faults if each] == [
        ("LINK_LOST", "SURFACE"),
        *[("LINK_LOST", "")] * 2,
    ]


@pytest.mark.thorough
def test_policies_of_the_program_count(tmp_path: Path) -> None:
    shore = Area("shore", AreaUse.EMERGENCY, ((-9.0, -3.0), (-3.0, -3.0), (-3.0, 3.0), (-9.0, 3.0)))
    behaviour = dive(swim("out", 6.0, 0.0, 1.0, after=(use("ctd", "Bake"),)))
    robot = replace(behaviour.robots[0], policies=(Policy("DEVICE_SILENT", "EMERGENCY_AREA"),))
    found = rehearse(replace(behaviour, robots=(robot,)), tmp_path, areas=(shore,))
    assert found.fault == "DEVICE_SILENT"
    east, _, depth = at(found.robots["naiad"])
    assert east < -2.5
    assert depth < AFLOAT

    borne = replace(behaviour.robots[0], policies=(Policy("DEVICE_SILENT", "CONTINUE"),))
    goes_on = rehearse(replace(behaviour, robots=(borne,)), tmp_path / "borne", areas=(shore,))
    assert goes_on.run.ending.outcome is Outcome.SUCCESS


def buoy_at(folder: Path, east: float) -> str:
    file = folder / "pool.json"
    things = (Thing(BUOY, BUOY_NAME, 0.0, east, 1.5, colour="red", size=0.3),)
    file.write_text(to_json(Surroundings(bottom=4.0, things=things)))
    return str(file)


def test_objects_are_gone_to_where_they_are_seen(tmp_path: Path) -> None:
    target = MoveTarget((6.0, 0.0, -1.5), BUOY_NAME, 2.0)
    go = replace(swim("buoy", 0.0, 0.0, 0.0), target=target, distance=1.0)
    found = rehearse(dive(go), tmp_path / "a", objects="seen", surroundings=buoy_at(tmp_path, 7.2))
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert at(found.robots["naiad"])[0] == pytest.approx(6.2, abs=0.6)


def sought_among(tmp_path: Path, *easts: float, **options: str) -> Rehearsed:
    """Return a dive to a buoy that is expected 7 m away, give or take 2 m, past some that look the same."""
    file = tmp_path / "pool.json"
    things = tuple(Thing(BUOY, BUOY_NAME, 0.3, east, 1.5, colour="red", size=0.3) for east in easts)
    file.write_text(to_json(Surroundings(bottom=4.0, things=things)))
    go = replace(
        swim("buoy", 0.0, 0.0, 0.0), target=MoveTarget((7.0, 0.0, -1.5), BUOY_NAME, 2.0), distance=1.0
    )
    return rehearse(dive(go), tmp_path / "logs", surroundings=str(file), heading="90", **options)


def test_what_looks_the_same_and_is_too_far_away_is_passed_by(tmp_path: Path) -> None:
    found = sought_among(tmp_path, 3.0, 7.4, objects="seen")
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert at(found.robots["naiad"])[0] == pytest.approx(6.4, abs=0.6)


@pytest.mark.thorough
def test_of_two_that_look_the_same_in_pictures_the_one_is_meant_that_is_where_expected(
    tmp_path: Path,
) -> None:
    pytest.importorskip("cv2")
    found = sought_among(tmp_path, 2.5, 7.4, objects="cameras")
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert at(found.robots["naiad"])[0] == pytest.approx(6.4, abs=0.8)


@pytest.mark.thorough
def test_a_vehicle_that_sees_only_what_is_too_far_away_says_so_and_comes_up(tmp_path: Path) -> None:
    found = sought_among(tmp_path, 3.0, objects="seen")
    assert found.fault == "OBJECT_NOT_FOUND"
    reason = found.run.ending.faults["naiad"].reason
    assert re.fullmatch(r"object 'red buoy' is [34]\.\d m from where it is expected", reason)
    assert at(found.robots["naiad"])[2] < AFLOAT


def test_objects_are_found_in_pictures(tmp_path: Path) -> None:
    pytest.importorskip("cv2")
    target = MoveTarget((5.0, 0.0, -1.5), BUOY_NAME, 1.5)
    go = replace(swim("buoy", 0.0, 0.0, 0.0), target=target, distance=1.0)
    around = buoy_at(tmp_path, 5.8)
    found = rehearse(dive(go), tmp_path / "a", objects="cameras", surroundings=around, heading="90")
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert at(found.robots["naiad"])[0] == pytest.approx(4.8, abs=0.6)


def test_choices_know_what_was_seen(tmp_path: Path) -> None:
    ways = {1: Transition(1, 2, condition="sees", otherwise=3), 2: Transition(2, 3)}
    sees = Condition("sees", lambda state: BUOY_NAME in state.detected)
    behaviour = dive(swim("out", 2.0, 0.0, 1.0), swim("on", 3.0, 0.0, 1.0), transitions=ways)
    for east, moves in ((5.0, 4), (30.0, 3)):
        folder = tmp_path / f"{east}"
        folder.mkdir()
        found = rehearse(
            behaviour,
            folder / "logs",
            conditions={"sees": sees},
            surroundings=buoy_at(folder, east),
            heading="90",
        )
        assert found.accepted
        assert sum(each.label == "begin" for each in found.run.records) == moves


def test_two_vehicles_keep_their_slots(tmp_path: Path) -> None:
    first = robot_program(
        "one",
        [swim("a", 2.0, 0.0, 1.0, after=(notify(("two", "go")),))],
        home=(0.0, 0.0, -0.5),
        type_name="Pool AUV",
    )
    second = robot_program(
        "two",
        [swim("b", 2.0, 5.0, 1.0)],
        home=(0.0, 5.0, -0.5),
        slots=("go",),
        transitions={0: Transition(0, 1, waits=("go",))},
        type_name="Pool AUV",
    )
    found = rehearse(program(first, second, name="pair", frame=POOL), tmp_path)
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert found.accepted
    told = next(each.time for each in found.run.records if each.label == "ntf")
    assert next(each.time for each in found.run.records if each.move == "b") >= told


@pytest.mark.thorough
def test_the_same_seed_gives_the_same_run(tmp_path: Path) -> None:
    behaviour = dive(swim("out", 2.0, 1.0, 1.0))
    runs = [rehearse(behaviour, tmp_path / f"{n}", seed=seed) for n, seed in enumerate("778")]
    ends = [at(each.robots["naiad"]) for each in runs]
    assert ends[0] == ends[1] != ends[2]


@pytest.mark.thorough
@pytest.mark.parametrize("begins", ["holds", "waits"])
def test_a_vehicle_that_is_to_stay_where_it_begins_is_not_swept_away(tmp_path: Path, begins: str) -> None:
    held = move("stay", "HoldPosition", duration=20.0)
    waits = {0: Transition(0, 1, waits=("go",))}
    other = robot_program(
        "two", [replace(held, after=(notify(("naiad", "go")),))], home=(0.0, 9.0, -0.5), type_name="Pool AUV"
    )
    stays = dive(held) if begins == "holds" else dive(feedback_move(), slots=("go",), transitions=waits)
    behaviour = stays if begins == "holds" else replace(stays, robots=(*stays.robots, other))
    found = rehearse(behaviour, tmp_path, current="0.2,0", noise="no")
    assert found.run.ending.outcome is Outcome.SUCCESS
    assert abs(at(found.robots["naiad"])[1]) < 0.6


@pytest.mark.parametrize(
    ("moves", "said"),
    [
        ((swim("a", 1.0, 0.0, 80.0),), "move 'a': leads 80 m deep, where its vehicle may go 49.6 m deep"),
        ((swim("a", 1.0, 0.0, -3.0),), "move 'a': leads 3 m above the surface"),
        ((swim("a", 9e6, 0.0, 1.0),), "move 'a': leads 9e+06 m to the east, farther than its bus can say"),
        ((swim("a", 1.0, 0.0, 1.0, after=(with_parameter("1e5"),)),), "parameter 100000 of device 'ctd'"),
        ((swim("a", 1.0, 0.0, 1.0, before=(with_parameter("nan"),)),), "parameter nan of device 'ctd'"),
    ],
    ids=["too deep", "in the air", "too far", "too much", "no number"],
)
def test_what_its_bus_cannot_say_is_refused_before_anything_moves(tmp_path, moves, said) -> None:
    with pytest.raises(UnsupportedError) as refused:
        rehearse(dive(*moves), tmp_path)
    assert any(said in each for each in refused.value.elements)


def test_a_speed_that_its_bus_cannot_say_is_not_taken_for_as_fast_as_it_likes(tmp_path: Path) -> None:
    found = rehearse(dive(swim("a", 0.5, 0.0, 0.5, speed=0.004)), tmp_path)
    assert found.run.ending.time > 5.0


@pytest.mark.parametrize(
    "clearance",
    [
        pytest.param(movement.CLEARANCE, id="clear of it"),
        pytest.param(-5.0, id="pressing on it", marks=pytest.mark.thorough),
    ],
)
def test_a_vehicle_that_the_bottom_keeps_from_its_goal_comes_up(clearance, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(movement, "CLEARANCE", clearance)
    monkeypatch.setattr(guidance, "ALLOWANCE", 4.0)
    found = rehearse(dive(swim("out", 1.0, 0.0, 5.0)), tmp_path, bottom="2")
    assert found.fault == "NO_PROGRESS"
    assert at(found.robots["naiad"])[2] < AFLOAT


def test_what_cannot_be_done_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UnsupportedError, match="has none of that name"):
        rehearse(dive(), tmp_path, depth="3")
    with pytest.raises(UnsupportedError, match="north is not NORTH,EAST"):
        rehearse(dive(), tmp_path, current="north")
    with pytest.raises(UnsupportedError):
        rehearse(dive(take_off("up", 3.0)), tmp_path)
    nowhere = replace(swim("x", 0.0, 0.0, 1.0), target=MoveTarget(None, "wreck", None))
    with pytest.raises(UnsupportedError) as refused:
        rehearse(dive(nowhere), tmp_path)
    assert "'x'" in str(refused.value.elements)
