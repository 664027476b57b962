"""Carries out one robot's program, step by step, and writes its log."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

from mmrs_runtime.bus import Incomplete
from mmrs_runtime.faults import BATTERY_LOW, NO_PROGRESS, REFUSED, Alone, Fault, Refused, Strange
from mmrs_runtime.policies import still_low

from ..desk import Desk, Meet
from ..objects import look_at, place_of
from ..orders.obedience import Obedience
from ..places import at_height, ends_of
from ..program import GoTo, Hold, Land, Look, Object, Place, Recharge, Robot, Step, TakeOff, Then, Turn
from ..records.fixes import fix
from ..services.uploads import Flight, uploads_of
from ..vehicles.corners import goes_through
from ..vehicles.footing import aside, footing
from ..vehicles.vehicle import Seeking, Vehicle
from .doing import Doing
from .energy import FULL, RECHARGE_FACTOR
from .equipping import equip
from .journal import Journal
from .rejoining import OFF_ITS_WAY, Rejoined, rejoined, way_ahead
from .resuming import began_at, starts_of, still_on, track_of
from .waits import Waits
from .watch import Watch

ON_THE_GROUND = 1.0
"""Metres above home under which a vehicle that was to land does not climb once more."""

STARTS = 3
"""How often a vehicle may start anew while it is set up."""

NOTHING_FOUND: Mapping[str, Place] = {}


class Pilot:
    """Steps through a program.

    Attributes:
        journal: what the robot writes down, with the move that it is at.
        waits: in which it stands still for others.
        track: the places it has passed in the air or on its way, with the moves that ended there.
    """

    def __init__(
        self,
        robot: Robot,
        vehicle: Vehicle,
        desk: Desk,
        watch: Watch,
        obedience: Obedience,
        *,
        fence: bool = True,
    ) -> None:
        """Take a program, a vehicle and what is needed to work; `fence`: whether to upload it."""
        self.journal = Journal(robot, vehicle, desk)
        self.waits = Waits(robot, vehicle, desk, self.journal, lambda: obedience.held_for)
        self.track: list[tuple[str, Place]] = []
        self._doing = Doing(robot, vehicle, desk, self.journal, self.waits)
        self._robot = robot
        self._vehicle = vehicle
        self._desk = desk
        self._watch = watch
        self._obedience = obedience
        self._uploads = uploads_of(robot, fenced=fence)
        self._steps = {step.move: step for step in robot.steps}
        self._resumes = bool(desk.log.steps)

    def fly(self) -> None:
        """Carry out the program, from the beginning or from where its log ends.

        Raises:
            Fault: it cannot be carried out to its end.
        """
        self._recognise()
        self._begin()
        step: Step | None = self._steps[self.journal.move]
        while step is not None:
            step = self._perform(step)
        self._vehicle.finish()

    def _begin(self) -> None:
        """Be where the program begins, or where its log ends, and ready to go on.

        Raises:
            Strange: it is to go on from the ground, and cannot: that is no fault, and may be tried again.
            Fault: it cannot be carried out.
        """
        resumed = bool(self._desk.log.steps)
        try:
            self._prepare()
            if resumed:
                self._take_up_again()
            elif self._desk.meet is not None:
                self._meet(self._desk.meet)
        except Fault as fault:
            grounded = resumed and not self._vehicle.state().armed
            if grounded and fault.event in (NO_PROGRESS, REFUSED) and not self._vehicle.hold():
                raise Strange(str(fault)) from fault
            raise

    def _recognise(self) -> None:
        """Make sure that the vehicle is the robot's and where it may be, and have it wait there.

        Raises:
            Strange: it is not.
        """
        records = self._desk.log.steps
        try:
            starts = starts_of(self._robot, records) if self._resumes else (self._vehicle.start,)
            self._desk.recognise(bool(records), starts)
            self._resumes = False
            if not (records and self._vehicle.state().armed):
                return
            track = track_of(self._robot, records)
            self.track = track[: self._rejoined(track).behind]
        except Refused as error:
            raise Strange(str(error)) from error
        self._vehicle.carry_on()

    def _prepare(self) -> None:
        """Set the vehicle up; again where it has started anew meanwhile."""

        def say(line: str) -> None:
            self._desk.say(f"{self._robot.id!r}: {line}")

        for _ in range(STARTS):
            self._watch.renew()
            self.waits.tell_vehicle()
            equip(self._robot, self._vehicle, self._uploads, say)
            if not self._watch.restarted:
                break
        else:
            raise Refused("the vehicle starts anew again and again")
        if self._vehicle.state().energy is None and not self._desk.dry:
            self._desk.say(f"{self._robot.id!r} does not tell its battery: nobody will notice when it is low")
        self._watch.forewarn()

    def _meet(self, meet: Meet) -> None:
        """Begin together with all other robots.

        Raises:
            Alone: they have not come in time.
        """
        told: set[str] = set()

        def guard(missing: str) -> None:
            self._vehicle.rest(0.0)
            if missing and missing not in told:
                told.add(missing)
                self._desk.say(f"{self._robot.id!r} is ready to begin with the others: {missing}")

        try:
            begun = meet(guard)
        except Incomplete as error:
            raise Alone(str(error)) from None
        self._desk.say(f"{self._robot.id!r}: begins together with the others, {begun}")
        self.journal.decide("TOGETHER", str(begun), "begins")

    def _take_up_again(self) -> None:
        """Be where the interrupted leg began, by the way that the robot came in this sortie."""
        records = self._desk.log.steps
        passed = track_of(self._robot, records)
        step = self._steps[self.journal.move]
        self._desk.say(f"{self._robot.id!r}: goes on with {step.move!r}")
        self.journal.decide("resume", f"its log ends at {step.move}", "goes the way it came")
        if passed and not self._is_down(step, passed[-1][1]):
            self._watch.moving = True
            self._go_to_work(passed)
            for action in still_on(self._robot, records):
                self._doing.operate(action)
        self.track = passed
        self._obedience.conclude()

    def lacks_energy(self) -> str:
        """Return why the battery is not to be flown with; empty where it is, or nobody knows."""
        return still_low(self._vehicle.state().energy, self._robot.reserve)

    def _is_down(self, step: Step, last: Place) -> bool:
        """Return whether the robot stands where it was to land, below the last place, or is about to."""
        state = self._vehicle.state()
        low = not state.armed or state.place.height - self._robot.home.height < ON_THE_GROUND
        place = state.place if state.armed else self._vehicle.start
        return isinstance(step.movement, Land) and low and aside(place, last) < OFF_ITS_WAY

    def _go_to_work(self, passed: Sequence[tuple[str, Place]]) -> None:
        """Fly to the last of the places that were passed; `track` has what is behind the robot meanwhile."""
        if not self._vehicle.state().armed:
            if why := self.lacks_energy():
                self.waits.raise_unless_carried_on(Fault(BATTERY_LOW, why))
            self.track = []
            if self._robot.vehicle == "copter":
                self._obedience.repeat(partial(self._vehicle.take_off, passed[0][1].height))
        else:
            self._vehicle.carry_on()
            found = self._rejoined(passed)
            self.track = list(passed[: found.behind])
            for place in found.back:
                self._go(place, self._robot.cruise, None, through=False)
        for move, place in passed[len(self.track) :]:
            self._go(place, self._robot.cruise, None, through=False)
            self.track.append((move, place))

    def _rejoined(self, passed: Sequence[tuple[str, Place]]) -> Rejoined:
        """Return where the robot is, in the air, on the way to where the interrupted leg began."""
        state, places = self._vehicle.state(), [place for _, place in passed]
        began = began_at(self._robot, self._desk.log.steps)

        def locate(movement: GoTo) -> Place:
            return place_of(movement.at, self._desk.locators, state)

        last = places[-1] if places else began
        return rejoined(began, places, way_ahead(self._robot, self.journal.move, last, locate), state.place)

    def _perform(self, step: Step) -> Step | None:
        self._tell(step)
        at = self.journal.progress
        for index in range(at.before, len(step.before)):
            self._doing.act(step.before[index], f"pre:{index}")
        flight = self._uploads.flights.get(step.move) if not at.begun else None
        if at.ended:
            pass
        elif flight is None:
            if not at.begun:
                self.journal.write("begin")
            self._carry_out(step)
            self.journal.write("end")
        else:
            step = self._run(flight)
        for index in range(self.journal.progress.after, len(step.after)):
            self._doing.act(step.after[index], f"post:{index}")
        return self._steps[self.waits.leave(step.then)] if step.then is not None else None

    def _carry_out(self, step: Step) -> None:
        movement = step.movement
        if isinstance(movement, TakeOff):
            self._take_off(movement.height)
        elif isinstance(movement, Land):
            self._obedience.repeat(self._vehicle.land)
            self._watch.moving = False
            self._vehicle.start = footing(self._robot.home, self._vehicle.state().place)
        elif isinstance(movement, GoTo):
            self._go_to(movement, step)
        elif isinstance(movement, Recharge):
            self._recharge(movement.seconds)
        elif isinstance(movement, Hold):
            self._vehicle.rest(movement.seconds)
        elif isinstance(movement, Turn) and (look := self._look(movement.look)) is not None:
            self._obedience.repeat(partial(self._vehicle.turn, look))

    def _take_off(self, height: float) -> None:
        def leave_ground() -> None:
            if self._watch.restarted and not self._vehicle.state().armed:
                self._begin_sortie()
            self._vehicle.take_off(height)

        self._begin_sortie()
        self._obedience.repeat(leave_ground)
        self._passed(at_height(self._vehicle.state().place, height))

    def _begin_sortie(self) -> None:
        """Leave the ground; a vehicle that has started anew there, as with a new battery, is set up again."""
        self.track = []
        if self._watch.restarted:
            self._prepare()
        self._watch.renew()
        self._watch.moving = True

    def _look(self, look: Look | None, found: Mapping[str, Place] = NOTHING_FOUND) -> Look | None:
        locators = self._desk.locators
        if look is not None and isinstance(look.at, Object) and look.at.description in found:
            look = replace(look, at=found[look.at.description])
        return look_at(look, locators, self._vehicle.state())

    def _found(self, movement: GoTo) -> Mapping[str, Place]:
        """Return where the object that a movement leads to is, if the vehicle itself looks for it."""
        vehicle, found = self._vehicle, dict[str, Place]()
        if not isinstance(movement.at, Object) or not isinstance(vehicle, Seeking):
            return found
        description = movement.at.description

        def seek() -> None:
            if (place := vehicle.seek(movement)) is not None:
                found[description] = place

        self._obedience.repeat(seek)
        return found

    def _go_to(self, movement: GoTo, step: Step) -> None:
        if not self.track:
            self._begin_sortie()
            self._passed(self._vehicle.state().place)
        found = self._found(movement)
        here = at_height(self._vehicle.state().place, self.track[-1][1].height)
        at = next(iter(found.values()), movement.at)
        target = place_of(at, self._desk.locators, self._vehicle.state())
        look = self._look(movement.look, found)
        ends = ends_of(here, target, movement.legs, movement.distance)
        through = self._may_go_on(step) and goes_through(step, self._following(step), here)
        for place in ends:
            self._go(place, movement.speed, look, through=through and place == ends[-1])
            self._passed(place)

    def _may_go_on(self, step: Step) -> bool:
        """Return whether no slot keeps the robot from its next move, as far as is known now."""
        waits = step.then.waits if isinstance(step.then, Then) else ()
        return self._desk.slots.active(self._robot.id, waits)

    def _following(self, step: Step) -> Step | None:
        return self._steps[step.then.move] if isinstance(step.then, Then) else None

    def _go(self, place: Place, speed: float | None, look: Look | None, *, through: bool) -> None:
        self._obedience.repeat(partial(self._vehicle.go_to, place, speed, look, through))

    def _run(self, flight: Flight) -> Step:
        if not self.track:
            self._begin_sortie()
        moves = flight.run.moves
        self.journal.write("begin")
        following = flight.first

        def reached(seq: int) -> None:
            nonlocal following
            following = seq + 1
            if seq in flight.ends:
                self._pass_waypoint(flight.ends[seq], moves)

        self._obedience.repeat(lambda: self._vehicle.fly(following, flight.last, reached))
        self.journal.write("end")
        return self._steps[moves[-1]]

    def _pass_waypoint(self, move: str, moves: tuple[str, ...]) -> None:
        movement = self._steps[move].movement
        assert isinstance(movement, GoTo)
        self._passed(place_of(movement.at, {}, self._vehicle.state()))
        if move != moves[-1]:
            self.journal.write("end")
            following = moves[moves.index(move) + 1]
            self.journal.write("take", following)
            self._tell(self._steps[following])
            self.journal.write("begin")

    def _passed(self, place: Place) -> None:
        if self._desk.dry:
            fix(self._desk.box, self._vehicle.state(), place)
        self.track.append((self.journal.move, place))

    def _recharge(self, seconds: float) -> None:
        self.track = []
        self._watch.moving = False
        self._vehicle.finish()
        begun = self._desk.clock.now()
        self._vehicle.rest(seconds)
        while (left := self._vehicle.state().energy) is not None and left < FULL:
            taken = self._desk.clock.now() - begun
            if taken >= RECHARGE_FACTOR * seconds:
                fault = Fault(BATTERY_LOW, f"after {taken:.0f} s of charging the battery is at {left:.0%}")
                self.waits.raise_unless_carried_on(fault)
                return
            self._vehicle.rest(min(5.0, seconds or 5.0))
        if left is None:
            self._desk.say(f"{self._robot.id!r} has charged for {seconds:.0f} s; nobody knows how far")

    def _tell(self, step: Step) -> None:
        serves = f" for task {step.task!r}" if step.task else ""
        self._desk.say(f"{self._robot.id!r}: {step.move!r} ({type(step.movement).__name__}){serves}")
