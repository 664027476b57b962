"""Vehicles below the surface: they hold with their motors, and have come up only when they are up."""

from dataclasses import replace

import pytest
from flight_crew import manned, robot_of

from mmrs_mavlink.program import Geographic, GoTo, Look, Run, Start, Step, Stop, Then
from mmrs_mavlink.services.uploads import Uploads, mission_of
from mmrs_mavlink.steps.obeying import undone
from mmrs_runtime.faults import MOTORS_OFF, RefusedError

BELOW = Geographic(42.37, 13.35, -4.0)


@pytest.fixture
def below():
    """Give a submarine four metres below its home."""
    with manned(robot_of(vehicle="sub"), kind="sub") as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        made.vehicle.go_to(BELOW, None, None, False)
        yield made


def test_a_submarine_that_holds_keeps_its_motors_running(below):
    assert below.vehicle.hold()
    assert below.simulated.autopilot.armed


def test_a_submarine_whose_motors_are_off_below_has_not_surfaced(below):
    with below.simulated.lock:
        below.simulated.autopilot.disarm()
    below.watch.moving = False
    assert below.link.wait(lambda: not below.vehicle.state().armed, 60.0)
    with pytest.raises(RefusedError, match="it is disarmed: it surfaces only if it is buoyant"):
        below.vehicle.surface()


def test_a_submarine_whose_motors_are_off_below_does_not_hold(below):
    assert undone("HOLD", below.robot, below.vehicle, 20.0) == ""
    with below.simulated.lock:
        below.simulated.autopilot.disarm()
    below.watch.moving = False
    assert below.link.wait(lambda: not below.vehicle.state().armed, 60.0)
    assert undone("HOLD", below.robot, below.vehicle, 20.0) == "it is disarmed, below the surface"


def test_motors_that_stop_below_are_noticed(below):
    below.quiet(2.0)
    with below.simulated.lock:
        below.simulated.autopilot.disarm()
    assert below.caught().event == MOTORS_OFF


def test_motors_that_stop_at_the_surface_are_not(below):
    below.quiet(2.0)
    below.vehicle.surface()
    with below.simulated.lock:
        below.simulated.autopilot.disarm()
    below.quiet(5.0)


def test_a_submarine_turns_to_what_a_device_without_a_gimbal_looks_at(below):
    below.vehicle.turn(Look(Geographic(42.37, 13.351, -4.0)))
    assert abs(below.simulated.autopilot.body.heading - 90.0) < 5.0


WAYPOINT = 16
DEPTHS = {"down": -8.0, "up": 0.0, "again": -0.5}
STEPS = (
    Step("start", Start(), then=Then("down")),
    *(Step(name, GoTo(Geographic(42.37, 13.35, up), 1.0)) for name, up in DEPTHS.items()),
    Step("stop", Stop()),
)


@pytest.mark.parametrize(("vehicle", "heights"), [("sub", [-8.0, -0.01, -0.5]), ("rover", [-8.0, 0.0, -0.5])])
def test_a_place_at_the_surface_is_a_little_below_it(vehicle, heights):
    robot = replace(robot_of(), vehicle=vehicle, steps=STEPS, runs=(Run(tuple(DEPTHS), (0.0,) * 3),))
    items, _ = mission_of(robot)
    assert [item.z for item in items if item.command == WAYPOINT and item.x][-3:] == heights
