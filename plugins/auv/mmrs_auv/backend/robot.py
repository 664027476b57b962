"""One underwater vehicle as the engine drives it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot
from typing import Protocol

from auv_vessel.api import Craft, State
from auv_vessel.decision.drives import Drives
from auv_vessel.decision.duties import NO_PROGRESS, STALE, Duty, FailureError, Stay, Surface
from auv_vessel.decision.helm import (
    COMES_UP,
    CRASHED,
    LINK_LOST,
    NEVER_BORNE,
    POSITION_LOST,
    SILENT,
    UNHEARD,
    Helm,
    Watch,
)
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.sheet import Sheet, Vector
from mmrs_auv.backend.duties_of import Duties, Waters
from mmrs_core.behaviour.program import Action, Move
from mmrs_core.contributions.execution import Fault, RobotState
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import UnreachableError
from mmrs_core.runtime.escape import Escapes
from mmrs_core.runtime.known import DEVICE_ACTION, kinematics_of
from mmrs_core.scene import Position
from mmrs_runtime.policies import AFTER, NOTHING, OVERTAKES, patience, response_to
from mmrs_runtime.vehicle import Vehicle

STAYS, RESTS, FINDS = ("HOLD", "CONTINUE"), ("STOP_THRUST", NOTHING), ("RETURN", "EMERGENCY_AREA")
HINDRANCES = (LINK_LOST, POSITION_LOST, NO_PROGRESS)
NO_WAY = "no way is known back to where its program was broken off"
AT_HOME = 5.0
"""Metres from home that count as at home, where the place is not known better than that."""

EMPTY = 0.001
"""Part of the battery with which nothing works any more."""


class Keeper(Protocol):
    """What a robot's black box keeps, and who else sees where it is."""

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something; raises nothing."""
        ...

    def seen(self, state: RobotState) -> None:
        """See where the robot is."""
        ...


class CanRobot(Vehicle):
    """Has a craft do what moves and actions say, and looks after it; nothing waits."""

    def __init__(
        self,
        given: VehicleInput,
        sheet: Sheet,
        craft: Craft,
        duties: Duties,
        keeper: Keeper,
        *,
        clearance: float = 0.0,
    ) -> None:
        """Drive a craft; `clearance`: metres ahead within which sonar must see nothing."""
        self._given, self._sheet, self._craft, self._duties = given, sheet, craft, duties
        self._keeper = keeper
        self._waters = Waters(given.program.frame.surface)
        self._helm, self._drives = Helm(craft), Drives(craft, sheet)
        self._policies = (*given.robot.policies, *given.policies)
        self._watch = Watch(craft, given.program.reserve, self._after, clearance)
        self._escapes = Escapes(given, kinematics_of(given), given.robot.home or (0.0, 0.0, 0.0))
        self._afloat = float(abilities_of(sheet).afloat)
        self._response, self._instead = "", ""
        self._given_up = self._unheard = self._bears = False
        self._silent_device: Fault | None = None
        self._answered: set[str] = set()
        self._now = 0.0
        self._told: dict[str, Position] = {}
        self._places: dict[str, Position] = {}
        self._place: Position = given.robot.home or (0.0, 0.0, given.program.frame.surface)

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a grounded movement or action."""
        self.done, self.trouble, self._silent_device = False, None, None
        self._forget_answers()
        if isinstance(order, Move):
            self._helm.watch = self._watch
            self._helm.begin(self._duties.movement(order, self._here(), through=through), now)
        else:
            assert isinstance(order, Action)
            self._act(order, now)

    def _act(self, action: Action, now: float) -> None:
        duty = self._duties.action(action)
        if duty is None:
            self._silent_device = Fault("DEVICE_SILENT", f"'{action.device}' does not do '{action.name}'")
            return
        if not action.is_a(DEVICE_ACTION):
            self.note("reported", {"name": action.name, **dict(action.parameters)})
        self._helm.begin(duty, now)

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
        """Go on although something went wrong that policies say to bear."""
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
                self._duties.told[name] = self._waters.below(place)
                self.note("told", {"object": name, "east": place[0], "north": place[1]})

    def wait(self, now: float) -> None:
        """Hold the pose: the last goal stays in force."""
        self._look(now)
        if self._helm.watch is not None:
            self._craft.stay()

    def state(self, now: float) -> RobotState:
        """Return what the vehicle has told last."""
        self._look(now)
        return self._state(now, self._craft.state())

    def respond(self, response: str, now: float) -> None:
        """Do what a response says, or come up where that cannot be done; what it answers is told no more."""
        if self.trouble is not None and self.trouble.which in OVERTAKES:
            self._answered.add(self.trouble.which)
            self._watch.borne.add(self.trouble.which)
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
        """Go on."""
        self._helm.resume(now)

    def paused(self, now: float) -> bool:
        """Return whether the vehicle has halted."""
        self._look(now)
        return self._helm.halted

    def obeys(self, now: float) -> bool:
        """Return whether the vehicle does what it was told by `respond`: its goal is in force."""
        state = self._craft.state()
        return self.reachable(now) and (
            state.progress != "NONE" or self._response in RESTS or self._at_rest()
        )

    def watched(self, now: float) -> bool:
        """Return whether the vehicle holds by thrust, or is out of reach, so that somebody must stay."""
        return self._response in STAYS and not self._is_up()

    def undone(self, now: float) -> str:
        """Return why it has stopped without doing what it was told."""
        return self._instead

    def reachable(self, now: float) -> bool:
        """Return whether the bus is heard."""
        return self._craft.state().silent <= SILENT

    def known(self, now: float) -> bool:
        """Return whether the vehicle on the bus is the robot's, as far as its bus says."""
        return self._craft.state().age < STALE

    @property
    def comes_home(self) -> bool:
        """Return that it knows the way back."""
        return True

    def recover(self, passed: Sequence[str], begun: str, now: float) -> bool:
        """Go back to where the last of the moves ended, round forbidden areas and obstacles."""
        self.done, self.trouble, self._silent_device = False, None, None
        self._response = ""
        self._forget_answers()
        self._helm.watch = self._watch
        try:
            duty: Duty = self._duties.way(self._way_back(passed))
        except UnreachableError as error:
            duty = _Refuse(f"{NO_WAY}: {error}")
        self._helm.begin(duty, now)
        return True

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why it cannot go on."""
        state = self._craft.state()
        if state.silent > SILENT:
            return "its vehicle is not heard"
        if state.emergency is not None:
            return f"its dive was given up: {state.emergency}"
        try:
            self._way_back(passed)
        except UnreachableError as error:
            return f"{NO_WAY}: {error}"
        return ""

    def away(self, now: float) -> str:
        """Return how far it is from its home; empty at home, or where nobody has heard of it."""
        state, home = self._craft.state(), self._sheet.home
        metres = hypot(state.north - home[0], state.east - home[1])
        return f"it is {metres:.0f} m from home" if state.age < 60.0 and metres > AT_HOME else ""

    def moves(self, now: float) -> bool:
        """Return whether the vehicle may move by thrust at any moment."""
        return self.reachable(now) and not self._is_up()

    def told(self) -> Mapping[str, object]:
        """Return what the vehicle has told last."""
        state = self._craft.state()
        if not state.age < 60.0:
            return {}
        return {
            "mode": state.progress.lower(),
            "place": {"north": state.north, "east": state.east, "height": -state.depth},
            "heading": round(state.heading, 2),
            "speed": round(hypot(state.surge, state.sway, state.heave), 3),
            "energy": state.charge,
        }

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something in the black box."""
        self._keeper.note(kind, content)

    def _answer(self, response: str) -> Duty:
        if response in STAYS:
            return Stay(0.0, hold=True)
        if response in RESTS:
            return _Idle()
        if response in FINDS:
            path = self._escapes.clear(response, self._here())
            return _Then(self._duties.way(path), self._surface())
        return self._surface()

    def _surface(self) -> Duty:
        return Surface(self._afloat, floats=self._sheet.weight_in_water < 0.0)

    def _look(self, now: float) -> None:
        self._now = max(self._now, now)
        self._keeper.seen(self._state(now, self._craft.state()))
        for grave, words in self._drives.news():
            self.note("text", {"severity": grave, "text": words})
            if self._given.live is not None:
                self._given.live.say(words)

    def _state(self, now: float, known: State) -> RobotState:
        if known.age < 60.0:
            self._place = self._waters.above((known.north, known.east, known.depth))
        speed = hypot(known.surge, known.sway, known.heave)
        energy = None if known.charge is None else known.charge * self._sheet.battery
        self._places.update({name: self._waters.above(place) for name, place in self._detected().items()})
        return RobotState(
            now,
            self._place,
            speed,
            known.heading,
            energy,
            known.charge,
            detected=frozenset(self._places),
            places=dict(self._places),
        )

    def _detected(self) -> Mapping[str, Vector]:
        """Return what is seen now, and where: metres north, east and below the surface."""
        return {}

    def _here(self) -> Position:
        return self._state(self._now, self._craft.state()).position

    def _fault(self, found: FailureError) -> Fault:
        comes_up = found.event in COMES_UP or (found.event in NEVER_BORNE and self._is_borne(found.event))
        return Fault(found.event, found.reason, "SURFACE" if comes_up else "")

    def _after(self, event: str) -> float:
        if event in NEVER_BORNE and self._is_borne(event):
            return AFTER[event]
        return patience(event, self._policies) or 0.0

    def _is_borne(self, event: str) -> bool:
        return response_to(event, self._policies) == "CONTINUE"

    def _overtakes(self, found: FailureError) -> bool:
        """Return whether something keeps the vehicle from the response that it was told; told once."""
        if found.event == CRASHED:
            return not self._given_up
        if found.event in HINDRANCES and self._response in FINDS:
            return True
        answered = self._response not in RESTS and not self._is_borne(found.event)
        return found.event in OVERTAKES and answered

    def _forget_answers(self) -> None:
        self._watch.borne -= self._answered
        self._answered.clear()

    def _at_rest(self) -> bool:
        return self._helm.done(self._now)

    def _is_up(self) -> bool:
        state = self._craft.state()
        return state.age < 60.0 and state.depth < self._afloat + 0.15

    def _way_back(self, passed: Sequence[str]) -> tuple[Position, ...]:
        return self._escapes.way(self._here(), self._ended_at(passed))

    def _ended_at(self, passed: Sequence[str]) -> Position:
        moves = {move.id: move for move in self._given.robot.moves}
        place = self._given.robot.home or self._place
        for id in passed:
            path = self._duties.path(moves[id], place)
            place = path[-1] if path else place
        return place


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
