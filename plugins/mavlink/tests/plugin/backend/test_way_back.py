"""The way back to where a program was broken off, with a vehicle that is not there."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, MULTICOPTER, go_to, robot_program, take_off, target_input

from mmrs_core.behaviour.program import Transition
from mmrs_core.testing.programs import move, program
from mmrs_mavlink.driving.cameras import Cameras
from mmrs_mavlink.driving.moves import Moves
from mmrs_mavlink.driving.way_back import WayBack, sortie_of
from mmrs_mavlink.plugin.controllers import robot_of
from mmrs_mavlink.profiles.needs import TRIGGER_DISTANCE, VIDEO_START_CAPTURE, VIDEO_STOP_CAPTURE
from mmrs_mavlink.program import Object, Operate, Policy
from mmrs_mavlink.vehicles.dry import DryVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.geodesy import distance, offset
from mmrs_runtime.faults import BATTERY_LOW, REFUSED, FaultError, RefusedError
from mmrs_runtime.policies import NOTHING

FLUID = {index: Transition(index, index + 1, fluid=True) for index in (3, 4, 5)}
BEHAVIOUR = program(
    robot_program(
        "r",
        [
            take_off("up", 20.0),
            go_to("out", (0.0, 50.0, 20.0)),
            go_to("s1", (50.0, 50.0, 20.0)),
            go_to("s2", (50.0, 60.0, 20.0)),
            go_to("s3", (0.0, 60.0, 20.0)),
            go_to("s4", (0.0, 70.0, 20.0)),
            go_to("back", (0.0, 0.0, 20.0)),
            LAND,
            move("charge", "Recharge", duration=10.0),
            take_off("again", 15.0),
            go_to("far", (80.0, 0.0, 15.0), trajectory="HORIZONTAL_FIRST"),
            move("end", "Land", uri=MULTICOPTER),
        ],
        transitions=FLUID,
    )
)
ROBOT = robot_of(BEHAVIOUR.robots[0], target_input(BEHAVIOUR))
MOVES = [step.move for step in ROBOT.steps]


class Vehicle(DryVehicle):
    """Remembers where it was told to go: metres east and north of home, and up; it stands on some ground."""

    def __init__(self, east=0.0, north=0.0, up=0.0, ground=0.0):
        super().__init__(Clock(1e6), ROBOT.home, lambda: None)
        self._armed = up > ground
        self._here = replace(
            ROBOT.home,
            latitude=ROBOT.home.latitude + north / 111_319.49,
            longitude=ROBOT.home.longitude + east / 82_246.0,
            height=up,
        )
        self.went, self.energy = [], None

    def state(self):
        return replace(super().state(), energy=self.energy)

    def take_off(self, height):
        self.went.append(("up", height))
        super().take_off(height)

    def go_to(self, place, speed, look, through):
        north, east, up = offset(ROBOT.home, place)
        self.went.append((round(east), round(north), round(up)))
        super().go_to(place, speed, look, through)


OFF = Cameras(ROBOT, ())


def recovered(passed_until, begun, vehicle, tolerance=20.0, policies=(), cameras=OFF):
    """Return where a vehicle goes, after the log of a run that has ended moves up to that one."""
    robot = replace(ROBOT, policies=policies, reserve=0.2)
    moves = Moves(robot, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    passed = MOVES[: MOVES.index(passed_until) + 1]
    WayBack(robot, moves, vehicle, cameras, tolerance).job(passed, begun).run()
    return vehicle.went, [move for move, _ in moves.track]


def test_from_the_ground_it_flies_the_way_that_it_came():
    went, track = recovered("s1", "s2", Vehicle())
    assert went == [("up", 20.0), (0, 50, 20), (50, 50, 20)]
    assert track == ["up", "out", "s1"]


@pytest.mark.parametrize(("energy", "flies"), [(0.19, False), (0.2, True), (None, True)])
def test_it_takes_off_again_unless_its_battery_is_below_the_reserve(energy, flies):
    vehicle = Vehicle()
    vehicle.energy = energy
    if flies:
        assert recovered("s1", "s2", vehicle)[0][0] == ("up", 20.0)
        return
    with pytest.raises(FaultError, match="its battery is still at 19%") as low:
        recovered("s1", "s2", vehicle)
    assert low.value.event == BATTERY_LOW
    assert vehicle.went == []


def test_a_battery_that_is_low_is_flown_with_where_a_policy_carries_on():
    vehicle = Vehicle()
    vehicle.energy = 0.1
    went, _ = recovered("s1", "s2", vehicle, policies=(Policy(BATTERY_LOW, "CONTINUE"),))
    assert went[0] == ("up", 20.0)


def test_a_battery_that_is_low_keeps_nobody_from_being_charged():
    vehicle = Vehicle()
    vehicle.energy = 0.1
    assert recovered("down", "charge", vehicle)[0] == []


def test_a_sortie_begins_with_its_own_take_off():
    assert sortie_of(ROBOT, MOVES[: MOVES.index("again") + 1]) == ("again",)
    went, _ = recovered("again", "far", Vehicle())
    assert went == [("up", 15.0)]


@pytest.mark.parametrize(("passed", "begun"), [("start", "up"), ("down", "charge"), ("charge", "again")])
def test_on_the_ground_between_sorties_there_is_nothing_to_do(passed, begun):
    assert recovered(passed, begun, Vehicle())[0] == []


def test_a_vehicle_that_has_landed_where_it_was_to_land_stays_there():
    assert recovered("back", "down", Vehicle())[0] == []


def test_in_the_air_on_its_way_it_goes_on_from_there():
    went, track = recovered("s1", "s2", Vehicle(2.0, 30.0, 20.0))
    assert went == [(0, 50, 20), (50, 50, 20)]
    assert track == ["up", "out", "s1"]


@pytest.mark.parametrize(
    ("commands", "went"),
    [
        ((), []),
        (((TRIGGER_DISTANCE, 5.0),), [(0, 50, 20)]),
        (((TRIGGER_DISTANCE, 5.0), (TRIGGER_DISTANCE, 0.0)), []),
        (((VIDEO_START_CAPTURE, 0.0),), [(0, 50, 20)]),
        (((VIDEO_START_CAPTURE, 0.0), (VIDEO_STOP_CAPTURE, 0.0)), []),
    ],
)
def test_the_leg_that_was_interrupted_is_repeated_only_where_a_camera_works_along_it(commands, went):
    cameras = Cameras(ROBOT, ())
    for command, value in commands:
        cameras.note(Operate("camera", "any", command, (value,)))
    assert recovered("out", "s1", Vehicle(20.0, 50.0, 20.0), cameras=cameras) == (went, ["up", "out"])


def test_ahead_on_a_run_that_it_flew_by_itself_it_goes_back_along_it():
    went, _ = recovered("out", "s1", Vehicle(25.0, 60.0, 20.0))
    assert went == [(50, 60, 20), (50, 50, 20), (0, 50, 20)]


class Returning(Vehicle):
    """Its autopilot has begun to bring it home."""

    returns_alone = True


@pytest.mark.parametrize(("vehicle", "instead"), [(Vehicle, ""), (Returning, NOTHING)])
def test_what_its_autopilot_brings_home_is_left_to_that(vehicle, instead):
    flown = vehicle(east=0.0, north=50.0, up=30.0)
    with pytest.raises(FaultError, match="10 m off its path") as refused:
        recovered("out", "s1", flown)
    assert (refused.value.event, refused.value.instead, flown.went) == (REFUSED, instead, [])


def test_in_the_air_elsewhere_it_is_refused():
    with pytest.raises(RefusedError, match="bring it home"):
        recovered("s1", "s2", Vehicle(-60.0, 20.0, 20.0))


def test_on_the_ground_elsewhere_it_is_refused():
    with pytest.raises(RefusedError, match="it stands 30 m from its home: carry it home"):
        recovered("s1", "s2", Vehicle(30.0, 0.0, 0.0))


def test_a_way_back_is_looked_for_before_the_vehicle_hears_a_word():
    vehicle = Vehicle(-60.0, 20.0, 20.0)
    moves = Moves(ROBOT, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    with pytest.raises(RefusedError, match="bring it home"):
        WayBack(ROBOT, moves, vehicle, OFF, 20.0).check(MOVES[: MOVES.index("s1") + 1], "s2")
    assert vehicle.went == []
    assert moves.track == []


def test_nobody_looks_for_objects_before_the_vehicle_sets_out():
    asked = []
    steps = [
        replace(step, movement=replace(step.movement, at=Object("tent"))) if step.move == "s2" else step
        for step in ROBOT.steps
    ]
    robot, vehicle = replace(ROBOT, steps=tuple(steps)), Vehicle(50.0, 55.0, 20.0)
    place = ROBOT.steps[MOVES.index("s2")].movement.at

    def locate(target, state):
        asked.append(state)
        return place

    moves = Moves(robot, vehicle, Clock(1e6), {"tent": locate}, lambda kind, name, content: None)
    way, passed = WayBack(robot, moves, vehicle, OFF, 20.0), MOVES[: MOVES.index("s1") + 1]
    way.check(passed, "s2")
    assert not asked
    way.know(passed, "s2")
    assert asked
    vehicle.go_to(Vehicle(-60.0, 20.0, 20.0).state().place, None, None, False)
    with pytest.raises(RefusedError, match="bring it home"):
        way.check([*passed, "s2"], "s3")


def test_a_vehicle_that_has_not_begun_must_be_at_home():
    moves = Moves(ROBOT, Vehicle(500.0), Clock(1e6), {}, lambda kind, name, content: None)
    with pytest.raises(RefusedError, match=r"it stands 50\d m from its home: carry it home"):
        WayBack(ROBOT, moves, Vehicle(500.0), OFF, 20.0).check(["start"], "up")


@pytest.mark.parametrize(
    ("north", "east", "goes_on"), [(25.0, 0.0, True), (50.0, 0.0, True), (25.0, 30.0, False)]
)
def test_one_that_does_not_take_off_may_be_anywhere_on_its_first_leg(north, east, goes_on):
    robot = replace(ROBOT, steps=tuple(step for step in ROBOT.steps if step.move != "up"))
    vehicle = Vehicle(east, north, north * 0.4)
    moves = Moves(robot, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    way = WayBack(robot, moves, vehicle, OFF, 20.0)
    if goes_on:
        way.check(["start"], "out")
        return
    with pytest.raises(RefusedError, match="30 m off its path: bring it home"):
        way.check(["start"], "out")


def test_the_corner_of_a_trajectory_is_on_the_way():
    vehicle = Vehicle(40.0, 0.0, 15.0)
    recovered("far", "end", vehicle)
    assert distance(vehicle.state().place, Vehicle(80.0, 0.0, 15.0).state().place) < 1.0


def known(passed_until, begun, vehicle):
    """Return the places that a vehicle in the air counts as having come past: moves, and metres from home."""
    moves = Moves(ROBOT, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    WayBack(ROBOT, moves, vehicle, OFF, 20.0).know(MOVES[: MOVES.index(passed_until) + 1], begun)
    assert vehicle.went == []
    return [(move, tuple(map(round, offset(ROBOT.home, place)[:2]))) for move, place in moves.track]


def test_a_vehicle_on_its_way_knows_the_places_behind_it():
    assert known("s1", "s2", Vehicle(2.0, 30.0, 20.0)) == [("up", (0, 0))]
    assert known("out", "s1", Vehicle(20.0, 50.0, 20.0)) == [("up", (0, 0)), ("out", (50, 0))]


def test_a_vehicle_ahead_on_its_run_knows_the_places_that_it_flew_past_by_itself():
    behind = [("up", (0, 0)), ("out", (50, 0)), ("s1", (50, 50)), ("s2", (60, 50))]
    assert known("out", "s1", Vehicle(25.0, 60.0, 20.0)) == behind


def test_a_vehicle_on_the_ground_has_come_past_nothing():
    assert known("s1", "s2", Vehicle()) == []


def test_where_a_way_leads_back_over_itself_the_later_leg_is_meant():
    vehicle = Vehicle(0.0, 30.0, 20.0)
    went, track = recovered("s4", "back", vehicle)
    assert went == []
    assert track == ["up", "out", "s1", "s2", "s3", "s4"]


DELIVERY = program(
    robot_program(
        "r",
        [
            take_off("up", 20.0),
            go_to("b", (70.0, 0.0, 20.0)),
            LAND,
            move("wait", "HoldPosition", duration=10.0),
            move("wait on", "HoldPosition", duration=10.0),
            take_off("again", 15.0),
            go_to("c", (70.0, 60.0, 15.0)),
            go_to("d", (0.0, 60.0, 15.0)),
            move("end", "Land", uri=MULTICOPTER),
        ],
    )
)
PARCEL = robot_of(DELIVERY.robots[0], target_input(DELIVERY))


def delivered(passed_until, begun, vehicle):
    """Return what a vehicle counts as having come past, after it has landed elsewhere than at home."""
    moves = Moves(PARCEL, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    order = [step.move for step in PARCEL.steps]
    WayBack(PARCEL, moves, vehicle, OFF, 20.0).know(order[: order.index(passed_until) + 1], begun)
    return [(move, tuple(map(round, offset(PARCEL.home, place)[:2]))) for move, place in moves.track]


def test_a_sortie_begins_where_the_robot_landed_by_its_program():
    assert delivered("again", "c", Vehicle(70.0, 30.0, 15.0)) == [("again", (0, 70))]
    assert delivered("c", "d", Vehicle(40.0, 60.0, 15.0)) == [("again", (0, 70)), ("c", (60, 70))]


@pytest.mark.parametrize(("passed", "begun"), [("wait", "wait on"), ("down", "wait"), ("again", "c")])
def test_a_robot_at_home_is_refused_whose_program_goes_on_elsewhere(passed, begun):
    words = r"it stands 70 m from where its program has landed it: carry it to 42\.370000, 13\.35085\d"
    with pytest.raises(RefusedError, match=words):
        delivered(passed, begun, Vehicle())
    assert delivered(passed, begun, Vehicle(70.0)) == []


def test_a_robot_takes_off_again_where_its_program_has_landed_it():
    vehicle = Vehicle(72.0, 3.0)
    moves = Moves(PARCEL, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    order = [step.move for step in PARCEL.steps]
    WayBack(PARCEL, moves, vehicle, OFF, 20.0).job(order[: order.index("c") + 1], "d").run()
    assert vehicle.went == [("up", 15.0), (70, 60, 15)]


def test_a_robot_takes_off_on_whatever_ground_it_stands():
    vehicle = Vehicle(70.0, 0.0, 6.0, ground=6.0)
    moves = Moves(PARCEL, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    order = [step.move for step in PARCEL.steps]
    WayBack(PARCEL, moves, vehicle, OFF, 20.0).job(order[: order.index("again") + 1], "c").run()
    assert vehicle.went == [("up", 15.0)]


def test_a_robot_that_stands_where_it_was_to_land_stays_there_on_whatever_ground():
    vehicle = Vehicle(70.0, 0.0, 6.0, ground=6.0)
    vehicle.start = vehicle.state().place
    moves = Moves(PARCEL, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    order = [step.move for step in PARCEL.steps]
    WayBack(PARCEL, moves, vehicle, OFF, 20.0).job(order[: order.index("b") + 1], "down").run()
    assert vehicle.went == []


@pytest.mark.parametrize(
    ("passed", "begun", "starts"),
    [
        ("start", "up", [(0, 0)]),
        ("up", "b", [(0, 0)]),
        ("b", "down", [(0, 0), (0, 70)]),
        ("down", "wait", [(0, 70)]),
        ("again", "c", [(0, 70)]),
        ("d", "end", [(0, 70), (60, 0)]),
    ],
)
def test_a_vehicle_may_stand_where_its_sortie_began_or_where_it_was_to_land(passed, begun, starts):
    order = [step.move for step in PARCEL.steps]
    moves = Moves(PARCEL, Vehicle(), Clock(1e6), {}, lambda kind, name, content: None)
    found = WayBack(PARCEL, moves, Vehicle(), OFF, 20.0).starts(order[: order.index(passed) + 1], begun)
    assert [tuple(map(round, offset(PARCEL.home, start)[:2])) for start in found] == starts


def test_a_robot_that_came_home_instead_of_landing_flies_there_again():
    vehicle, order = Vehicle(), [step.move for step in PARCEL.steps]
    moves = Moves(PARCEL, vehicle, Clock(1e6), {}, lambda kind, name, content: None)
    WayBack(PARCEL, moves, vehicle, OFF, 20.0).job(order[: order.index("b") + 1], "down").run()
    assert vehicle.went == [("up", 20.0), (70, 0, 20)]


def test_a_robot_that_has_waited_and_been_nowhere_goes_on_at_home():
    waits = [move(name, "HoldPosition", duration=10.0) for name in ("one", "two")]
    behaviour = program(robot_program("r", [*waits, take_off("up", 20.0), LAND]))
    robot = robot_of(behaviour.robots[0], target_input(behaviour))
    moves = Moves(robot, Vehicle(), Clock(1e6), {}, lambda kind, name, content: None)
    for passed, begun in ((["start", "one"], "two"), (["start", "one", "two"], "up")):
        WayBack(robot, moves, Vehicle(), OFF, 20.0).know(passed, begun)
    assert moves.track == []
