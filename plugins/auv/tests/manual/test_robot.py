"""The backend ardusub-manual drives the simulated ArduSub, over UDP and faster than the clock."""

from __future__ import annotations

import socket
import time
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from math import hypot

import pytest
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.manual import ARDUSUB_MANUAL
from mmrs_auv.manual.autopilot import TOLD
from mmrs_auv.names import AUV_MOVEMENT
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Heading, Target
from mmrs_core.contributions.backends import BackendInput, Live
from mmrs_core.errors import UnsupportedError
from mmrs_core.flight.services.commands import command
from mmrs_core.runtime.clock import RealClock
from mmrs_core.scene import Area, AreaUse, Capability, Device, DeviceAction, Frame, Part, Policy, RobotType
from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_core.testing.programs import move, program, robot_program

SPEEDUP = 10.0
POOL = Frame("EPSG:4326", None, None, surface=0.0)
ROBOT = ("urn:mmrs:robot:1.0", "Robot")
DEVICE_ACTION = ((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action"))
DIVER = RobotType(
    "Diver",
    (ROBOT,),
    (AUV_MOVEMENT,),
    0.5,
    None,
    (Capability(0.0, 3600.0, (0.0, 1.0)),),
    (),
    {"lamp": Device("lamp", {"on": DeviceAction("on", 0.0)}, {"mavlink.relay": "1"})},
    Part((ROBOT,), {"maxOperatingPressure": 600_000.0}),
)


def dive(id, east, north, depth, **changes):
    return replace(move(id, "GoTo"), **{"target": Target((east, north, -depth)), "speed": 0.8, **changes})


MOVES = (
    dive("out", 6.0, 0.0, 2.0),
    move("stay", "HoldPosition", duration=3.0),
    replace(move("look", "HeadTo"), heading=Heading(Target((6.0, 50.0, -2.0)))),
    dive("up", 6.0, 4.0, 0.0),
)


def given(*moves, live=None, areas=(), policies=(), **options):
    robot = robot_program("naiad", moves or MOVES, home=(0.0, 0.0, 0.0), type_name="Diver")
    kinds = {AUV_MOVEMENT: AUV_KIND}
    behaviour = program(robot, frame=POOL, reserve=0.2)
    return BackendInput(behaviour, robot, DIVER, kinds, {}, {}, options, policies, areas, live)


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

    def stop(self, response):
        self.backend.stop(self.clock.now(), response)
        until(lambda: self.backend.finished(self.clock.now()))

    def pass_by(self, seconds):
        end = self.clock.now() + seconds
        until(lambda: self.clock.now() >= end)

    @property
    def undone(self):
        return self.backend.undone(self.clock.now())

    @property
    def fault(self):
        return self.backend.fault(self.clock.now())

    @property
    def truth(self):
        north, east, up = self.vehicle.autopilot.body.position
        return east, north, up


@contextmanager
def sub(*, located=False, areas=(), policies=(), parameters=None, **settings):
    """Give a simulated ArduSub that has no position, and its robot, ready."""
    port, clock, said = free_port(), RealClock(SPEEDUP), []
    live = Live(clock, lambda: None, said.append, "run-0", links={"naiad": f"udpin:127.0.0.1:{port}"})
    backend = ARDUSUB_MANUAL.connect(given(live=live, areas=areas, policies=policies))
    with SimulatedVehicle(port, Settings(kind="sub", **settings), speedup=SPEEDUP) as vehicle:
        vehicle.autopilot.located = located
        vehicle.autopilot.parameters.update(parameters or {})
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


def test_what_it_does_by_itself_is_told():
    with sub(parameters={"FS_PILOT_INPUT": 1.0}) as driven:
        assert "FS_LEAK_ENABLE = 1: water inside: warn" in driven.said
        (line,) = (each for each in driven.said if each.startswith("FS_PILOT_INPUT"))
        assert line.startswith(
            "FS_PILOT_INPUT = 1: no sticks any more: warn (beware: nothing stops its motors"
        )


@pytest.mark.parametrize("number", TOLD)
def test_nobody_is_driven_by_a_heading_or_a_depth_of_the_past(number):
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        command(driven.backend._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(number), -1.0)
        until(lambda: driven.fault)
        assert driven.fault.which == "POSITION_LOST"
        here = driven.truth
        driven.pass_by(5.0)
        assert driven.truth == pytest.approx(here, abs=0.2)
    assert not driven.vehicle.autopilot.armed


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
        driven.stop("NOTHING")
        assert driven.fault is None
        assert driven.vehicle.autopilot.armed


def test_a_link_that_is_lost_is_told():
    with sub() as driven:
        driven.begin("out")
        driven.vehicle.mute()
        until(lambda: driven.fault is not None)
        assert driven.fault.which == "LINK_LOST"


def test_a_vehicle_that_is_not_heard_stays_and_goes_on_when_it_is_heard_again_if_policies_bear_that():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        driven.vehicle.faults.fall_dumb()
        until(lambda: driven.fault)
        assert driven.backend.bear(driven.clock.now())
        assert driven.fault is None
        east = driven.truth[0]
        driven.pass_by(5.0)
        assert driven.truth[0] == pytest.approx(east, abs=0.2)
        driven.vehicle.faults.speak()
        until(lambda: driven.backend.reachable(driven.clock.now()))
        driven.finish()
        assert driven.truth[0] == pytest.approx(6.0, abs=1.5)


def test_a_battery_that_gets_low_is_told_and_it_comes_up_by_itself():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.vehicle.faults.set_battery(0.15)
        until(lambda: driven.fault)
        assert driven.fault.which == "BATTERY_LOW"
        driven.stop("SURFACE")
        assert driven.vehicle.autopilot.mode_name == "surface"
        assert driven.truth[2] >= -0.4
        assert not driven.undone
        assert not driven.backend.watched(driven.clock.now())
        assert "nobody knows where it is" in driven.backend.hindrance((), "out", driven.clock.now())


def test_water_inside_brings_it_up():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.vehicle.autopilot.say(4, "Leak Detected")
        until(lambda: driven.fault)
        assert (driven.fault.which, driven.fault.instead) == ("CRASHED", "SURFACE")
        driven.stop("SURFACE")
        assert driven.truth[2] >= -0.4


def test_what_a_policy_bears_for_a_while_is_told_after_that():
    with sub(policies=(Policy("BATTERY_LOW", "SURFACE", 20.0),)) as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.vehicle.faults.set_battery(0.15)
        begun = driven.clock.now()
        until(lambda: driven.fault)
        assert driven.clock.now() - begun >= 19.0


def test_an_autopilot_that_begins_anew_is_told_and_not_taken_for_a_pilot():
    with sub() as driven:
        driven.begin("out")
        driven.pass_by(15.0)
        driven.vehicle.faults.restart()
        until(lambda: driven.fault and driven.fault.which == "VEHICLE_RESTARTED")
        driven.stop("SURFACE")
        assert "its motors are off" in driven.undone
        assert not driven.vehicle.autopilot.armed


def test_it_holds_its_depth_where_nobody_knows_its_heading_any_more():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        command(driven.backend._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(TOLD[0]), -1.0)
        until(lambda: driven.fault)
        driven.stop("HOLD")
        assert driven.backend.watched(driven.clock.now())
        driven.pass_by(5.0)
        assert driven.vehicle.autopilot.armed
        assert driven.truth[2] < -1.0
        driven.stop("RETURN")
        assert "not known: it comes up" in driven.undone
        assert driven.truth[2] >= -0.4


@pytest.mark.parametrize("response", ["RETURN", "EMERGENCY_AREA"])
def test_it_goes_round_what_is_forbidden_and_comes_up_there(response):
    wall = Area("wall", AreaUse.FORBIDDEN, ((2.0, -0.4), (3.0, -0.4), (3.0, 0.4), (2.0, 0.4)))
    refuge = Area("bay", AreaUse.EMERGENCY, ((-9.0, -4.0), (-1.0, -4.0), (-1.0, 4.0), (-9.0, 4.0)))
    with sub(areas=(wall, refuge)) as driven:
        driven.begin("out")
        driven.finish()
        gone = len(driven.vehicle.autopilot.track)
        driven.stop(response)
        track = driven.vehicle.autopilot.track[gone:]
        within = [(east, north) for _, north, east, _ in track if 2.0 <= east <= 3.0]
        assert min(abs(north) for _, north in within) > 0.4
        assert (
            driven.truth[0] == pytest.approx(0.0, abs=1.5) if response == "RETURN" else driven.truth[0] < 0.0
        )
        assert driven.truth[2] >= -0.4
        assert not driven.undone


def test_it_comes_up_and_says_so_where_there_is_no_emergency_area():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.stop("EMERGENCY_AREA")
        assert driven.undone == "no way there is known: it comes up where it is"
        assert driven.truth[2] >= -0.4


def test_thrust_that_is_to_stop_has_stopped():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.stop("STOP_THRUST")
        assert not driven.vehicle.autopilot.armed


def test_a_vehicle_that_comes_up_can_be_told_to_stay():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.9)
        driven.backend.stop(driven.clock.now(), "SURFACE")
        until(lambda: driven.vehicle.autopilot.mode_name == "surface")
        driven.stop("HOLD")
        assert driven.vehicle.autopilot.mode_name == "alt_hold"
        assert driven.truth[2] < -0.4


def test_a_device_that_does_not_answer_is_told_while_the_vehicle_is_steered_on():
    with sub() as driven:
        driven.begin("out")
        driven.finish()
        driven.vehicle.faults.silence(mavlink.MAV_CMD_DO_SET_RELAY)
        driven.backend.act(Action(DEVICE_ACTION, "on", "lamp"), driven.clock.now())
        until(lambda: driven.fault)
        assert driven.fault.which == "DEVICE_SILENT"
        assert driven.vehicle.autopilot.armed
        assert driven.backend.bear(driven.clock.now())
        driven.finish()


def test_it_pauses_and_goes_on():
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[0] > 1.0)
        driven.backend.pause(driven.clock.now())
        until(lambda: driven.backend.paused(driven.clock.now()))
        here = driven.truth
        driven.pass_by(5.0)
        assert driven.truth == pytest.approx(here, abs=0.3)
        driven.backend.resume(driven.clock.now())
        driven.finish()
        assert driven.truth[0] == pytest.approx(6.0, abs=1.5)


def test_a_goal_that_is_not_reached_in_time_ends_the_dive():
    with sub() as driven:
        driven.begin("out")
        driven.backend._late_at = driven.clock.now()
        until(lambda: driven.fault)
        assert (driven.fault.which, driven.fault.instead) == ("NO_PROGRESS", "SURFACE")


def refused(url, *vehicles):
    """Return why a robot does not get ready; each vehicle is a port, and its settings."""
    clock = RealClock(SPEEDUP)
    live = Live(clock, lambda: None, print, "run-0", links={"naiad": url})
    backend = ARDUSUB_MANUAL.connect(given(live=live))
    with ExitStack() as stack:
        there = [stack.enter_context(SimulatedVehicle(*each, speedup=SPEEDUP)) for each in vehicles]
        backend.prepare(clock.now())
        until(lambda: backend.fault(clock.now()))
        assert not any(each.autopilot.armed for each in there)
        backend.close()
    return str(backend.fault(clock.now()))


def test_what_is_no_submarine_is_told_nothing():
    port = free_port()
    assert "no ArduSub" in refused(f"udpin:127.0.0.1:{port}", (port, Settings()))


def test_which_of_two_vehicles_is_meant_has_to_be_said():
    port = free_port()
    subs = [(port, Settings(kind="sub", system=number)) for number in (1, 2)]
    assert "say which, as URL@" in refused(f"udpin:127.0.0.1:{port}", *subs)


def test_a_vehicle_whose_motors_run_already_is_somebody_elses():
    port, clock = free_port(), RealClock(SPEEDUP)
    live = Live(clock, lambda: None, print, "run-0", links={"naiad": f"udpin:127.0.0.1:{port}"})
    backend = ARDUSUB_MANUAL.connect(given(live=live))
    with SimulatedVehicle(port, Settings(kind="sub"), speedup=SPEEDUP) as vehicle:
        vehicle.autopilot.arm()
        backend.prepare(clock.now())
        until(lambda: backend.fault(clock.now()))
        assert "motors run already" in backend.fault(clock.now()).reason
        backend.close()
        assert vehicle.autopilot.armed


def test_robots_may_share_a_port():
    port, clock = free_port(), RealClock(SPEEDUP)
    shared = {}
    backends = []
    for number in (1, 2):
        url = f"udpin:127.0.0.1:{port}@{number}"
        live = Live(clock, lambda: None, print, "run-0", links={"naiad": url}, shared=shared)
        backends.append(ARDUSUB_MANUAL.connect(given(live=live)))
    for backend in backends:
        backend.close()


def test_who_is_told_to_end_while_it_gets_ready_arms_nothing():
    port, clock = free_port(), RealClock(SPEEDUP)
    live = Live(clock, lambda: None, print, "run-0", links={"naiad": f"udpin:127.0.0.1:{port}"})
    backend = ARDUSUB_MANUAL.connect(given(live=live))
    with SimulatedVehicle(port, Settings(kind="sub", silent=frozenset({176})), speedup=SPEEDUP) as vehicle:
        backend.prepare(clock.now())
        until(lambda: any(kind == "COMMAND_LONG" for _, kind in vehicle.received))
        time.sleep(0.2)
        backend.close()
        assert not vehicle.autopilot.armed
        assert not any("Arming" in text for _, _, text in vehicle.autopilot.said)


@pytest.mark.parametrize("response", ["HOLD", "SURFACE"])
def test_it_stops_as_a_response_says(response):
    with sub() as driven:
        driven.begin("out")
        until(lambda: driven.truth[2] < -1.0)
        driven.stop(response)
        assert driven.truth[2] >= -0.4 if response == "SURFACE" else driven.truth[2] <= -1.0


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
