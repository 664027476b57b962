"""Which vehicles are driven by hand, and which programs; what is told before they move."""

import time
from contextlib import ExitStack

import pytest
from dives_by_hand import SPEEDUP, connected, dive, given, sub
from patience import until
from ports import free_port

from mmrs_core.behaviour.program import MoveTarget
from mmrs_core.contributions.vehicles import Live
from mmrs_core.errors import UnsupportedError
from mmrs_core.testing.programs import move
from mmrs_mavlink.plugin.manual import ARDUSUB_MANUAL
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.engine.clocks import RealClock

pytestmark = pytest.mark.real_time("vessels")


def test_what_it_does_by_itself_is_told():
    with sub(parameters={"FS_PILOT_INPUT": 1.0}) as driven:
        assert "FS_EKF_ACTION = 0: position lost: nothing" in driven.said
        (line,) = (each for each in driven.said if each.startswith("FS_PILOT_INPUT"))
        assert line.startswith(
            "FS_PILOT_INPUT = 1: no sticks any more: warn (warning: nothing stops its motors"
        )


def trouble(backend, clock):
    backend.look(clock.now())
    return backend.trouble


def refused(url, *vehicles):
    """Return why a robot does not get ready; each vehicle is a port, and its settings."""
    clock = RealClock(SPEEDUP)
    backend = connected(url, clock)
    with ExitStack() as stack:
        there = [stack.enter_context(SimulatedVehicle(*each, speedup=SPEEDUP)) for each in vehicles]
        backend.prepare(clock.now())
        until(lambda: trouble(backend, clock))
        assert not any(each.autopilot.armed for each in there)
        backend.close()
    return str(trouble(backend, clock))


def test_what_is_no_submarine_is_told_nothing():
    port = free_port()
    assert "not an ArduSub" in refused(f"udpin:127.0.0.1:{port}", (port, Settings()))


def test_which_of_two_vehicles_is_meant_has_to_be_said():
    port = free_port()
    subs = [(port, Settings(kind="sub", system=number)) for number in (1, 2)]
    assert "name one, as URL@" in refused(f"udpin:127.0.0.1:{port}", *subs)


def test_a_vehicle_whose_motors_run_already_is_somebody_elses():
    port, clock = free_port(), RealClock(SPEEDUP)
    backend = connected(f"udpin:127.0.0.1:{port}", clock)
    with SimulatedVehicle(port, Settings(kind="sub"), speedup=SPEEDUP) as vehicle:
        vehicle.autopilot.arm()
        backend.prepare(clock.now())
        until(lambda: trouble(backend, clock))
        assert "is armed already" in trouble(backend, clock).reason
        backend.close()
        assert vehicle.autopilot.armed


def test_robots_may_share_a_port():
    port, clock = free_port(), RealClock(SPEEDUP)
    shared = {}
    urls = (f"udpin:127.0.0.1:{port}@{number}" for number in (1, 2))
    backends = [connected(url, clock, shared=shared) for url in urls]
    for backend in backends:
        backend.close()


def test_who_is_told_to_end_while_it_gets_ready_arms_nothing():
    port, clock = free_port(), RealClock(SPEEDUP)
    backend = connected(f"udpin:127.0.0.1:{port}", clock)
    with SimulatedVehicle(port, Settings(kind="sub", silent=frozenset({176})), speedup=SPEEDUP) as vehicle:
        backend.prepare(clock.now())
        until(lambda: any(kind == "COMMAND_LONG" for _, kind in vehicle.received))
        time.sleep(0.2)
        backend.close()
        assert not vehicle.autopilot.armed
        assert not any("Arming" in text for _, _, text in vehicle.autopilot.said)


@pytest.mark.parametrize(
    ("moves", "why"),
    [
        ((dive("a", 5.0, 0.0, -1.0),), "leads 1 m above the surface"),
        ((dive("a", 5.0, 0.0, 1.0, target=MoveTarget((5.0, 0.0, -1.0), "a buoy", 1.0)),), "object 'a buoy'"),
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
