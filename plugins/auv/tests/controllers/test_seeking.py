"""A vehicle under a generated controller goes where its cameras tell that an object is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from mmrs_auv.testing import pool_sheet
from vessel_rig import Rig

from auv_vessel.body.surroundings import Obstacle, Surroundings
from auv_vessel.controllers import vehicle as module
from auv_vessel.controllers.vehicle import CanVehicle
from auv_vessel.decision.duties import FailureError, Stay
from auv_vessel.decision.helm import Helm
from auv_vessel.eyes import Detection, Detections, to_datagram
from auv_vessel.hosting import WireFault
from mmrs_mavlink.program import GoTo, Local, Object, Robot
from mmrs_mavlink.services.uploads import Uploads
from mmrs_mavlink.steps.responses import response_to
from mmrs_mavlink.vehicles.vehicle import Seeking
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import NO_PROGRESS, OBJECT_NOT_FOUND, OBSTACLE, Fault
from mmrs_runtime.records.blackbox import BlackBox

Making = Callable[..., tuple[CanVehicle, Rig]]
SHEET = pool_sheet(**{"search.radius": 1.0})
HOME = Local(0.0, 0.0, 0.0)
BUOY = Object("red buoy", Local(2.0, 0.0, -1.0), 3.0)


class RigClock(Clock):
    """Time of a rig, which goes on whenever somebody asks for it."""

    def __init__(self, rig: Rig, eyes: Detections | None, sees: tuple[float, float, float] | None) -> None:
        super().__init__()
        self._rig, self._eyes, self._sees = rig, eyes, sees

    def now(self) -> float:
        self._rig.run(0.1)
        if self._eyes is not None and self._sees is not None and self._rig.state.north > 0.8:
            north, east, depth = self._sees
            seen = Detection(self._rig.bus.now, "red buoy", 0.9, north, east, depth, "front")
            self._eyes.take(to_datagram(seen))
        return self._rig.bus.now


@pytest.fixture
def eyes() -> Iterator[Detections]:
    with Detections() as found:
        yield found


@pytest.fixture
def quiet() -> tuple[WireFault, ...]:
    """Return faults of the bus from the beginning on."""
    return ()


@pytest.fixture
def vehicle_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, quiet: tuple[WireFault, ...]
) -> Iterator[Making]:
    monkeypatch.setattr(module, "LOOK_SECONDS", 0.0)
    rig = Rig(SHEET, Surroundings(bottom=20.0, obstacles=(Obstacle(15.0, 0.0, 1.0),)))
    for fault in quiet:
        rig.bus.disturb(fault)
    rig.until(lambda: rig.state.trusted, 10.0)
    box = BlackBox(tmp_path / "box", "run", "naiad", lambda: rig.bus.now)

    def make(
        eyes: Detections | None, sees: tuple[float, float, float] | None = None, **more: float
    ) -> tuple[CanVehicle, Rig]:
        robot, clock = Robot("naiad", "naiad.ndjson", "sub", HOME, "a", ()), RigClock(rig, eyes, sees)
        made = CanVehicle(robot, SHEET, rig.craft, clock, lambda: None, box, eyes=eyes, **more)
        return made, rig

    yield make
    box.close()


def test_it_is_found_where_it_is_seen_on_the_way(vehicle_of, eyes):
    vehicle, rig = vehicle_of(eyes, (2.5, 1.0, 1.2))
    assert isinstance(vehicle, Seeking)
    assert vehicle.seek(GoTo(BUOY)) == Local(2.5, 1.0, -1.2)
    assert 0.8 < rig.state.north < 2.0
    assert vehicle.state().detected == {"red buoy"}


@pytest.mark.thorough
def test_it_is_looked_for_from_as_far_as_the_movement_stops(vehicle_of, eyes):
    vehicle, rig = vehicle_of(eyes)
    with pytest.raises(Fault, match=r"object 'red buoy' is not seen where it is expected") as missed:
        vehicle.seek(GoTo(BUOY, distance=1.5))
    assert rig.bus.now > 20.0
    assert missed.value.instead == "SURFACE"


@pytest.mark.thorough
def test_it_may_be_no_farther_from_where_it_is_expected_than_the_mission_allows(vehicle_of, eyes):
    vehicle, _ = vehicle_of(eyes, (7.0, 0.0, 1.0))
    with pytest.raises(Fault, match=r"is 5\.0 m from where it is expected"):
        vehicle.seek(GoTo(BUOY))


def test_nobody_seeks_what_is_expected_nowhere(vehicle_of, eyes):
    vehicle, _ = vehicle_of(eyes)
    with pytest.raises(Fault, match="nobody knows where it is expected"):
        vehicle.seek(GoTo(Object("red buoy")))


def test_without_cameras_somebody_else_says_where_it_is(vehicle_of):
    vehicle, _ = vehicle_of(None)
    assert vehicle.seek(GoTo(BUOY)) is None
    assert vehicle.state().detected == frozenset()


def test_a_thruster_that_fails_is_told(vehicle_of, capsys, tmp_path):
    vehicle, rig = vehicle_of(None)
    vehicle.prepare(Uploads())
    rig.vehicle.faults.dead.add(1)
    vehicle.go_to(Local(1.0, 0.0, -1.0), None, None, through=False)
    assert capsys.readouterr().err.splitlines() == ["'naiad': thruster 'T2' has failed"]
    assert (tmp_path / "box").read_text().count("thruster 'T2' has failed") == 1


def test_what_sonar_sees_too_near_is_an_obstacle(vehicle_of):
    vehicle, _ = vehicle_of(None, clearance=30.0)
    vehicle.prepare(Uploads())
    with pytest.raises(Fault, match=r"\d+\.\d m ahead") as seen:
        vehicle.go_to(Local(10.0, 0.0, -1.0), None, None, through=False)
    assert seen.value.event == OBSTACLE


def test_a_place_that_its_bus_cannot_say_makes_it_come_up(vehicle_of):
    vehicle, _ = vehicle_of(None)
    vehicle.prepare(Uploads())
    with pytest.raises(Fault, match=r"GoalPlace\.North") as missed:
        vehicle.go_to(Local(9e6, 0.0, -1.0), None, None, through=False)
    assert (missed.value.event, missed.value.instead) == (NO_PROGRESS, "SURFACE")


@pytest.mark.parametrize("quiet", [(WireFault(end=1.0, loss=1.0, ids=frozenset({0x207})),)])
def test_it_has_told_its_battery_when_it_begins(vehicle_of):
    vehicle, rig = vehicle_of(None)
    assert rig.state.charge is None
    vehicle.prepare(Uploads())
    assert vehicle.state().energy is not None


@pytest.mark.parametrize(("vehicle", "response"), [("sub", "SURFACE"), ("copter", "HOLD")])
def test_what_dives_comes_up_where_a_function_of_the_users_finds_nothing(vehicle, response):
    robot = Robot("naiad", "naiad.ndjson", vehicle, HOME, "a", ())
    assert response_to(OBJECT_NOT_FOUND, robot) == response


def test_what_cannot_be_gone_on_with_after_a_halt_has_failed(vehicle_of):
    class Gone(Stay):
        def begin(self, craft, now):
            if now > 1.0:
                raise FailureError(OBJECT_NOT_FOUND, "gone")

    _, rig = vehicle_of(None)
    helm = Helm(rig.craft)
    helm.begin(Gone(99.0), 0.0)
    helm.pause(0.5)
    helm.resume(2.0)
    assert (found := helm.failure(2.0)) is not None
    assert found.event == OBJECT_NOT_FOUND
