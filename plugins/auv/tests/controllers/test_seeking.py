"""A vehicle under a generated controller goes where its cameras tell that an object is."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from mmrs_auv.controllers.program_orders import ProgramOrders
from mmrs_auv.controllers.vehicle import CanVehicle
from sample_vessels import pool_sheet
from vessel_rig import Rig

from auv_vessel.body.surroundings import Obstacle, Surroundings
from auv_vessel.decision.duties import FailureError, Stay
from auv_vessel.decision.duty_control import DutyControl
from auv_vessel.eyes import Detection, Detections, to_datagram
from auv_vessel.hosting import WireFault
from mmrs_runtime.controllers.state import State
from mmrs_runtime.controllers.user_functions import where_expected
from mmrs_runtime.controllers.vocabulary import GoTo, Local, Object, Robot, Start, Step
from mmrs_runtime.faults import NO_PROGRESS, OBJECT_NOT_FOUND, OBSTACLE
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.vehicle import Fault

SHEET = pool_sheet(**{"search.radius": 1.0})
HOME = Local(0.0, 0.0, 0.0)
BUOY = Object("red buoy", Local(2.0, 0.0, -1.0), 3.0)


class Dive:
    """A vehicle in a rig, and what its cameras see once it is near."""

    def __init__(
        self, rig: Rig, box: BlackBox, eyes: Detections | None, sees: tuple[float, float, float] | None
    ) -> None:
        self.rig, self._eyes, self._sees = rig, eyes, sees
        self.said: list[str] = []
        robot = Robot("naiad", "naiad.ndjson", "sub", HOME, "a", (Step("a", Start()),))
        sight = None if eyes is None else eyes.place
        orders = ProgramOrders(robot, SHEET, {"red buoy": where_expected}, self.state, sight)
        self.vehicle = CanVehicle(
            "naiad",
            SHEET,
            rig.craft,
            orders,
            box=box,
            say=self.said.append,
            seen=eyes.places if eyes else dict,
        )

    def state(self) -> State:
        told = self.vehicle.state(self.rig.bus.now).own
        assert told is not None
        return told

    def do(self, movement: object) -> Fault | None:
        """Carry a movement out; return what goes wrong."""
        self.vehicle.do(Step("b", movement), self.rig.bus.now)
        while not self.vehicle.done:
            self.rig.run(0.1)
            if self._eyes is not None and self._sees is not None and self.rig.state.north > 0.8:
                seen = Detection(self.rig.bus.now, "red buoy", 0.9, *self._sees, "front")
                self._eyes.take(to_datagram(seen))
            self.vehicle.look(self.rig.bus.now)
            if self.vehicle.trouble is not None:
                return self.vehicle.trouble
            assert self.rig.bus.now < 600.0
        return None


Making = Callable[..., Dive]


@pytest.fixture
def eyes() -> Iterator[Detections]:
    with Detections() as found:
        yield found


@pytest.fixture
def quiet() -> tuple[WireFault, ...]:
    """Return faults of the bus from the beginning on."""
    return ()


@pytest.fixture
def dive(tmp_path: Path, quiet: tuple[WireFault, ...]) -> Iterator[Making]:
    rig = Rig(SHEET, Surroundings(bottom=20.0, obstacles=(Obstacle(15.0, 0.0, 1.0),)))
    for fault in quiet:
        rig.bus.disturb(fault)
    rig.until(lambda: rig.state.trusted, 10.0)
    box = BlackBox(tmp_path / "box", "run", "naiad", lambda: rig.bus.now)
    yield lambda eyes=None, sees=None: Dive(rig, box, eyes, sees)
    box.close()


def test_it_is_found_where_it_is_seen_on_the_way(dive, eyes):
    found = dive(eyes, (2.5, 1.0, 1.2))
    assert found.do(GoTo(BUOY)) is None
    state = found.state()
    assert (state.place.north, state.place.east) == pytest.approx((2.5, 1.0), abs=0.5)
    assert state.detected == {"red buoy"}


@pytest.mark.thorough
def test_it_is_looked_for_from_as_far_as_the_movement_stops(dive, eyes):
    found = dive(eyes)
    missed = found.do(GoTo(BUOY, distance=1.5))
    assert "object 'red buoy' is not seen where it is expected" in missed.reason
    assert found.rig.bus.now > 20.0
    assert missed.instead == "SURFACE"


@pytest.mark.thorough
def test_it_may_be_no_farther_from_where_it_is_expected_than_the_mission_allows(dive, eyes):
    missed = dive(eyes, (7.0, 0.0, 1.0)).do(GoTo(BUOY))
    assert "is 5.0 m from where it is expected" in missed.reason


def test_nobody_seeks_what_is_expected_nowhere(dive, eyes):
    assert "unknown expected position" in dive(eyes).do(GoTo(Object("red buoy"))).reason


def test_without_cameras_a_function_of_the_users_says_where_it_is(dive):
    found = dive()
    assert found.do(GoTo(BUOY)) is None
    assert found.state().place.north == pytest.approx(2.0, abs=0.5)
    assert found.state().detected == frozenset()


def test_what_dives_comes_up_where_a_function_of_the_users_finds_nothing(dive):
    missed = dive().do(GoTo(Object("red buoy")))
    assert (missed.which, missed.instead) == (OBJECT_NOT_FOUND, "SURFACE")


def test_a_thruster_that_fails_is_told(dive, tmp_path):
    found = dive()
    found.rig.vehicle.faults.dead.add(1)
    assert found.do(GoTo(Local(1.0, 0.0, -1.0))) is None
    assert found.said == ["thruster 'T2' has failed"]
    assert (tmp_path / "box").read_text().count("thruster 'T2' has failed") == 1


def test_what_sonar_sees_too_near_is_an_obstacle(tmp_path):
    rig = Rig(SHEET, Surroundings(bottom=20.0, obstacles=(Obstacle(15.0, 0.0, 1.0),)))
    rig.until(lambda: rig.state.trusted, 10.0)
    robot = Robot("naiad", "naiad.ndjson", "sub", HOME, "a", ())
    place = State(0.0, HOME, 0.0, 0.0, None)
    vehicle = CanVehicle(
        "naiad", SHEET, rig.craft, ProgramOrders(robot, SHEET, {}, lambda: place), clearance=30.0
    )
    vehicle.do(Step("b", GoTo(Local(10.0, 0.0, -1.0))), rig.bus.now)
    while vehicle.trouble is None:
        rig.run(0.1)
        vehicle.look(rig.bus.now)
        assert rig.bus.now < 100.0
    assert vehicle.trouble.which == OBSTACLE
    assert vehicle.trouble.reason.endswith(" m ahead")


def test_a_place_that_its_bus_cannot_say_makes_it_come_up(dive):
    missed = dive().do(GoTo(Local(9e6, 0.0, -1.0)))
    assert "GoalPlace.North" in missed.reason
    assert (missed.which, missed.instead) == (NO_PROGRESS, "SURFACE")


def test_it_goes_back_the_way_it_came(dive):
    found = dive()
    for north, east in ((2.0, 0.0), (2.0, 2.0)):
        assert found.do(GoTo(Local(north, east, -1.0))) is None
    found.vehicle.respond("RETURN", found.rig.bus.now)
    corner = []
    while not found.vehicle.done:
        found.rig.run(0.1)
        found.vehicle.look(found.rig.bus.now)
        corner.append((found.rig.state.north, found.rig.state.east))
        assert found.rig.bus.now < 600.0
    assert min(max(abs(north - 2.0), abs(east)) for north, east in corner) < 0.6
    assert found.rig.state.depth < 0.5
    assert (found.rig.state.north, found.rig.state.east) == pytest.approx((0.0, 0.0), abs=0.8)


def test_what_cannot_be_gone_on_with_after_a_halt_has_failed(dive):
    class Gone(Stay):
        def begin(self, craft, now):
            if now > 1.0:
                raise FailureError(OBJECT_NOT_FOUND, "gone")

    helm = DutyControl(dive().rig.craft)
    helm.begin(Gone(99.0), 0.0)
    helm.pause(0.5)
    helm.resume(2.0)
    assert (found := helm.failure(2.0)) is not None
    assert found.event == OBJECT_NOT_FOUND
