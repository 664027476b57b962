"""Rovers that steer like cars turn to their target within their turning radius before they set out."""

from dataclasses import replace
from math import cos, degrees, hypot, inf, radians, sin
from types import SimpleNamespace

import pytest
from flight_crew import manned, robot_of
from hypothesis import given
from hypothesis import strategies as st

from mmrs_mavlink.profiles.pacing import ASIDE_DEGREES, SHUNTS_WITHIN
from mmrs_mavlink.profiles.profile import Timing
from mmrs_mavlink.program import Geographic, Local, Travel
from mmrs_mavlink.services.uploads import Uploads
from mmrs_mavlink.vehicles.shunting import Shunting
from mmrs_mavlink.vehicles.steering import Advance, Steering
from mmrs_runtime.controllers.geodesy import bearing, distance, metres_per_degree

HOME = Geographic(42.37, 13.35, 0.0)
NORTH, EAST = metres_per_degree(HOME.latitude)
DRIVES = "SET_POSITION_TARGET_LOCAL_NED"
"""Of a rover with a home on the Earth these command speeds alone, its targets are geographic."""


def at(angle: float, metres: float) -> Geographic:
    """Return a place in a direction from home, degrees clockwise from north."""
    north, east = metres * cos(radians(angle)), metres * sin(radians(angle))
    return Geographic(HOME.latitude + north / NORTH, HOME.longitude + east / EAST, 0.0)


def sent_to(angle: float, metres: float, radius: float):
    """Return the rover and what it was sent, once it has driven from home, where it looks north."""
    robot = replace(robot_of(vehicle="rover"), travel=Travel(turning_radius=radius))
    with manned(robot, kind="rover", spins=radius == 0.0) as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        place = at(angle, metres)
        made.vehicle.go_to(place, 1.0, None, False)
        simulated = made.simulated
        kinds = [kind for _, kind in simulated.received]
        return made.away(place), kinds


class Car:
    """A car on a plane by the bicycle model, in place of a link, its telemetry and the control of its mode.

    It speeds up and slows down at 0.6 m/s², steers no narrower curve than its own, stops where it is not
    commanded for three seconds, and is asked five times a second, as positions are reported.
    """

    def __init__(self, radius: float, heading: float) -> None:
        self.radius, self.yaw, self.pace = radius, radians(heading), 0.0
        self.north = self.east = self.seconds = self.sent = self.farthest = 0.0
        self.wanted = (0.0, 0.0)
        self.clock = SimpleNamespace(now=lambda: self.seconds)
        self.profile, self.system, self.component = SimpleNamespace(still=0.3), 1, 1

    def send(self, message) -> None:
        self.wanted, self.sent = (message.vx, message.yaw_rate), self.seconds

    def wait(self, test, seconds: float):
        until = self.seconds + seconds
        while not (found := test()) and self.seconds < until:
            for _ in range(10):
                self._roll(0.02)
        return found

    def _roll(self, step: float) -> None:
        speed, rate = self.wanted if self.seconds < self.sent + 3.0 else (0.0, 0.0)
        self.pace += max(-0.6 * step, min(0.6 * step, speed - self.pace))
        narrowest = abs(self.pace) / self.radius
        self.yaw += max(-narrowest, min(narrowest, rate)) * step
        self.north += self.pace * cos(self.yaw) * step
        self.east += self.pace * sin(self.yaw) * step
        self.seconds += step
        self.farthest = max(self.farthest, hypot(self.north, self.east))

    def time(self) -> float:
        return self.seconds

    def here(self) -> Local:
        return Local(self.north, self.east, 0.0)

    def heading(self) -> float:
        return degrees(self.yaw) % 360.0

    def speed(self) -> float:
        return abs(self.pace)

    def check(self) -> None:
        """Nothing else has a say in where it goes."""


class Silent(Car):
    """One whose positions arrive no more once it has begun to move."""

    def time(self) -> float:
        return min(self.seconds, 1.0)

    def here(self) -> Local:
        return Local(0.0, 0.0, 0.0)

    def heading(self) -> float:
        return 0.0


def test_a_car_whose_positions_do_not_arrive_stops():
    car = Silent(radius=4.0, heading=0.0)
    shunting = Shunting(car, car, car, car.radius)
    shunting._drive_arc(Local(0.0, 6.0, 0.0), car.here(), 1.0)
    assert car.pace == 0.0
    assert 1.0 < car.farthest < 2.5


@given(
    radius=st.floats(0.8, 6.0),
    heading=st.floats(0.0, 360.0),
    angle=st.floats(0.0, 360.0),
    metres=st.floats(0.5, 60.0),
)
def test_a_car_looks_at_its_target_or_is_there_and_has_kept_within_its_turning_radius(
    radius, heading, angle, metres
):
    car = Car(radius, heading)
    place = Local(metres * cos(radians(angle)), metres * sin(radians(angle)), 0.0)
    Shunting(car, car, car, radius).face(place, 0.5, 1.0)
    aside = abs((bearing(car.here(), place) - car.heading() + 180.0) % 360.0 - 180.0)
    there = distance(car.here(), place)
    drives_there = there > SHUNTS_WITHIN * radius * sin(radians(min(90.0, aside)))
    assert aside <= ASIDE_DEGREES or there <= 0.5 or drives_there
    assert car.farthest <= radius
    assert car.speed() <= 0.1


@pytest.mark.parametrize(("angle", "metres"), [(180.0, 6.0), (-90.0, 1.0), (60.0, 3.0)])
def test_a_rover_turns_to_its_target_first(angle, metres):
    away, kinds = sent_to(angle, metres, 1.5)
    assert away <= 0.5
    assert DRIVES in kinds


def test_a_rover_is_sent_straight_to_a_target_that_one_curve_leads_to():
    away, kinds = sent_to(90.0, SHUNTS_WITHIN * 1.5 + 1.0, 1.5)
    assert away <= 0.5
    assert DRIVES not in kinds


@pytest.mark.parametrize(("speed", "shunts"), [(1.0, False), (2.0, True)])
def test_a_car_shunts_to_what_is_too_near_for_its_speed(speed, shunts):
    car = Car(1.2, 0.0)
    assert Shunting(car, car, car, car.radius).face(Local(0.0, 12.0, 0.0), 0.5, speed) == shunts


def test_a_rover_that_turns_on_its_own_is_sent_straight_there():
    away, kinds = sent_to(180.0, 6.0, 0.0)
    assert away <= 0.5
    assert DRIVES not in kinds


def test_a_rover_that_looks_there_already_is_sent_straight_there():
    away, kinds = sent_to(ASIDE_DEGREES - 3.0, 6.0, 1.5)
    assert away <= 0.5
    assert DRIVES not in kinds


@pytest.mark.parametrize(("radius", "is_sent"), [(1.5, False), (0.0, True)])
def test_a_rover_that_stands_at_its_target_is_sent_there_only_if_it_turns_on_its_own(radius, is_sent):
    away, kinds = sent_to(180.0, 0.4, radius)
    assert away <= 0.5
    assert ("SET_POSITION_TARGET_GLOBAL_INT" in kinds) == is_sent


class Passing(Car):
    """One that drives straight on until it is abreast of its target, and stays there, as an ArduRover may."""

    def __init__(self, place: Local) -> None:
        super().__init__(1.2, 0.0)
        self.place, self.nearest = place, inf
        self.profile = SimpleNamespace(still=0.3, timing=Timing())

    def aim(self, *_: object) -> None:
        self.wanted, self.sent, self.nearest = (0.5, 0.0), inf, distance(self.here(), self.place)

    def unheard(self) -> bool:
        return False

    def _roll(self, step: float) -> None:
        away = distance(self.here(), self.place)
        if self.sent == inf and away > self.nearest:
            self.wanted = (0.0, 0.0)
        self.nearest = min(self.nearest, away)
        super()._roll(step)


def test_a_rover_that_stops_beside_its_target_turns_to_it():
    place = Local(12.0, 0.9, 0.0)
    car = Passing(place)
    nothing = SimpleNamespace(arm=lambda: None, pace_next=lambda _: None, pace=lambda _, again: None)
    guidance = SimpleNamespace(aim=car.aim, has_settled=lambda _: None)
    control = SimpleNamespace(**vars(nothing), check=car.check, guidance=guidance)
    Steering(car, car, control, 0.5, car.radius).go_to(place, 1.0, None, False)
    assert distance(car.here(), place) <= 0.5
    assert car.seconds < 60.0


@pytest.mark.parametrize(
    ("moved", "steers", "ceased"), [(0.1, True, False), (0.1, False, True), (0.0, True, True)]
)
def test_a_car_that_creeps_up_to_a_target_beside_it_is_not_sent_there_again(moved, steers, ceased):
    at = {"north": 0.0, "seconds": 0.0}
    telemetry = SimpleNamespace(here=lambda: Local(at["north"], 0.0, 0.0), time=lambda: at["seconds"])
    advance = Advance(telemetry, Local(0.5, 0.5, 0.0))
    at.update(north=moved, seconds=1.0)
    assert advance.ceased(1.0, steers=steers) == ceased
