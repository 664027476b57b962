"""One robot of a behaviour, driven over its link: what the engine has it do, and what it tells."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import inf
from traceback import format_exception

from mmrs_runtime.controllers.box_entries import fix
from mmrs_runtime.controllers.state import KnownState, status_of
from mmrs_runtime.faults import (
    BATTERY_LOW,
    CRASHED,
    DEVICE_SILENT,
    LINK_LOST,
    VEHICLE_RESTARTED,
    DisplacedError,
    FaultError,
)
from mmrs_runtime.policies import CONTINUE, NOTHING
from mmrs_runtime.vehicle import Fault, Vehicle

from ..program import Action, GoTo, Land, Operate, Place, Recharge, Robot, Step, Stop, TakeOff
from ..services.uploads import uploads_of
from ..steps.obeying import astray, away, obeying
from ..steps.reception import Reception
from ..steps.watch import Watch
from ..vehicles.footing import footing
from .cameras import Cameras
from .equipment import Equipment
from .lost_link import LostLink
from .moves import Moves
from .response import Response
from .setup import Setup
from .way_back import WayBack
from .worker import Interrupted, Job, Worker

FAREWELL_SECONDS = 5.0
"""Real seconds within which a vehicle must be commanded to hold position."""


class ThreadedVehicle(Vehicle):
    """Drives one robot; a thread of its own waits for the vehicle, so that every call returns at once."""

    def __init__(self, robot: Robot, equipment: Equipment) -> None:
        """Receive from the vehicle; no command is sent before it is to get ready."""
        robot = robot if equipment.dry else robot.judged
        self._robot, self._with, self._live = robot, equipment, equipment.live
        self._lost_link = LostLink(robot, equipment.vehicle, self._live.say)
        self._watch = self._new_watch()
        self._link = None if equipment.radio is None else equipment.radio.link
        self._moves = Moves(
            robot,
            equipment.vehicle,
            equipment.clock,
            equipment.locators,
            self._keep,
            self._come_to,
            equipment.guard,
        )
        self._cameras = Cameras(robot, self._live.records)
        self._way = WayBack(robot, self._moves, equipment.vehicle, self._cameras, equipment.home_tolerance)
        uploads = uploads_of(robot, fenced=equipment.fence)
        self._flights = uploads.flights
        self._setup = Setup(robot, equipment, uploads, self._watch, self._lost_link, self._way, self.note)
        self._steps = {step.move: step for step in robot.steps}
        self._move = ""
        self._passed: set[str] = set()
        self._under_way: tuple[str, ...] = ()
        self._tolerance = equipment.home_tolerance
        self._response = Response(
            robot, equipment.vehicle, self._watch, self._moves, self._live.say, self._tolerance
        )
        self._reception = Reception(self._link, equipment.clock)
        self._brakes: Callable[[], bool] = lambda: False
        self._seen: FaultError | None = None
        self._battery_change: str | None = None
        self._left: FaultError | None = None
        # Last: it looks at all of the above from now on.
        self._worker = Worker(
            f"robot {robot.id!r}", self._look, self._idle, self._halt, equipment.vehicle.carry_on
        )
        self._worker.changed = self._live.wake
        self._worker.faulty = self._come_back
        self._worker.failed = self._response.failed = self._note_failure
        equipment.guard.check = self._worker.guard

    def prepare(self, now: float) -> bool:
        """Begin to wait for the vehicle, and to set it up."""
        self.done, self.trouble = False, None
        self._with.start()
        self._begin(Job(self._setup.meet, self._setup.set_up))
        return True

    def known(self, now: float) -> bool:
        """Return whether the vehicle is known to be the robot's."""
        return self._setup.is_known

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a step's movement, or an action of the robot's program."""
        self.done, self.trouble = False, None
        if isinstance(order, Step):
            self._go(order.move, through=through)
        else:
            assert isinstance(order, Action)
            self._under_way = ()
            job = self._moves.action(order)
            if isinstance(order, Operate):
                job.append(partial(self._cameras.note, order))
            self._begin(job)

    def _go(self, move: str, *, through: bool) -> None:
        """Begin a movement; those in the midst of an uploaded run have begun with its first."""
        self._lost_link.follow(())
        self._move = move
        if move in self._under_way[1:]:
            return
        self._passed.clear()
        flight = self._flights.get(move)
        self._under_way = () if flight is None else flight.run.moves
        if flight is None:
            job = self._moves.movement(move, through=through)
        else:
            job = self._moves.run(flight, self._pass)
        if self._begins_sortie(move):
            job.first(self._setup.begin_sortie)
        kind = self._moves.kind(move)
        if kind is Recharge or (kind is Stop and not self._robot.profile.flies):  # it may disarm anywhere
            self._watch.moving = False
        if self._moves.kind(move) is Land:
            job.append(self._landed)
        self._begin(job)

    def look(self, now: float) -> float:
        """See what went wrong, and what has finished; the worker tells when to look again."""
        found = self._seen = self._worker.fault
        self.trouble = None if found is None else Fault(found.event, str(found), found.instead)
        passed = self._under_way and self._move != self._under_way[-1] and self._move in self._passed
        self.done = found is None and (bool(passed) or self._worker.done)
        return inf

    def bear(self, now: float) -> bool:
        """Continue after a silent device, or with a battery that does not get full."""
        found = self._worker.fault
        if found is None:
            return True
        charging = bool(self._move) and self._moves.kind(self._move) is Recharge
        if found.event != DEVICE_SILENT and not (found.event == BATTERY_LOW and charging):
            return False
        self._note_decision(found.event, str(found), CONTINUE)
        self._live.say(f"carries on although {found}")
        self._worker.forgive(found)
        return True

    def change_battery(self, now: float) -> None:
        """Begin to have the vehicle count its batteries as full, in the midst of charging or at rest."""
        self._battery_change = None
        charging = self._moves.charging
        if self._worker.fault is not None:
            self._battery_change = str(self._worker.fault)
        elif self._worker.done:
            self._begin(Job(lambda: self._note_change(self._with.vehicle.renew_battery())))
        elif charging is not None and not charging.is_over:
            charging.confirm(self._note_change)
        else:
            self._battery_change = "it is doing something else"

    def battery_change(self, now: float) -> str | None:
        """Return why the batteries do not count as changed; empty: they do; None: not known yet."""
        if self._battery_change is None and self._worker.fault is not None:
            return str(self._worker.fault)
        return self._battery_change

    def wait(self, now: float) -> None:
        """Hold the pose, with the policies of the wait."""
        then = self._steps[self._move].then if self._move else None
        self._lost_link.follow(then.policies if then is not None else ())
        if self._lost_link.is_due:
            self._begin(Job())

    def state(self, now: float) -> KnownState:
        """Return what the vehicle has told last."""
        known = self._with.vehicle.state()
        energy = (
            None if known.energy is None or self._with.joules is None else known.energy * self._with.joules
        )
        place = self._with.position(known.place)
        places = {name: self._with.position(each) for name, each in known.places.items()}
        return KnownState(
            now,
            place,
            known.speed,
            known.heading,
            energy,
            known.energy,
            known.wind,
            known.detected,
            places=places,
            own=known,
        )

    def status(self) -> Mapping[str, object]:
        """Return the last reported state, in the words of controllers; empty before the first message."""
        received = self._link is None or self._link.latest("HEARTBEAT") is not None
        return status_of(self._with.vehicle.state()) if received else {}

    def respond(self, response: str, now: float) -> None:
        """Carry out a response, from any state, or what comes nearest to it that can be done then."""
        self.done, self.trouble = False, None
        found = self._worker.fault
        if found is None and response == self._response.name:
            return
        self._under_way, self._brakes = (), lambda: False
        job = self._response.begin(response, found, self._note_decision, restored=self._reception.is_restored)
        if job is not None:
            if response != NOTHING:
                job.first(lambda: self._cameras.rest(self._with.vehicle))
            self._worker.begin(job, afresh=True)
            self._wake_vehicle()

    def obeys(self, now: float) -> bool:
        """Return whether the vehicle has carried out the response, or was seen to begin it since."""
        if self._worker.fault is not None or not self._worker.started:
            return False
        return (self._worker.done or self._response.is_shown) and not self._response.undone

    def undone(self, now: float) -> str:
        """Return why nothing is left to do, and the vehicle has not carried out its command."""
        return self._response.undone

    def reachable(self, now: float) -> bool:
        """Return whether a message of the vehicle arrived lately."""
        return self._reception.is_received

    def in_doubt(self, now: float) -> bool:
        """Return whether the vehicle has left its mode for an unknown cause, or one not yet handled."""
        return self._watch.looking or (self._watch.taken and not self._response.hands_off)

    def watched(self, now: float) -> bool:
        """Return whether it is armed, and holds, is under external control, lost, or unresponsive.

        Without the heartbeats of this process, it might fly away from the pilot.
        """
        armed = self._with.vehicle.state().armed
        if (found := self._worker.fault) is not None and found.event == CRASHED:
            return armed
        if found is not None:
            return found.event == LINK_LOST and self._reception.may_come_back(found) and armed
        hands_off = self._response.hands_off and self._link is not None
        return self._response.holds or (armed and (hands_off or not self._worker.done))

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why no return path exists now; empty where there is one."""
        vehicle = self._with.vehicle
        if not self._reception.is_received:
            return "no messages from its vehicle"
        if not vehicle.state().armed and (why := astray(self._robot, vehicle, self._tolerance)):
            return why
        try:
            self._way.check(passed, begun)
        except FaultError as fault:
            return str(fault)
        return ""

    def away(self, now: float) -> str:
        """Return that the vehicle stands elsewhere than at home, or is silent; empty where it is there."""
        if not self._reception.is_received:
            return "no messages from its vehicle"
        return away(self._robot, self._with.vehicle, self._tolerance)

    def moves(self, now: float) -> bool:
        """Return whether it is armed."""
        return self._worker.fault is None and self._with.vehicle.state().armed

    @property
    def comes_home(self) -> bool:
        """Return that it knows the return path."""
        return True

    def recover(self, passed: Sequence[str], begun: str, now: float) -> bool:
        """Begin to go back to where the program was broken off."""
        self.done, self.trouble = False, None
        self._response.forget()
        self._move = begun or (passed[-1] if passed else "")
        if self._move:
            self._live.say(f"continues {'with' if begun else 'after'} {self._move!r}")
            self._note_decision("resume", f"its log ends at {self._move}", "goes the way it came")
        job = self._way.job(passed, begun)
        job.first(self._setup.take_up)
        job.append(lambda: self._cameras.restore(self._with.vehicle))
        self._begin(job, afresh=True)
        return True

    @property
    def pauses(self) -> bool:
        """Return that it can halt in the middle of anything."""
        return True

    def pause(self, now: float) -> None:
        """Begin to halt."""
        self._brakes = obeying("HOLD", self._robot, self._with.vehicle, self._moves.track)
        self._worker.pause()
        self._wake_vehicle()

    def resume(self, now: float) -> None:
        """Continue."""
        self._brakes = lambda: False
        self._worker.resume()

    def paused(self, now: float) -> bool:
        """Return whether the vehicle stands or was seen to brake since, and has not gone on."""
        worker = self._worker
        return worker.halted or worker.goes_on or (worker.started and self._brakes())

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Write a line into the black box."""
        if self._with.box is not None:
            move = self._move or self._live.begun or self._robot.start
            self._with.box.write(kind, **{"move": move, **content})

    def close(self) -> None:
        """End the worker and the link; the vehicle keeps whatever it does."""
        if self._response.holds and self._worker.fault is None:
            self._leave_it_holding()
        self._worker.close()
        self._with.let_go()
        if (link := self._link) is not None:
            if link.dropped:
                self.note("counted", {"frames": dict(link.dropped)})
            if link.garbled:
                reasons = (f"{reason} ({frames})" for reason, frames in sorted(link.dropped.items()))
                self._live.say(f"frames on the link that were not used: {', '.join(reasons)}")
            link.close()
        if self._with.box is not None:
            self._with.box.close()

    def _begin(self, job: Job, *, afresh: bool = False) -> None:
        if self._lost_link.is_due:
            job.first(self._lost_link.tell_what_is_due)
        fresh = afresh or (self._seen is not None and self._seen is self._worker.fault)
        self._worker.begin(job, afresh=fresh)

    def _new_watch(self) -> Watch:
        watch = Watch(self._robot, self._with.clock)
        if (radio := self._with.radio) is not None:
            watch.begin(radio.link, radio.vehicle)
        watch.current = lambda: self._lost_link.policies
        watch.track = lambda: self._moves.track
        watch.decide, watch.say = self._note_decision, self._live.say
        return watch

    def _note_decision(self, what: str, why: str, response: str) -> None:
        self.note("decision", {"what": what, "why": why, "response": response})

    def _come_back(self, lost: FaultError) -> None:
        """Make a vehicle whose link is restored respond to the loss, if its failsafe has not."""
        name, state = self._response.name, self._with.vehicle.state()
        if lost.event != LINK_LOST or lost is self._left or name in ("", NOTHING):
            return
        if not (self._reception.is_restored and state.armed):
            return
        if self._watch.answers_alone():
            self._left = lost
            return
        self._live.say(f"link restored, in mode {state.mode}, and no failsafe has acted: {name}")
        job = self._response.begin(name, lost, self._note_decision, restored=True)
        if job is not None:
            job.append(lambda: self._live.say(f"has done {name}"))
            self._worker.instead(lost, job)

    def _note_change(self, why: str) -> None:
        self._battery_change = why
        self._live.wake()

    def _note_failure(self, error: BaseException) -> None:
        """Report an error of the program itself, and record it in the black box."""
        trace = "".join(format_exception(error))
        self._live.say(f"the program itself fails: {trace}")
        self.note("failed", {"error": repr(error), "trace": trace})

    def _look(self) -> None:
        """Look after the vehicle, whatever it does; what it has left without a command is begun again.

        One that has restarted before its take-off is first set up again. Of a vehicle that is not known
        to be the robot's, only silence counts.
        """
        try:
            self._watch.check()
        except DisplacedError as displaced:
            if displaced.event == VEHICLE_RESTARTED:
                self._with.vehicle.take_back()
                self._worker.first(self._setup.begin_sortie)
            else:
                self._with.vehicle.regain()
            raise Interrupted from None
        except FaultError as fault:
            if self._setup.is_known or fault.event == LINK_LOST:
                raise

    def _idle(self) -> None:
        """Look after a vehicle without a task, which may come under external control."""
        if self._setup.is_known and not self._response.hands_off:
            self._with.vehicle.rest(0.0)
        else:
            self._look()

    def _halt(self) -> None:
        self._with.vehicle.hold()

    def _leave_it_holding(self) -> None:
        """Make a vehicle that holds stay in position once its controller is silent."""
        self._worker.begin(Job(lambda: self._with.vehicle.answer_lost_link("HOLD")))
        until = time.monotonic() + FAREWELL_SECONDS
        while not self._worker.done and self._worker.fault is None and time.monotonic() < until:
            time.sleep(0.01)
        if not self._worker.done:
            self._live.say("may not stay where it is when this program has ended")

    def _begins_sortie(self, move: str) -> bool:
        """Return whether the robot leaves the ground, or its place of charging, with a move."""
        kind = self._moves.kind(move)
        return kind is TakeOff or (kind is GoTo and not (self._watch.moving and self._moves.track))

    def _landed(self) -> None:
        self._watch.moving = False
        vehicle = self._with.vehicle
        vehicle.start = footing(self._robot.home, vehicle.state().place)

    def _pass(self, move: str) -> None:
        self._passed.add(move)
        self._live.wake()

    def _come_to(self, place: Place) -> None:
        if self._with.dry and self._with.box is not None:
            fix(self._with.box, self._with.vehicle.state(), place)

    def _wake_vehicle(self) -> None:
        if self._link is not None:
            self._link.wake()

    def _keep(self, kind: str, name: str, content: Mapping[str, object]) -> None:
        place = self._with.vehicle.state().place
        if kind == "reported":
            self.reported = {"name": name, "content": dict(content)}
        self.note(kind, {"name": name, "content": dict(content), "place": place})
        if kind == "text":
            self._live.say(f"{name}: {content['text']}")
            return
        named = f" '{name}'" if name else ""
        self._live.say(f"{kind}{named}: {', '.join(f'{key} {value}' for key, value in content.items())}")
