"""The backend mavlink by itself, with a simulated vehicle: what it tells, and what it watches for."""

import json
from contextlib import contextmanager
from dataclasses import replace

import pytest
from flight_crew import SPEEDUP
from patience import until
from ports import free_port

from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.scene import Frame, Policy
from mmrs_core.testing.programs import move
from mmrs_core.testing.small_programs import go, program, robot, robot_type
from mmrs_mavlink.plugin.backend import MAVLINK
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.engine.clocks import RealClock

pytestmark = pytest.mark.real_time("runs")

EARTH = Frame("EPSG:4326", 42.37, 13.35, 720.0, "MSL")
ROVER = robot(
    "r",
    [
        go("out", (10.0, 0.0, 0.0)),
        go("back", (0.0, 0.0, 0.0)),
        move("charge", "Recharge", duration=2.0),
        go("far", (150.0, 0.0, 0.0)),
    ],
)


class Driven:
    """A robot's backend that is ready, and its simulated vehicle."""

    def __init__(self, backend, clock, vehicle):
        self.backend, self.clock, self.vehicle = backend, clock, vehicle

    @property
    def state(self):
        return self.backend.state(self.clock.now())

    @property
    def fault(self):
        self.backend.look(self.clock.now())
        return self.backend.trouble.which if self.backend.trouble is not None else ""

    def begin(self, id):
        self.backend.do(next(each for each in ROVER.moves if each.id == id), self.clock.now())

    def do(self, *ids):
        for id in ids:
            self.begin(id)
            self.finish()

    def finish(self):
        until(lambda: self.fault or self.backend.done)
        assert self.fault == ""


@contextmanager
def rover(*policies, folder=None, recharge=60.0, **settings):
    """Give a rover that is ready."""
    port = free_port()
    clock, links = RealClock(SPEEDUP), {"r": f"udpin:127.0.0.1:{port}"}
    given = VehicleInput(
        replace(program(ROVER), frame=EARTH),
        {robot_type().name: robot_type()},
        {},
        {},
        robot=replace(ROVER, policies=policies),
        type=robot_type(),
        live=Live(clock, lambda: None, lambda line: None, "run-0", folder, links=links),
    )
    with SimulatedVehicle(
        port, Settings(kind="rover", recharge=recharge, **settings), speedup=SPEEDUP
    ) as vehicle:
        driven = Driven(MAVLINK.connect(given), clock, vehicle)
        try:
            driven.backend.prepare(clock.now())
            driven.finish()
            yield driven
        finally:
            driven.backend.close()


def test_a_robots_state_holds_the_wind_that_conditions_ask_for():
    with rover(wind=(6.0, 90.0)) as driven:
        until(lambda: driven.state.wind is not None)
        assert abs(driven.state.wind - 6.0) < 1.0


def test_a_robots_state_holds_what_its_vehicle_has_detected():
    with rover(values={"fire": lambda seconds: 1.0}) as driven:
        until(lambda: driven.state.detected == {"fire"})


def test_a_robot_without_a_take_off_is_watched_after_it_was_charged():
    with rover(Policy("OBSTACLE", "HOLD")) as driven:
        driven.do("out", "back", "charge")
        driven.begin("far")
        until(lambda: driven.state.position[0] > 20.0)
        driven.vehicle.faults.begin("obstacle", 3.0)
        until(lambda: driven.fault == "OBSTACLE")


def test_a_battery_that_does_not_get_full_is_borne_and_the_robot_watched_on():
    with rover(Policy("BATTERY_LOW", "CONTINUE"), Policy("OBSTACLE", "HOLD"), recharge=0.0) as driven:
        driven.do("out", "back")
        driven.vehicle.faults.begin("battery", 0.5)
        driven.begin("charge")
        until(lambda: driven.fault == "BATTERY_LOW")
        assert driven.backend.bear(driven.clock.now())
        driven.finish()
        driven.begin("far")
        until(lambda: driven.state.position[0] > 20.0)
        assert not driven.fault
        driven.vehicle.faults.begin("stick", "manual")
        until(lambda: driven.fault == "TAKEN_OVER")


def test_a_link_that_has_ended_cannot_be_borne():
    with rover(Policy("LINK_LOST", "CONTINUE")) as driven:
        driven.begin("out")
        driven.backend._with.radio.link.learns("the port has ended")
        until(lambda: driven.fault == "LINK_LOST")
        assert not driven.backend.bear(driven.clock.now())


def test_a_black_box_begins_with_the_vehicle_and_the_software_as_a_controllers_does(tmp_path):
    with rover(folder=tmp_path, system=7):
        pass
    (box,) = tmp_path.glob("*.blackbox.ndjson")
    lines = map(json.loads, box.read_text().splitlines())
    start = next(line for line in lines if line["kind"] == "start")
    assert (start["vehicle"], start["firmware"], start["system"]) == ("rover", "ARDUPILOTMEGA", 7)
    assert set(start["versions"]) == {"python", "pymavlink"}


PATIENT = Policy("LINK_LOST", "RETURN", 60.0)


def start_anew(driven):
    """Have its autopilot start anew once it is old enough for that to be seen.

    It reports its time again half a real second later at the earliest, when its messages are requested again;
    and a time that is less than a real second behind may be late on its way.
    """
    until(lambda: driven.vehicle.autopilot.uptime > 3.0 * SPEEDUP)
    driven.vehicle.faults.begin("restart")


def test_a_vehicle_that_starts_anew_before_it_sets_out_is_set_up_again_where_the_robot_carries_on():
    with rover(Policy("VEHICLE_RESTARTED", "CONTINUE"), PATIENT) as driven:
        start_anew(driven)
        until(lambda: driven.backend._watch.restarted)
        driven.do("out")
        assert not driven.backend._watch.restarted


def test_a_vehicle_that_starts_anew_on_its_way_is_told_of_where_the_robot_was_to_carry_on():
    with rover(Policy("VEHICLE_RESTARTED", "CONTINUE"), PATIENT) as driven:
        driven.do("out", "back", "charge")
        driven.begin("far")
        until(lambda: driven.state.position[0] > 20.0)
        start_anew(driven)
        until(lambda: driven.fault == "VEHICLE_RESTARTED")
        found = driven.backend.trouble
        assert found.instead == "HOLD"
        assert "disarmed: its program cannot be continued" in found.reason
