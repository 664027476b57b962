"""What the words of a program are to the vehicle that carries them out, and the way that it has come."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise

from auv_vessel.api import Craft
from auv_vessel.decision.duties import (
    Charge,
    Duty,
    Face,
    FailureError,
    Finish,
    Ready,
    Seek,
    Sight,
    Stay,
    Surface,
    Travel,
    Use,
)
from auv_vessel.decision.duties import Look as Bearing
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.sheet import Sheet, Vector
from mmrs_auv.controllers.orders import NoWayError, Waters
from mmrs_auv.controllers.vocabulary import Operate
from mmrs_runtime.controllers.geodesy import distance_to_leg, ends_of
from mmrs_runtime.controllers.return_paths import steps_back
from mmrs_runtime.controllers.state import State
from mmrs_runtime.controllers.user_functions import Finding, Locator
from mmrs_runtime.controllers.vocabulary import (
    GoTo,
    Hold,
    Land,
    Local,
    Look,
    NoEffect,
    Object,
    Place,
    Recharge,
    Report,
    Robot,
    Skip,
    Start,
    Step,
    Stop,
    Turn,
)
from mmrs_runtime.faults import DEVICE_SILENT, OBJECT_NOT_FOUND, FaultError
from mmrs_runtime.policies import AFTER, Policy, patience
from mmrs_runtime.vehicle import Fault

OFF_ITS_WAY = 5.0
"""Metres that a vehicle may be from the path of its program when it is to resume."""


class ProgramOrders:
    """Knows what a program's steps and actions are to its vehicle, and by which way this can go back."""

    def __init__(
        self,
        robot: Robot,
        sheet: Sheet,
        locators: Mapping[str, Locator],
        state: Callable[[], State],
        sight: Sight | None = None,
    ) -> None:
        """Take what orders are made of.

        Args:
            robot: whose program it is.
            sheet: data of its vehicle.
            locators: what finds objects, by description.
            state: returns what locators are asked with.
            sight: where cameras detect objects; None: objects are not detected.
        """
        self.policies: Sequence[Policy] = robot.policies
        self.reserve = robot.reserve
        self.home = sheet.home
        self.waters = Waters(0.0, sheet.home[0], sheet.home[1])
        self._robot, self._sheet, self._locators, self._state = robot, sheet, locators, state
        self._sight = sight
        self._steps = {step.move: step for step in robot.steps}
        self._track: list[tuple[str, Place]] = []
        self._reported: dict[str, Vector] = {}
        self._seen: dict[Object, Place] = {}

    def duty(self, order: object, here: Vector, *, through: bool) -> Duty | Fault:
        """Return what a step's movement, or an action, is; a fault where no device does it."""
        if isinstance(order, Step):
            return self._movement(order, here, through=through)
        if isinstance(order, Operate):
            return self._use(order)
        assert isinstance(order, Report | NoEffect)
        return Stay(0.0)

    def reports(self, order: object) -> Mapping[str, object] | None:
        """Return what an action reports, with its `name`; None: it does not report."""
        return {"name": order.name, **dict(order.pairs)} if isinstance(order, Report) else None

    def learn(self, name: str, place: Vector) -> None:
        """Take note of where another robot has detected an object."""
        self._reported[name] = place

    def escape(self, response: str, here: Vector) -> Duty:
        """Return the robot's track, back to where it surfaces; it stays where it knows none."""
        above = self._above(here)
        places = [place for _, place in steps_back(self._robot, response, self._track, above)]
        return Travel([self._below(each) for each in places], self._robot.cruise or 0.0)

    def back(self, passed: Sequence[str], begun: str, here: Vector) -> Duty:
        """Return the path to where the last of the moves ended, along the robot's track.

        Raises:
            NoWayError: the vehicle is not on its path.
        """
        came = list(self._places(self._robot.home, _dive_of(self._steps, passed)))
        start, above = self._robot.home, self._above(here)
        ahead = [*self._places(came[-1][1] if came else start, [begun])] if begun else []
        way = [start, *(place for _, place in (*came, *ahead))]
        gaps = [distance_to_leg(above, *leg) for leg in pairwise(way)] or [0.0]
        leg = max(range(len(gaps)), key=lambda each: (-round(gaps[each], 1), each))
        if gaps[leg] > OFF_ITS_WAY:
            raise NoWayError(f"it is {gaps[leg]:.0f} m off its path: bring it back to it before it resumes")
        left = came[leg:] if leg < len(came) else [*reversed(ahead[: leg - len(came)]), *came[-1:]]
        self._track = came
        return Travel([self._below(place) for _, place in left], self._robot.cruise or 0.0)

    def _movement(self, step: Step, here: Vector, *, through: bool) -> Duty:
        movement = step.movement
        if isinstance(movement, GoTo):
            return self._go(step.move, movement, here, through=through)
        if isinstance(movement, Turn):
            return self._turn(movement.look)
        if isinstance(movement, Hold):
            return Stay(movement.seconds)
        if isinstance(movement, Recharge):
            self._track.clear()
            return Charge(movement.seconds)
        if isinstance(movement, Land):
            return Surface(float(abilities_of(self._sheet).afloat), floats=self._floats)
        if isinstance(movement, Stop):
            return Finish(floats=self._floats)
        assert isinstance(movement, Start | Skip)
        return Ready() if isinstance(movement, Start) else Stay(0.0)

    def _turn(self, look: Look) -> Duty:
        if look.gimbal:
            return Stay(0.0)
        if not isinstance(look.at, Object):
            return Face(self._towards(look.at, look))
        at = look.at
        return _Found(partial(self._finding, at), lambda place: Face(self._towards(place, look)))

    def _go(self, move: str, movement: GoTo, here: Vector, *, through: bool) -> Duty:
        if not self._track:
            self._track.append((move, self._above(here)))
        target = movement.at

        def way(place: Place, *, on: bool = through) -> Duty:
            return self._legs(move, movement, place, through=on)

        if not isinstance(target, Object):
            return self._looking(movement, lambda: way(target))
        if self._sight is None:
            return _Found(partial(self._finding, target), way)
        if target.expected is None:
            why = f"object {target.description!r}: unknown expected position"
            return _Fails(FaultError(OBJECT_NOT_FOUND, why))
        expected, reported = self._below(target.expected), self._reported.get(target.description)
        return Seek(
            target.description,
            expected,
            target.tolerance,
            self._sight,
            lambda place, seen: way(self._above(place), on=False),
            None if reported is None else (reported[0], reported[1], expected[2]),
        )

    def _finding(self, target: Object) -> Finding:
        return Finding(target, self._locators, self._state())

    def _looking(self, movement: GoTo, way: Callable[[], Duty]) -> Duty:
        """Return the way of a movement, once it is known where an object is that is looked at meanwhile."""
        look = movement.look
        if look is None or not isinstance(look.at, Object) or look.gimbal:
            return way()

        at = look.at

        def known(place: Place) -> Duty:
            self._seen[at] = place
            return way()

        return _Found(partial(self._finding, at), known)

    def _legs(self, move: str, movement: GoTo, target: Place, *, through: bool) -> Duty:
        ends = ends_of(self._state().place, target, movement.legs, movement.distance)
        if isinstance(movement.at, Object):
            self._seen[movement.at] = target
        bearing = self._bearing(movement.look)
        pace = movement.speed or self._robot.cruise or 0.0
        legs = [
            Travel([self._below(end)], pace, bearing, through=through and end is ends[-1]) for end in ends
        ]
        passed = [partial(self._track.append, (move, end)) for end in ends]
        return _Chain(legs, passed)

    def _use(self, order: Operate) -> Duty | Fault:
        if order.device not in self._sheet.devices:
            return Fault(DEVICE_SILENT, f"there is no device '{order.device}'")
        after = patience(DEVICE_SILENT, self.policies)
        longest = order.seconds + (AFTER[DEVICE_SILENT] if after is None else after)
        return Use(order.device, order.number, order.parameter, longest)

    @property
    def _floats(self) -> bool:
        return self._sheet.weight_in_water < 0.0

    def _bearing(self, look: Look | None) -> Bearing | None:
        """Return where the front points; None where a device turns on its own, or the target is unknown."""
        if look is None or look.gimbal:
            return None
        place = self._seen.get(look.at) if isinstance(look.at, Object) else look.at
        return None if place is None else self._towards(place, look)

    def _towards(self, place: Place, look: Look) -> Bearing:
        north, east, _ = self._below(place)
        return Bearing(north, east, look.angle + look.mount)

    def _places(self, here: Place, moves: Sequence[str]) -> Iterator[tuple[str, Place]]:
        for move in moves:
            movement = self._steps[move].movement
            if isinstance(movement, GoTo):
                target = movement.at.expected if isinstance(movement.at, Object) else movement.at
                ends = () if target is None else ends_of(here, target, movement.legs, movement.distance)
                yield from ((move, end) for end in ends)
                here = ends[-1] if ends else here

    def _below(self, place: Place) -> Vector:
        assert isinstance(place, Local)
        return (self.home[0] + place.north, self.home[1] + place.east, max(0.0, -place.height))

    def _above(self, place: Vector) -> Local:
        return Local(place[0] - self.home[0], place[1] - self.home[1], -place[2])


class _Chain:
    """Duties one after the other."""

    def __init__(self, duties: Sequence[Duty], passed: Sequence[Callable[[], None]]) -> None:
        """Do them; what is `passed` is called as each is done."""
        self._left = list(zip(duties, passed, strict=True))

    def begin(self, craft: Craft, now: float) -> None:
        if self._left:
            self._left[0][0].begin(craft, now)

    def done(self, craft: Craft, now: float) -> bool:
        while self._left:
            duty, passed = self._left[0]
            if not duty.done(craft, now):
                return False
            passed()
            self._left.pop(0)
            self.begin(craft, now)
        return True


class _Found:
    """A duty that is unknown until a function of the user has found its destination."""

    def __init__(self, find: Callable[[], Finding], then: Callable[[Place], Duty]) -> None:
        self._find, self._then = find, then
        self._finding: Finding | None = None
        self._duty: Duty | None = None

    def begin(self, craft: Craft, now: float) -> None:
        if self._duty is not None:
            self._duty.begin(craft, now)
        elif self._finding is None:
            self._finding = self._find()

    def done(self, craft: Craft, now: float) -> bool:
        if self._duty is None:
            assert self._finding is not None
            try:
                place = self._finding.place()
            except FaultError as fault:
                raise FailureError(fault.event, str(fault)) from fault
            if place is None:
                return False
            self._duty = self._then(place)
            self._duty.begin(craft, now)
        return self._duty.done(craft, now)


class _Fails:
    """What cannot even be begun."""

    def __init__(self, fault: FaultError) -> None:
        self._fault = fault

    def begin(self, craft: Craft, now: float) -> None:
        raise FailureError(self._fault.event, str(self._fault))

    def done(self, craft: Craft, now: float) -> bool:
        return False


def _dive_of(steps: Mapping[str, Step], passed: Sequence[str]) -> Sequence[str]:
    """Return the moves since the robot was charged last."""
    charged = [
        index for index, move in enumerate(passed) if isinstance(steps[move].movement, Recharge | Start)
    ]
    return passed[charged[-1] + 1 :] if charged else passed
