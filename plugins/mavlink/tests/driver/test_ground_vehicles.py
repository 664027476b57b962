"""Ground vehicles are judged in the plane, whatever they report of their height."""

from dataclasses import replace

import pytest
from flight_crew import HOME, manned, robot_of
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.program import Geographic, GoTo, Look, Run, Start, Step, Stop, Then, Turn
from mmrs_mavlink.services.commands import command_at
from mmrs_mavlink.services.uploads import uploads_of
from mmrs_runtime.controllers.return_paths import way_back

HILL = Geographic(42.37009, 13.35, 12.0)
BEHIND = Geographic(42.37018, 13.35, 20.0)
"""10 and 20 metres north of home, and as high as the program takes the ground to be there."""

MAST = Look(Geographic(42.3705, 13.35, 30.0))
STEPS = (
    Step("start", Start(), then=Then("out")),
    Step("out", GoTo(HILL, 1.5), then=Then("on", fluid=True)),
    Step("on", GoTo(BEHIND, 1.5, "level first"), then=Then("look")),
    Step("look", Turn(MAST), then=Then("stop")),
    Step("stop", Stop()),
)


def rover():
    made = replace(robot_of(vehicle="rover"), steps=STEPS, runs=(Run(("out", "on"), (1.0, 1.0)),))
    return replace(made, escapes=(("on", (HILL,)),))


@pytest.fixture(params=[0.0, 629.7])
def made(request):
    """Give a rover that is ready to move, and whose home may be wrong by 629.7 metres."""
    with manned(rover().judged, kind="rover") as made:
        made.vehicle.prepare(uploads_of(made.robot))
        if request.param:
            low = replace(HOME, height=made.simulated.autopilot.settings.altitude - request.param)
            command_at(made.link, mavlink.MAV_CMD_DO_SET_HOME, low, mavlink.MAV_FRAME_GLOBAL)
            until(lambda: made.link.latest("GLOBAL_POSITION_INT").relative_alt > 629_000)
        made.watch.renew()
        yield made


def test_a_rover_arrives_on_a_hill_and_with_a_wrong_home(made):
    made.vehicle.go_to(made.robot.step("on").movement.at, 1.5, None, False)
    assert made.away(replace(BEHIND, height=0.0)) < 1.0


def test_a_rover_drives_a_run_up_a_hill_and_with_a_wrong_home(made):
    passed = []
    flight = uploads_of(made.robot).flights["out"]
    made.vehicle.fly(flight.first, flight.last, passed.append)
    assert [flight.ends[seq] for seq in passed if seq in flight.ends] == ["out", "on"]
    assert made.away(replace(BEHIND, height=0.0)) < 2.0


def test_a_rover_is_at_home_and_on_its_return_path_whatever_its_height(made):
    hill = made.robot.step("out").movement.at
    made.vehicle.go_to(hill, 1.5, None, False)
    track = [("start", made.robot.home), ("out", hill)]
    path = list(way_back(made.robot, "RETURN", track, made.vehicle.state().place))
    assert path == [made.robot.home]


def test_places_of_a_rover_are_level_and_what_its_devices_look_at_is_not():
    judged = rover().judged
    assert judged.step("out").movement.at == replace(HILL, height=0.0)
    assert judged.step("on").movement == GoTo(replace(BEHIND, height=0.0), 1.5)
    assert judged.escapes == (("on", (replace(HILL, height=0.0),)),)
    assert judged.step("look").movement.look == MAST


def test_heights_of_a_vehicle_that_flies_or_dives_count():
    for vehicle in ("copter", "sub"):
        robot = replace(rover(), vehicle=vehicle)
        assert robot.judged is robot
