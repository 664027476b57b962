"""The backend ardusub-manual drives the simulated ArduSub, over UDP and faster than the clock."""

from __future__ import annotations

import socket
import time
from contextlib import contextmanager
from dataclasses import replace
from math import hypot

import pytest
from mmrs_auv.manual import ARDUSUB_MANUAL
from mmrs_auv.manual.robot import TOLD
from mmrs_auv.names import AUV_MOVEMENT
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.behaviour.program import Heading, Target
from mmrs_core.contributions.backends import BackendInput, Live
from mmrs_core.errors import UnsupportedError
from mmrs_core.flight.services.commands import command
from mmrs_core.runtime.clock import RealClock
from mmrs_core.scene import Capability, Frame, Part, RobotType
from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_core.testing.programs import move, program, robot_program

SPEEDUP = 10.0
POOL = Frame("EPSG:4326", None, None, surface=0.0)
ROBOT = ("urn:mmrs:robot:1.0", "Robot")
DIVER = RobotType(
    "Diver",
    (ROBOT,),
    (AUV_MOVEMENT,),
    0.5,
    None,
    (Capability(0.0, 3600.0, (0.0, 1.0)),),
    (),
    {},
    Part((ROBOT,), {}),
)


def dive(id, east, north, depth, **changes):
    return replace(move(id, "GoTo"), **{"target": Target((east, north, -depth)), "speed": 0.8, **changes})


MOVES = (
    dive("out", 6.0, 0.0, 2.0),
    move("stay", "HoldPosition", duration=3.0),
    replace(move("look", "HeadTo"), heading=Heading(Target((6.0, 50.0, -2.0)))),
    dive("up", 6.0, 4.0, 0.0),
)


def given(*moves, live=None, **options):
    robot = robot_program("naiad", moves or MOVES, home=(0.0, 0.0, 0.0), type_name="Diver")
    return BackendInput(program(robot, frame=POOL), robot, DIVER, {}, {}, {}, options, live=live)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def until(test, seconds=30.0):
    end = time.monotonic() + seconds
    while not test():
        assert time.monotonic() < end
        time.sleep(0.02)


class Driven:
    def __init__(self, backend, clock, vehicle, said):
        self.backend, self.clock, self.vehicle, self.said = backend, clock, vehicle, said

    def begin(self, id):
        self.backend.begin(next(each for each in MOVES if each.id == id), self.clock.now())

    def finish(self):
        until(lambda: self.fault or self.backend.finished(self.clock.now()))
        assert self.fault is None

    @property
    def fault(self):
        return self.backend.fault(self.clock.now())

    @property
    def truth(self):
        north, east, up = self.vehicle.autopilot.body.position
        return east, north, up


@contextmanager
def sub(*, located=False, **settings):
    """Give a simulated ArduSub that has no position, and its robot, ready."""
    port, clock, said = free_port(), RealClock(SPEEDUP), []
    live = Live(clock, lambda: None, said.append, "run-0", links={"naiad": f"udpin:127.0.0.1:{port}"})
    backend = ARDUSUB_MANUAL.connect(given(live=live))
    with SimulatedVehicle(port, Settings(kind="sub", **settings), speedup=SPEEDUP) as vehicle:
        vehicle.autopilot.located = located
        driven = Driven(backend, clock, vehicle, said)
        try:
            backend.prepare(clock.now())
            driven.finish()
            yield driven
        finally:
            backend.close()


def test_a_program_is_driven_to_its_end_without_any_position():
    with sub() as driven:
        assert driven.vehicle.autopilot.mode_name == "alt_hold"
        for id, place in (("out", (6.0, 0.0, -2.0)), ("stay", (6.0, 0.0, -2.0))):
            driven.begin(id)
            driven.finish()
            assert hypot(driven.truth[0] - place[0], driven.truth[1] - place[1]) <= 1.5
            assert driven.truth[2] == pytest.approx(place[2], abs=0.4)
        driven.begin("look")
        driven.finish()
        assert abs((driven.vehicle.autopilot.body.heading + 180.0) % 360.0 - 180.0) <= 15.0
        driven.begin("up")
        driven.finish()
        assert driven.truth[2] >= -0.4
    assert not driven.vehicle.autopilot.armed


def test_where_the_robot_is_is_reckoned():
    with sub() as driven:
        driven.begin("out")
        driven.finish()
        east, north, up = driven.backend.state(driven.clock.now()).position
        assert (east, north) == pytest.approx((6.0, 0.0), abs=0.5)
        assert up == pytest.approx(-2.0, abs=0.4)


@pytest.mark.parametrize("number", TOLD)
def test_nobody_is_driven_by_a_heading_or_a_depth_of_the_past(number):
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        command(driven.backend._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(number), -1.0)
        until(lambda: driven.fault)
        assert driven.fault.which == "POSITION_LOST"
        until(lambda: not driven.vehicle.autopilot.armed)


def test_a_vehicle_that_was_disarmed_has_not_reached_anything():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        command(driven.backend._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0.0)
        until(lambda: driven.fault or driven.backend.finished(driven.clock.now()))
        assert driven.fault.which == "MOTORS_OFF"


def test_a_vehicle_that_hears_no_sticks_any_more_stops():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        driven.backend._ended.set()
        driven.backend._released = True
        until(lambda: not driven.vehicle.autopilot.armed)
        assert any("manual control" in text for _, _, text in driven.vehicle.autopilot.said)


def test_who_takes_the_stick_has_the_vehicle():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        driven.vehicle.faults.take_stick("manual")
        until(lambda: driven.fault is not None)
        assert driven.fault.which == "TAKEN_OVER"
        assert driven.vehicle.autopilot.armed


def test_a_link_that_is_lost_is_told():
    with sub() as driven:
        driven.begin("out")
        driven.vehicle.mute()
        until(lambda: driven.fault is not None)
        assert driven.fault.which == "LINK_LOST"


@pytest.mark.parametrize(("response", "up"), [("SURFACE", 0.0), ("HOLD", -1.0)])
def test_it_stops_as_a_response_says(response, up):
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.backend.stop(driven.clock.now(), response)
        until(lambda: driven.backend.finished(driven.clock.now()))
        if response == "SURFACE":
            assert driven.truth[2] == pytest.approx(up, abs=0.4)
        else:
            assert driven.truth[2] <= up


@pytest.mark.parametrize(
    ("moves", "why"),
    [
        ((dive("a", 5.0, 0.0, -1.0),), "leads 1 m above the surface"),
        ((dive("a", 5.0, 0.0, 1.0, target=Target((5.0, 0.0, -1.0), "a buoy", 1.0)),), "object 'a buoy'"),
        ((move("a", "Recharge", duration=60.0),), "Recharge is not known to this backend"),
    ],
)
def test_what_cannot_be_driven_by_hand_is_refused(moves, why):
    live = Live(RealClock(1.0), lambda: None, print, "run-0")
    with pytest.raises(UnsupportedError) as refusal:
        ARDUSUB_MANUAL.connect(given(*moves, live=live))
    assert any(why in each for each in refusal.value.elements)


@pytest.mark.parametrize("speed", ["fast", "0", "nan", "100"])
def test_a_speed_that_is_none_is_refused(speed):
    live = Live(RealClock(1.0), lambda: None, print, "run-0")
    with pytest.raises(UnsupportedError, match="option 'full-speed'"):
        ARDUSUB_MANUAL.connect(given(live=live, **{"full-speed": speed}))
