"""A vehicle that exists only here: its body, its drives and its whole control layer on a rehearsed bus."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.util import find_spec
from math import cos, dist, hypot, radians, sin, tan
from random import Random

from auv_vessel.api import Craft
from auv_vessel.body.surroundings import PATH, Surroundings, Thing
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.eyes import Detections, to_datagram
from auv_vessel.hosting import Rehearsal
from auv_vessel.instruments import instruments_of
from auv_vessel.movement.movement import Movement
from auv_vessel.sheet import Sheet, Vector
from auv_vessel.wire.codec import Codec
from mmrs_auv.backend.options import Rehearsing, rehearsing
from mmrs_auv.backend.orders import BehaviourOrders
from mmrs_auv.controllers.orders import Waters
from mmrs_auv.controllers.vehicle import CanVehicle
from mmrs_auv.sheets import sheet_of_robot
from mmrs_core.contributions.execution import Fault, Sample
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import UnsupportedError

PACE = 0.2
"""Simulated seconds between two looks at a vehicle."""

TICK = 2e-6
"""Simulated seconds by which the clocks of run and bus may differ; buses count microseconds."""

SAMPLE = 1.0
"""Simulated seconds between two points of a vehicle's way."""

LONGEST_RESPONSE = 1800.0
"""Simulated seconds after which a vehicle counts as stopped, wherever it is."""

PICTURES = 0.5
"""Simulated seconds from one look of simulated cameras to the next."""

LONGEST_SILENCE = 60.0
"""Simulated seconds of silence after which a vehicle is left alone; its own parts bring it up."""

BELOW = 5.0
"""Metres from the deepest place of a program to the bottom, where its depth is unknown."""

FARTHEST_SEEN, WIDTH, ABOVE = 6.0, 50.0, 3.0
"""What simulated cameras see: metres ahead, degrees to each side of the bow, metres below."""


class Stage:
    """A vehicle and its control layer in simulated time.

    Attributes:
        vehicle: simulated; faults may be set on it.
        craft: what the decision centre commands.
        rehearsal: hosts all of them.
    """

    def __init__(self, sheet: Sheet, surroundings: Surroundings, options: Rehearsing) -> None:
        """Put the vehicle into the water."""
        place = _put_in(sheet, options)
        self.surroundings = surroundings
        self.vehicle = Vehicle(
            sheet, Codec(sheet), surroundings, options.seed, place=place, heading=options.heading
        )
        self.craft = Craft(sheet, Codec(sheet))
        self.sheet = sheet
        parts = (Sensors(sheet, Codec(sheet)), Actuators(sheet, Codec(sheet)), Movement(sheet, Codec(sheet)))
        self.rehearsal = Rehearsal([self.vehicle, *parts, self.craft])
        self._cameras = Cameras(self, options.seed) if options.objects == "cameras" else None

    def advance(self, time: float) -> None:
        """Let time go by until then."""
        left = time - self.rehearsal.now
        if left > 0.0:
            self.rehearsal.run(left)
        if self._cameras is not None:
            self._cameras.look()

    def sees(self, name: str) -> Vector | None:
        """Return where an object is, if cameras see it now, as far as the vehicle knows its own place."""
        if self._cameras is not None:
            return self._cameras.found.place(name)
        truth, state = self.vehicle.truth, self.craft.state()
        for thing in self.surroundings.things:
            if thing.name == name and _is_in_sight(
                thing, truth.north, truth.east, truth.depth, truth.heading
            ):
                return (
                    state.north + thing.north - truth.north,
                    state.east + thing.east - truth.east,
                    state.depth + thing.depth - truth.depth,
                )
        return None

    def struck(self) -> Fault | None:
        """Return that the hull, taken for an upright cylinder of its width, touches an obstacle."""
        truth, half = self.vehicle.truth, self.sheet.height / 2.0
        for each in self.surroundings.obstacles:
            beside = dist((truth.north, truth.east), (each.north, each.east))
            level = each.top - half < truth.depth < each.bottom + half
            if level and beside < each.radius + self.sheet.width / 2.0:
                place = f"{each.north:.1f} m north, {each.east:.1f} m east"
                return Fault("CRASHED", f"it has hit the obstacle {place} of the origin", "SURFACE")
        return None

    def in_sight(self) -> dict[str, Vector]:
        """Return what cameras see now, and where, as far as the vehicle knows its own place."""
        found = ((each.name, self.sees(each.name)) for each in self.surroundings.things)
        return {name: place for name, place in found if place is not None}


class Cameras:
    """Pictures of the simulated water, and what is found in them.

    Attributes:
        found: the detections.
    """

    def __init__(self, stage: Stage, seed: int) -> None:
        """Open its eyes.

        Raises:
            UnsupportedError: there is no OpenCV.
        """
        if find_spec("cv2") is None:
            raise UnsupportedError("option 'objects': cameras need OpenCV; pip install 'mmrs-auv[vision]'")
        from auv_vision.node import Eyes

        self._stage, self._eyes = stage, Eyes(stage.sheet, stage.surroundings, seed)
        self.found = Detections(clock=lambda: stage.rehearsal.now)
        self.found.close()  # nothing comes over the network here
        self._due = 0.0

    def look(self) -> None:
        """Take pictures, if it is time to."""
        from auv_vision.cameras import Pose

        now = self._stage.rehearsal.now
        if now < self._due:
            return
        self._due = now + PICTURES
        truth, state = self._stage.vehicle.truth, self._stage.craft.state()
        pose = Pose(truth.north, truth.east, truth.depth, truth.roll, truth.pitch, truth.heading)
        believed = Pose(state.north, state.east, state.depth, state.roll, state.pitch, state.heading)
        for each in self._eyes.look(now, pose, believed):
            self.found.take(to_datagram(each))


def _is_in_sight(thing: Thing, north: float, east: float, depth: float, heading: float) -> bool:
    if dist((thing.north, thing.east, thing.depth), (north, east, depth)) > FARTHEST_SEEN:
        return False
    ahead, bow = (thing.north - north, thing.east - east), radians(heading)
    along, across = ahead[0] * cos(bow) + ahead[1] * sin(bow), ahead[1] * cos(bow) - ahead[0] * sin(bow)
    if thing.kind == PATH:
        return hypot(along, across) < ABOVE
    return along > 0.0 and abs(across) <= along * tan(radians(WIDTH))


def _put_in(sheet: Sheet, options: Rehearsing) -> Vector:
    """Return where the vehicle truly is at first: near its reported position."""
    random, sigma = Random(options.seed), instruments_of(sheet).start_noise if options.noise else 0.0
    north, east, depth = sheet.home
    return (north + random.gauss(0.0, sigma), east + random.gauss(0.0, sigma), depth)


class RehearsedRobot(CanVehicle):
    """A simulated vehicle; it advances as the run's time does.

    Attributes:
        notes: what was taken for granted.
        stage: the vehicle and its control layer.
    """

    def __init__(self, given: VehicleInput, sheet: Sheet, stage: Stage, options: Rehearsing) -> None:
        """Begin at home."""
        self.stage = stage
        self.notes: list[str] = []
        self._samples: list[Sample] = []
        self._struck: Fault | None = None
        sight = stage.sees if options.objects in ("seen", "cameras") else None
        orders = BehaviourOrders(given, sheet, Waters(given.program.frame.surface), sight)
        orders.charged = self._charge
        super().__init__(
            given.robot.id, sheet, stage.craft, orders, seen=stage.in_sight, clearance=options.clearance
        )
        if sight is None:
            self.notes += [f"move '{id}': object taken to be where it is expected" for id in _objects(given)]

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a grounded movement or action."""
        self._look(now)
        super().do(order, now, through=through)

    def look(self, now: float) -> float:
        """See how it is; return when to look again."""
        super().look(now)
        return now + PACE

    def respond(self, response: str, now: float) -> None:
        """Carry out a response to its end: in simulated time it is not polled."""
        if self._response == response:
            return
        super().respond(response, now)
        until = self.stage.rehearsal.now + LONGEST_RESPONSE
        while not self._helm.done(self._now) and self.stage.rehearsal.now < until:
            if self.stage.craft.state().silent > LONGEST_SILENCE:
                return
            self._look(self._now + PACE)

    def track(self) -> tuple[Sample, ...]:
        """Return the way that the vehicle has come, as it truly was."""
        return tuple(self._samples)

    def _wrong(self, now: float) -> Fault | None:
        """Return what went wrong; a vehicle that has hit something has crashed."""
        found = super()._wrong(now)
        return found if found is not None or self._response else self._struck

    def _look(self, now: float) -> None:
        while now - self.stage.rehearsal.now > TICK:
            self.stage.advance(min(now, self.stage.rehearsal.now + SAMPLE))
            self._sample()
            self._struck = self._struck or self.stage.struck()
        super()._look(now)

    def _sample(self) -> None:
        truth = self.stage.vehicle.truth
        east, north, up = self._orders.waters.above((truth.north, truth.east, truth.depth))
        time = self.stage.rehearsal.now
        if not self._samples or time >= self._samples[-1].time + SAMPLE:
            self._samples.append(Sample(time, east, north, up, self.stage.vehicle.charge))

    def _charge(self) -> None:
        self.stage.vehicle.charge = self._sheet.battery


def rehearsed(given: VehicleInput) -> RehearsedRobot:
    """Return a simulated vehicle at its home.

    Raises:
        UnsupportedError: its type lacks data, an option is unknown, or it cannot do what its program holds.
    """
    options = rehearsing(given.options)
    sheet = sheet_of_robot(given.program, given.robot, given.type, given.environment)
    north, east, depth = sheet.home
    sheet = replace(sheet, home=(north + options.start[0], east + options.start[1], depth))
    return RehearsedRobot(given, sheet, Stage(sheet, _surroundings(given, options), options), options)


def _surroundings(given: VehicleInput, options: Rehearsing) -> Surroundings:
    if (around := options.surroundings) is not None:
        return around if options.current is None else replace(around, current=options.current)
    current = options.current if options.current is not None else _current(given.environment)
    return Surroundings(
        current=current, bottom=options.bottom or _deepest(given) + BELOW, noise=options.noise
    )


def _deepest(given: VehicleInput) -> float:
    surface = given.program.frame.surface
    targets = [move.target.position for move in given.robot.moves if move.target is not None]
    return max((surface - place[2] for place in targets if place is not None), default=0.0)


def _current(environment: Mapping[str, float]) -> tuple[float, float]:
    """Return the context's current; it names the direction that water flows to."""
    speed = environment.get("currentSpeed", 0.0)
    towards = radians(environment.get("currentDirection", 0.0))
    return (speed * cos(towards), speed * sin(towards))


def _objects(given: VehicleInput) -> Sequence[str]:
    return [
        move.id
        for move in given.robot.moves
        if move.target is not None and move.target.description is not None
    ]
