"""One underwater vehicle as the engine drives it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import hypot, inf

from auv_vessel.api import Craft, State
from auv_vessel.decision.duties import NO_PROGRESS, STALE, Duty, FailureError, Stay, Surface, ThrusterNews
from auv_vessel.decision.duty_control import (
    COMES_UP,
    CRASHED,
    LINK_LOST,
    NEVER_BORNE,
    POSITION_LOST,
    SILENT,
    UNHEARD,
    DutyControl,
    FaultMonitor,
)
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.sheet import Sheet, Vector
from mmrs_auv.controllers.orders import NO_WAY, NoWayError, Orders, notes_in
from mmrs_runtime.controllers.box_entries import FIX_SECONDS, fix
from mmrs_runtime.controllers.state import KnownState, status_of
from mmrs_runtime.controllers.state import State as Told
from mmrs_runtime.controllers.vocabulary import Local
from mmrs_runtime.policies import AFTER, NOTHING, OVERTAKES, patience, response_to
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.vehicle import Fault, Position, Vehicle

STAYS, RESTS, FINDS = ("HOLD", "CONTINUE"), ("STOP_THRUST", NOTHING), ("RETURN", "EMERGENCY_AREA")
HINDRANCES = (LINK_LOST, POSITION_LOST, NO_PROGRESS)
AT_HOME = 5.0
"""Metres from home that count as at home, where the position is not known better than that."""

LATELY = 60.0
"""Seconds for which what a vehicle has reported last counts as where it is."""

MODES = {"IDLE": "off", "HOLD": "hold", "SURFACE": "surface"}
"""Human-readable names of goals in force; any other leads somewhere."""


class CanVehicle(Vehicle):
    """Has a craft do what a program orders, and looks after it; nothing waits."""

    def __init__(
        self,
        robot: str,
        sheet: Sheet,
        craft: Craft,
        orders: Orders,
        *,
        box: BlackBox | None = None,
        say: Callable[[str], None] = lambda words: None,
        seen: Callable[[], Mapping[str, Vector]] = dict,
        clearance: float = 0.0,
    ) -> None:
        """Drive a craft.

        Args:
            robot: identifier, human-readable.
            sheet: data of the vehicle.
            craft: on its bus.
            orders: what its program says.
            box: None: nothing is kept.
            say: tells people something about this robot.
            seen: returns where things are that are seen now, by name: metres north, east and down.
            clearance: metres ahead within which sonar must see nothing; 0: it may.
        """
        self._robot, self._sheet, self._craft, self._orders = robot, sheet, craft, orders
        self._box, self._note, self._say, self._fixed = box, notes_in(box), say, -inf
        self._seen = seen
        self._helm, self._drives = DutyControl(craft), ThrusterNews(craft, sheet)
        self._watch = FaultMonitor(craft, orders.reserve, self._after, clearance)
        self._afloat = float(abilities_of(sheet).afloat)
        self._response, self._instead = "", ""
        self._given_up = self._unheard = self._bears = False
        self._silent_device: Fault | None = None
        self._answered: set[str] = set()
        self._now = 0.0
        self._told: dict[str, Position] = {}
        self._places: dict[str, Vector] = {}
        self._place = orders.home

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a movement or an action of the program."""
        self.done, self.trouble, self._silent_device = False, None, None
        self._forget_answers()
        if (report := self._orders.reports(order)) is not None:
            self._report(report)
        found = self._orders.duty(order, self._here(), through=through)
        if isinstance(found, Fault):
            self._silent_device = found
            return
        self._helm.watch = self._watch
        self._helm.begin(found, now)

    def look(self, now: float) -> float:
        """See what went wrong up to now, and whether what was begun last has finished."""
        self._look(now)
        self.trouble = self._wrong(now)
        goes_on = (self.trouble is None or self._bears) and self._silent_device is None
        self.done, self._bears = goes_on and self._helm.done(now), False
        return now

    def _wrong(self, now: float) -> Fault | None:
        found = self._helm.failure(now)
        if found is not None and self._response and self._craft.state().silent > UNHEARD:
            instead, self._unheard = "" if self._unheard else "SURFACE", True
            return Fault(LINK_LOST, found.reason, instead)
        if found is None or (self._response and not self._overtakes(found)):
            return self._silent_device
        return self._fault(found)

    def bear(self, now: float) -> bool:
        """Continue although something went wrong that policies tolerate."""
        self._bears = True
        if self._silent_device is not None:
            self._silent_device = None
            self._helm.begin(Stay(0.0), now)
            return True
        found = self._helm.failure(now)
        if found is None:
            return True
        self.note("decision", {"what": found.event, "why": found.reason, "response": "CONTINUE"})
        self._helm.bear(found.event)
        return True

    def learn(self, places: Mapping[str, Position]) -> None:
        """Seek objects first where other robots have detected them."""
        for name, place in places.items():
            if self._told.get(name) != place:
                self._told[name] = place
                self._orders.learn(name, self._orders.waters.below(place))
                self.note("told", {"object": name, "east": place[0], "north": place[1]})

    def wait(self, now: float) -> None:
        """Hold the pose: the last goal stays in force."""
        self._look(now)
        if self._helm.watch is not None:
            self._craft.stay()

    def state(self, now: float) -> KnownState:
        """Return what the vehicle has reported last."""
        self._look(now)
        return self._state(now, self._craft.state())

    def respond(self, response: str, now: float) -> None:
        """Carry out a response, or surface where that fails; its fault is reported no more."""
        if self.trouble is not None and self.trouble.which in OVERTAKES:
            self._answered.add(self.trouble.which)
            self._watch.tolerated.add(self.trouble.which)
        self.done, self.trouble, self._silent_device = False, None, None
        self._look(now)
        state = self._craft.state()
        self._response, self._instead = response, ""
        self._given_up = state.emergency is not None
        lost = state.position_lost and response in FINDS
        if (state.emergency is not None or lost) and response not in RESTS:
            why = "without its place" if lost else f"after {state.emergency}"
            self._instead = "" if response in ("SURFACE", "LAND") else f"{why}, it comes up"
            response = "SURFACE"
        self._helm.resume(now)
        self._helm.begin(self._answer(response), now)

    @property
    def pauses(self) -> bool:
        """Return that it can halt in the middle of anything."""
        return True

    def pause(self, now: float) -> None:
        """Begin to halt."""
        self._helm.pause(now)

    def resume(self, now: float) -> None:
        """Resume."""
        self._helm.resume(now)

    def paused(self, now: float) -> bool:
        """Return whether the vehicle has halted."""
        self._look(now)
        return self._helm.halted

    def obeys(self, now: float) -> bool:
        """Return whether the vehicle carries out the order of `respond`: its goal is in force."""
        state = self._craft.state()
        return self.reachable(now) and (
            state.progress != "NONE" or self._response in RESTS or self._at_rest()
        )

    def watched(self, now: float) -> bool:
        """Return whether the vehicle holds by thrust, or is out of reach, so that it must be attended."""
        return self._response in STAYS and not self._is_up()

    def undone(self, now: float) -> str:
        """Return why it has stopped without carrying out its order."""
        return self._instead

    def reachable(self, now: float) -> bool:
        """Return whether messages are received on the bus."""
        return self._craft.state().silent <= SILENT

    def known(self, now: float) -> bool:
        """Return whether the vehicle on the bus is the robot's, as far as its bus says."""
        return self._craft.state().age < STALE

    @property
    def comes_home(self) -> bool:
        """Return that it knows the path back."""
        return True

    def recover(self, passed: Sequence[str], begun: str, now: float) -> bool:
        """Go back to where the last of the moves ended, by a way that is known."""
        self.done, self.trouble, self._silent_device = False, None, None
        self._response = ""
        self._forget_answers()
        self._helm.watch = self._watch
        try:
            duty = self._orders.back(passed, begun, self._here())
        except NoWayError as error:
            duty = _Refuse(f"{NO_WAY}: {error}")
        self._helm.begin(duty, now)
        return True

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why it cannot resume."""
        state = self._craft.state()
        if state.silent > SILENT:
            return "no messages received from its vehicle"
        if state.emergency is not None:
            return f"its dive was given up: {state.emergency}"
        try:
            self._orders.back(passed, begun, self._here())
        except NoWayError as error:
            return f"{NO_WAY}: {error}"
        return ""

    def away(self, now: float) -> str:
        """Return how far it is from its home; empty at home, or where its position is unknown."""
        state, home = self._craft.state(), self._sheet.home
        metres = hypot(state.north - home[0], state.east - home[1])
        return f"it is {metres:.0f} m from home" if state.age < LATELY and metres > AT_HOME else ""

    def moves(self, now: float) -> bool:
        """Return whether the vehicle may move by thrust at any moment."""
        return self.reachable(now) and not self._is_up()

    def status(self) -> Mapping[str, object]:
        """Return what the vehicle has reported last."""
        known = self._craft.state()
        return status_of(self._state_of(known)) if known.age < LATELY else {}

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something in the black box."""
        self._note(kind, content)

    def _answer(self, response: str) -> Duty:
        if response in STAYS:
            return Stay(0.0, hold=True)
        if response in RESTS:
            return _Idle()
        if response in FINDS:
            return _Then(self._orders.escape(response, self._here()), self._surface())
        return self._surface()

    def _surface(self) -> Duty:
        return Surface(self._afloat, floats=self._sheet.weight_in_water < 0.0)

    def _look(self, now: float) -> None:
        self._now = max(self._now, now)
        self._find()
        if self._box is not None and now - self._fixed >= FIX_SECONDS:
            self._fixed = now
            fix(self._box, self._state_of(self._craft.state()))
        for grave, words in self._drives.news():
            self.note("text", {"severity": grave, "text": words})
            self._say(words)

    def _find(self) -> None:
        known = self._craft.state()
        if known.age < LATELY:
            self._place = (known.north, known.east, known.depth)
        self._places.update(self._seen())

    def _state(self, now: float, known: State) -> KnownState:
        above = self._orders.waters.above
        energy = None if known.charge is None else known.charge * self._sheet.battery
        state = self._state_of(known)
        return KnownState(
            now,
            above(self._place),
            state.speed,
            known.heading,
            energy,
            known.charge,
            detected=state.detected,
            places={name: above(place) for name, place in self._places.items()},
            own=state,
        )

    def _state_of(self, known: State) -> Told:
        """Return what the vehicle tells, as black boxes and people have it: places count from its home."""
        mode = MODES.get(self._craft.goal.mode, "guided")
        return Told(
            self._now,
            self._from_home((known.north, known.east, known.depth)),
            hypot(known.surge, known.sway, known.heave),
            known.heading,
            known.charge,
            mode,
            armed=mode != "off",
            detected=frozenset(self._places),
            places={name: self._from_home(place) for name, place in self._places.items()},
        )

    def _from_home(self, place: Vector) -> Local:
        home = self._sheet.home
        return Local(place[0] - home[0], place[1] - home[1], -place[2])

    def _report(self, report: Mapping[str, object]) -> None:
        name, content = report["name"], {key: value for key, value in report.items() if key != "name"}
        self.reported = {"name": name, "content": content}
        self.note(
            "reported", {"name": name, "content": content, "place": self._state_of(self._craft.state()).place}
        )
        self._say(f"reported '{name}': {', '.join(f'{key} {value}' for key, value in content.items())}")

    def _here(self) -> Vector:
        self._find()
        return self._place

    def _fault(self, found: FailureError) -> Fault:
        comes_up = found.event in COMES_UP or (found.event in NEVER_BORNE and self._is_borne(found.event))
        return Fault(found.event, found.reason, "SURFACE" if comes_up else "")

    def _after(self, event: str) -> float:
        if event in NEVER_BORNE and self._is_borne(event):
            return AFTER[event]
        return patience(event, self._orders.policies) or 0.0

    def _is_borne(self, event: str) -> bool:
        return response_to(event, self._orders.policies) == "CONTINUE"

    def _overtakes(self, found: FailureError) -> bool:
        """Return whether something keeps the vehicle from its ordered response; reported once."""
        if found.event == CRASHED:
            return not self._given_up
        if found.event in HINDRANCES and self._response in FINDS:
            return True
        answered = self._response not in RESTS and not self._is_borne(found.event)
        return found.event in OVERTAKES and answered

    def _forget_answers(self) -> None:
        self._watch.tolerated -= self._answered
        self._answered.clear()

    def _at_rest(self) -> bool:
        return self._helm.done(self._now)

    def _is_up(self) -> bool:
        state = self._craft.state()
        return state.age < LATELY and state.depth < self._afloat + 0.15


class _Idle:
    def begin(self, craft: Craft, now: float) -> None:
        craft.idle()

    def done(self, craft: Craft, now: float) -> bool:
        return True


class _Refuse:
    def __init__(self, why: str) -> None:
        self._why = why

    def begin(self, craft: Craft, now: float) -> None:
        raise FailureError("REFUSED", self._why)

    def done(self, craft: Craft, now: float) -> bool:
        return False


class _Then:
    """One duty, then another."""

    def __init__(self, first: Duty, second: Duty) -> None:
        self._duty, self._second = first, second

    def begin(self, craft: Craft, now: float) -> None:
        self._duty.begin(craft, now)

    def done(self, craft: Craft, now: float) -> bool:
        if not self._duty.done(craft, now):
            return False
        if self._duty is self._second:
            return True
        self._duty = self._second
        self._duty.begin(craft, now)
        return False
