"""Which vehicle moves the robots of a run is chosen by name, the core's own like any other."""

from dataclasses import dataclass, replace

import pytest

from mmrs_core import pipeline
from mmrs_core.contributions.execution import RobotState
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.errors import UsageError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.conformance import VehicleConformance
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, program, robot, robot_type
from mmrs_runtime.vehicle import Vehicle

SECONDS = 7.0
BEHAVIOUR = program(robot("r", [go("there", (30.0, 0.0, 0.0))]))
PLACE = pipeline.BehaviourContext({ROBOT_TYPE: robot_type()})


class Jumper(Vehicle):
    """A robot that is where a move leads to after so many seconds, however far that is."""

    def __init__(self, given):
        unknown = sorted(set(given.options) - {"seconds"})
        if unknown:
            raise UsageError(f"option '{unknown[0]}': the jumper has none of that name")
        self._seconds = float(given.options.get("seconds", SECONDS))
        self._at, self._to, self._end = given.robot.home, given.robot.home, 0.0

    def do(self, order, now, *, through=False):
        self._at = self.state(now).position
        self._to = order.target.position if order.target else self._at
        self._end = now + (self._seconds if order.target or "duration" in order.attributes else 0.0)

    def look(self, now):
        self.done = now >= self._end
        return self._end

    def wait(self, now):
        self._end = float("inf")

    def state(self, now):
        return RobotState(now, self._to if now >= self._end else self._at, 0.0, 0.0, None)

    def respond(self, response, now):
        if now < self._end:
            self._to, self._end = self._at, now


JUMPER = VehicleFactory("jumper", "Robots that jump", Jumper, simulated=True)


@dataclass(frozen=True)
class Jumping:
    """A plug-in that contributes vehicles."""

    vehicle: VehicleFactory = JUMPER

    @hookimpl
    def mmrs_vehicles(self):
        return (self.vehicle,)


def simulated(plugin, **options):
    contributions = load_plugins(only_core=True, extra={"jumping": plugin}).contributions
    return pipeline.simulate(BEHAVIOUR, PLACE, contributions, **options)


class TestJumper(VehicleConformance):
    plugin = Jumping()


class Drifter(Jumper):
    """A robot that drifts while it waits, and tells where it was last heard of, as real ones do."""

    _now = 0.0

    def state(self, now):
        self._now = max(self._now, now)
        return RobotState(self._now, (0.001 * self._now, 0.0, 0.0), 0.0, 0.0, None)


def test_a_vehicle_that_drifts_while_it_waits_is_found():
    drifting = replace(JUMPER, connect=Drifter)
    kit = type("Drifting", (VehicleConformance,), {"plugin": Jumping(drifting)})()
    with pytest.raises(AssertionError):
        kit.test_waiting_ends_never_and_moves_nothing(drifting)


def test_a_plugins_vehicle_is_taken_by_its_name():
    assert simulated(Jumping(), backend="jumper").ending.time == SECONDS


def test_its_options_reach_it():
    assert simulated(Jumping(), backend="jumper", options={"seconds": "3"}).ending.time == 3.0


def test_an_option_that_it_does_not_know_is_refused_by_name():
    with pytest.raises(UsageError, match="option 'metres'"):
        simulated(Jumping(), backend="jumper", options={"metres": "3"})


def test_a_vehicle_that_tells_no_way_leaves_none():
    assert simulated(Jumping(), backend="jumper").tracks == {}


def test_without_a_name_the_core_simulates():
    run = simulated(Jumping())
    assert run.ending.time != SECONDS
    assert [sample.position for sample in run.tracks["r"]][-1] == (30.0, 0.0, 0.0)


def test_a_name_that_nobody_contributed_is_refused_with_the_nearest():
    with pytest.raises(UsageError, match=r"'jumpr': unknown; there are jumper, simulation; .*jumper"):
        simulated(Jumping(), backend="jumpr")


def test_a_backend_that_drives_robots_is_not_taken_for_a_simulation():
    real = Jumping(replace(JUMPER, simulated=False))
    with pytest.raises(UsageError, match="'jumper': runs in real time"):
        simulated(real, backend="jumper")
