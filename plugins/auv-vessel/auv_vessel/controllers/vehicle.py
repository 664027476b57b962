"""A vehicle on its CAN bus, as the runtime of controllers asks for one: its calls wait."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from math import hypot, inf

from auv_vessel.api import FIRST_SIGN, Craft
from auv_vessel.decision.drives import Drives
from auv_vessel.decision.duties import (
    Duty,
    Face,
    FailureError,
    Finish,
    Ready,
    Seek,
    Stay,
    Surface,
    Travel,
    Use,
)
from auv_vessel.decision.duties import Look as Bearing
from auv_vessel.decision.helm import COMES_UP, CRASHED, LINK_LOST, UNHEARD, Helm, Watch
from auv_vessel.eyes import Detections
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.sheet import Sheet, Vector
from mmrs_mavlink.places import ends_of
from mmrs_mavlink.program import GoTo, Local, Look, Object, Place, Robot
from mmrs_mavlink.records.fixes import FIX_SECONDS, fix
from mmrs_mavlink.services.uploads import Uploads
from mmrs_mavlink.steps.responses import policy_for
from mmrs_mavlink.vehicles.modes import GUIDED, HOLD, SURFACE
from mmrs_mavlink.vehicles.vehicle import State
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import DEVICE_SILENT, OBJECT_NOT_FOUND, Fault, Refused, Unanswered
from mmrs_runtime.policies import AFTER, CONTINUE
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.screen import say

LOOK_SECONDS = 0.05
"""Real seconds between two looks at the vehicle."""

BATTERY_SECONDS = 1.0
"""Seconds within which a vehicle that tells its battery has done so."""

OFF = "off"


class CanVehicle:
    """Has a craft do what the program says, and looks after it in every wait.

    Attributes:
        start: where its program began: home.
        about: what its black box says first: devices tell when they have done what they were told.
    """

    def __init__(
        self,
        robot: Robot,
        sheet: Sheet,
        craft: Craft,
        clock: Clock,
        guard: Callable[[], None],
        box: BlackBox,
        *,
        patience: float = FIRST_SIGN,
        eyes: Detections | None = None,
        clearance: float = 0.0,
    ) -> None:
        """Tell it nothing yet.

        Args:
            patience: real seconds to wait for its first sign.
            eyes: what its cameras tell; None: nobody looks for objects.
            clearance: metres ahead within which sonar must see nothing; 0: it may.
        """
        self._eyes, self._seen = eyes, frozenset[str]()
        self._box, self._fixed = box, -inf
        self._robot, self._sheet, self._craft, self._clock = robot, sheet, craft, clock
        self._guard, self._patience = guard, patience
        self.start = robot.home
        self.about: Mapping[str, object] = {"link": "can", "confirms": True}
        self._helm, self._drives = Helm(craft), Drives(craft, sheet)
        self._watch = Watch(craft, robot.reserve, self._after, clearance)
        self._afloat = float(abilities_of(sheet).afloat)
        self._mode, self._armed = GUIDED, False
        self._told: set[str] = set()

    def answer_lost_link(self, response: str, after: float | None = None) -> None:
        """Do nothing: a vehicle whose decision centre is silent holds, then comes up."""

    def answer_breach(self, response: str) -> None:
        """Do nothing: there is no fence."""

    def prepare(self, uploads: Uploads) -> None:
        """Wait until the vehicle knows where it is, and has told its battery if it does so at all.

        Raises:
            Refused: it does not in time.
        """
        until = time.monotonic() + self._patience
        begun = self._clock.now()
        self._helm.begin(Ready(), begun)
        while not (self._helm.done(now := self._clock.now()) and self._has_told_battery(now - begun)):
            self._guard()
            if time.monotonic() > until:
                heard = self._craft.state().age < inf
                raise Refused("it does not know where it is" if heard else "no vehicle is heard on its bus")
            time.sleep(LOOK_SECONDS)
        self._helm.watch = self._watch

    def take_off(self, height: float) -> None:
        """Refuse to.

        Raises:
            Refused: always.
        """
        raise Refused("an underwater vehicle does not take off")

    def land(self) -> None:
        """Come up."""
        self.surface()

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place; `through`: without a stop there."""
        pace = speed or self._robot.cruise or 0.0
        self._move(Travel([self._below(place)], pace, self._bearing(look), through=through))

    def seek(self, movement: GoTo) -> Place | None:
        """Go to where an object is expected, and search there, until cameras see it; return where it is.

        None: there are no cameras, or it is no object.

        Raises:
            Fault: it is not found, or farther from where it is expected than it may be.
        """
        sought = movement.at
        if self._eyes is None or not isinstance(sought, Object):
            return None
        if sought.expected is None:
            raise Fault(OBJECT_NOT_FOUND, f"object {sought.description!r}: nobody knows where it is expected")
        found: list[Vector] = []

        def way(place: Vector, seen: bool) -> Duty:
            if seen:
                found.append(place)
                return Stay(0.0)
            ends = ends_of(self.state().place, self._above(place), movement.legs, movement.distance)
            pace = movement.speed or self._robot.cruise or 0.0
            return Travel([self._below(each) for each in ends], pace)

        expected = self._below(sought.expected)
        self._move(Seek(sought.description, expected, sought.tolerance, self._eyes.place, way))
        return self._above(found[-1]) if found else self.state().place

    def turn(self, look: Look) -> None:
        """Turn until the front, or a device, points at something."""
        if (bearing := self._bearing(look)) is not None:
            self._move(Face(bearing))

    def fly(self, first: int, last: int, reached: Callable[[int], None]) -> None:
        """Refuse to: nothing is uploaded.

        Raises:
            Refused: always.
        """
        raise Refused("there is no mission on a CAN bus")

    def rest(self, seconds: float) -> None:
        """Stay for so many seconds: the last goal stays in force, if there was one."""
        if seconds > 0.0:
            self._craft.stay()
            self._armed = True
        until = self._clock.now() + seconds
        while (left := until - self._clock.now()) > 0.0:
            before = self._clock.now()
            self._check()
            until += self._clock.now() - before
            time.sleep(min(self._clock.real(left), LOOK_SECONDS))
        self._check()

    def operate(self, number: int, params: tuple[float, ...], *, confirmed: bool = False) -> None:
        """Have the device of that number, from 1 on, do the action that the first parameter numbers.

        Raises:
            Unanswered: it does not answer.
        """
        device, action = self._sheet.devices[number - 1], int(params[0])
        seconds = self._sheet.extra.get(f"device{number - 1}.seconds", 0.0)
        try:
            self._do(Use(device, action, params[1] if len(params) > 1 else 0.0, seconds + 5.0))
        except Fault as fault:
            if fault.event != DEVICE_SILENT:
                raise
            raise Unanswered(str(fault)) from fault

    def measure(self, value: str, seconds: float) -> float | None:
        """Refuse to: values do not come over the bus.

        Raises:
            Unanswered: always.
        """
        raise Unanswered(f"{value}: values do not come over the bus")

    def tell_ground(self, text: str) -> None:
        """Tell nobody: nobody hears a vehicle under water."""

    def hold(self) -> bool:
        """Halt and stay by thrust; return that somebody must watch it."""
        self._armed = True
        self._do(Stay(0.0, hold=True))
        self._mode = HOLD
        return self._craft.state().emergency is None

    def carry_on(self) -> None:
        """Be ready to move again."""
        self._mode = GUIDED

    def check(self) -> None:
        """Do nothing: nobody else can take it."""

    def take_back(self) -> None:
        """Be ready to move again."""
        self._mode = GUIDED

    def regain(self) -> None:
        """Be ready to move again."""
        self._mode = GUIDED

    def surface(self) -> None:
        """Come up; nobody waits for a vehicle that is not heard."""
        self._mode, self._armed = SURFACE, True
        duty = Surface(self._afloat, floats=self._sheet.weight_in_water < 0.0)
        self._do(duty, leave=lambda: self._craft.state().silent > UNHEARD)
        self._armed = False

    def disarm(self) -> None:
        """Ask for no thrust."""
        self._craft.idle()
        self._mode, self._armed = OFF, False

    def finish(self) -> None:
        """End the mission: no thrust, unless it would sink."""
        Finish(floats=self._sheet.weight_in_water < 0.0).begin(self._craft, self._clock.now())
        self._armed = False

    def evidence(self) -> CanVehicle:
        """Return itself: it says what it is told to do at any time."""
        return self

    def in_mode(self, mode: str) -> bool:
        """Return whether it does that."""
        return self._mode == mode

    def is_off(self) -> bool:
        """Return whether it asks for no thrust."""
        return not self._armed

    def bound_for(self, place: Place, speed: float | None) -> bool:
        """Return whether it goes where it was told."""
        return self._mode == GUIDED and self._craft.state().progress in ("ACTIVE", "REACHED")

    def state(self) -> State:
        """Return what it has told last; places are metres from home, heights are above the surface."""
        known = self._craft.state()
        place = self._above((known.north, known.east, known.depth))
        speed = hypot(known.surge, known.sway, known.heave)
        now = self._clock.now()
        if self._eyes is not None:
            self._seen |= self._eyes.seen()
        return State(
            now, place, speed, known.heading, known.charge, self._mode, armed=self._armed, detected=self._seen
        )

    def _move(self, duty: Duty) -> None:
        self._mode, self._armed = GUIDED, True
        self._do(duty)

    def _do(self, duty: Duty, leave: Callable[[], bool] = lambda: False) -> None:
        self._helm.begin(duty, self._clock.now())
        while not self._helm.done(self._clock.now()) and not leave():
            self._check()
            time.sleep(LOOK_SECONDS)

    def _has_told_battery(self, waited: float) -> bool:
        return self._craft.state().charge is not None or waited > BATTERY_SECONDS

    def _check(self) -> None:
        """Obey orders; raise what goes wrong, each event once."""
        self._guard()
        now = self._clock.now()
        if now - self._fixed >= FIX_SECONDS:
            self._fixed = now
            fix(self._box, self.state())
        for grave, words in self._drives.news():
            self._box.write("text", severity=grave, text=words)
            say(f"'{self._robot.id}': {words}")
        found = self._helm.failure(now)
        if found is None:
            return
        if self._is_borne(found):
            self._helm.bear(found.event)
            return
        if found.event in self._told:
            return
        if found.event in (CRASHED, LINK_LOST):
            self._told.add(found.event)
            raise _fault(found)
        self._helm.bear(found.event)
        raise _fault(found)

    def _is_borne(self, found: FailureError) -> bool:
        if found.event in (CRASHED, LINK_LOST):
            return False
        return policy_for(found.event, self._robot).response == CONTINUE

    def _after(self, event: str) -> float:
        policy = policy_for(event, self._robot)
        if event == LINK_LOST and policy.response == CONTINUE:
            return AFTER[LINK_LOST]
        return policy.after or 0.0

    def _below(self, place: Place) -> Vector:
        assert isinstance(place, Local)
        north, east, _ = self._sheet.home
        return (north + place.north, east + place.east, max(0.0, -place.height))

    def _above(self, place: Vector) -> Local:
        north, east, depth = place
        return Local(north - self._sheet.home[0], east - self._sheet.home[1], -depth)

    def _bearing(self, look: Look | None) -> Bearing | None:
        if look is None or not isinstance(look.at, Local) or look.gimbal:
            return None
        north, east, _ = self._below(look.at)
        return Bearing(north, east, look.angle + look.mount)


def _fault(found: FailureError) -> Fault:
    return Fault(found.event, found.reason, "SURFACE" if found.event in COMES_UP else "")
