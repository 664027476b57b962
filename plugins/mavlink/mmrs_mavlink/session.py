"""One robot at work, from the opening of its log and link to whatever end it comes to."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from traceback import format_exception
from typing import TYPE_CHECKING

from mmrs_runtime.bus import begin_together
from mmrs_runtime.faults import CRASHED, FAILURES, Alone, Fault, Refused, Strange
from mmrs_runtime.injection import Rehearsal
from mmrs_runtime.orders.orders import RESUME, RETURN
from mmrs_runtime.policies import NOTHING
from mmrs_runtime.records.blackbox import BlackBox, black_box_path
from mmrs_runtime.records.log import Log
from mmrs_runtime.screen import say

from .crews import Crews
from .desk import Desk, Meet
from .judgement import Condition, Judgement
from .options import Options
from .orders.obedience import Obedience, Ordered
from .program import Place, Robot
from .records.start import start_of
from .slots import BusSlots
from .steps.ending import CODES, FAILED, OK, Crew, Ending
from .steps.guarding import guarding
from .steps.hearing import is_heard, listening
from .steps.obeying import astray, away, came_down
from .steps.pilot import Pilot
from .steps.resuming import progress_of
from .steps.watch import Watch
from .vehicles.dry import DryVehicle
from .vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    from .linked import Linked
    from .links.radios import Radios

GLANCE_SECONDS = 0.2

Vehicles = Callable[[Robot, Options, Callable[[], None], BlackBox], Vehicle]
"""What makes the vehicle of a robot that is reached otherwise than by MAVLink.

It calls the guard in every wait, and writes where it is into the black box.
"""


@dataclass(frozen=True, slots=True)
class Shared:
    """What all robots of a process share.

    Attributes:
        radios: None: no robot speaks MAVLink.
        stop: set when they are to stop. abandon: set when even vehicles that others have are to be left.
        vehicles: None: vehicles that speak MAVLink.
    """

    options: Options
    slots: BusSlots
    judgement: Judgement
    decides: Mapping[str, Condition]
    radios: Radios | None
    rehearsal: Rehearsal
    crews: Crews
    stop: threading.Event
    abandon: threading.Event
    vehicles: Vehicles | None = None


def run_robot(robot: Robot, shared: Shared) -> int:
    """Run one robot's program to its end, or to the end that its policies say; return the exit code."""
    try:
        with ExitStack() as stack:
            stack.callback(shared.crews.dismiss, robot.id)
            code, over = _run(robot, shared, stack)
    except Fault as fault:
        say(f"{robot.id!r}: {fault}")
        code, over = CODES.get(fault.event, FAILED), True
    except FAILURES as error:
        say(f"{robot.id!r}: the program itself fails: {''.join(format_exception(error))}")
        code, over = FAILED, True
    if over:
        shared.slots.leave(robot.id)
    return code


def _run(robot: Robot, shared: Shared, stack: ExitStack) -> tuple[int, bool]:
    """Return the exit code of a robot, and whether its program is over: one that is suspended is not.

    Raises:
        Fault: its log or its link cannot be opened, or its program has ended otherwise.
    """
    try:
        session = _open(robot, shared, stack)
    except Ordered as order:
        say(f"{robot.id!r}: {order}")
        return CODES[order.event], True
    return session.run() if session is not None else (OK, True)


class Session:
    """A robot with all that it needs, until its program has ended for good."""

    def __init__(self, crew: Crew, shared: Shared) -> None:
        """Begin nothing yet."""
        self._crew = crew
        self._shared = shared

    def run(self) -> tuple[int, bool]:
        """Carry the program out, after changes of batteries, too.

        Returns:
            The exit code, and whether the program is over: one that is only suspended is not.
        """
        crew, down = self._crew, False
        while True:
            ending = Ending(crew, lambda: self._shared.slots.leave(crew.robot.id), self._lose, down=down)
            code = self._carry_out(ending)
            down = ending.suspended and ending.down
            if not down or not self._goes_on():
                break
        if crew.link is not None and crew.link.dropped:
            crew.desk.box.write("counted", frames=crew.link.dropped)
        if crew.link is not None and crew.link.garbled:
            crew.say(f"frames on the link that were not used: {_counts(crew.link.dropped)}")
        return code, not ending.suspended

    def _carry_out(self, ending: Ending) -> int:
        try:
            self._crew.pilot.fly()
        except (Strange, Alone) as fault:
            return self._end(ending, partial(ending.refuse, fault))
        except Fault as fault:
            return self._end(ending, partial(ending.end, fault))
        except FAILURES as error:
            return self._end(ending, partial(ending.end, self._failure(error)))
        self._crew.say("done")
        return OK

    def _end(self, ending: Ending, end: Callable[[], int]) -> int:
        """Return the exit code of how a program is ended; where that fails itself, of what is left to do."""
        try:
            return end()
        except FAILURES as error:
            fault = self._failure(error)
        if not self._crew.obedience.hands_off:
            try:
                return ending.end(fault)
            except FAILURES as error:
                self._failure(error)
        self._stay_on()
        return FAILED

    def _failure(self, error: BaseException) -> Fault:
        """Tell where the program itself has failed, and return that as a fault."""
        trace = "".join(format_exception(error))
        say(trace)
        self._crew.desk.box.write("failed", error=repr(error), trace=trace)
        return Fault(CRASHED, f"the program itself fails: {error!r}")

    def _stay_on(self) -> None:
        """Send nothing but heartbeats until the motors are off, or the vehicle is not heard any more."""
        crew, shared = self._crew, self._shared
        if crew.link is None:
            return
        crew.say("is told nothing any more: take over by hand; heartbeats go on until its motors are off")
        limit = listening(crew.desk.clock)
        while crew.vehicle.state().armed and crew.link.listening and crew.link.silent_for() < limit:
            crew.obedience.refuse_all("its program itself has failed")
            if shared.abandon.wait(GLANCE_SECONDS):
                return

    def _lose(self) -> bool:
        """Have it known that the robot's link is lost; return whether others still work."""
        self._shared.crews.lose(self._crew.robot.id)
        return self._shared.crews.others_work(self._crew.robot.id)

    def _goes_on(self) -> bool:
        """Return whether the robot, which came down for its battery, was told to go on; if so, let it."""
        crew, shared = self._crew, self._shared
        crew.watch.silence, crew.obedience.hands_off = True, True
        crew.watch.let_go()
        shared.crews.suspend(crew.robot.id)
        patience = time.monotonic() + shared.options.battery_patience
        came = came_down(crew.robot, crew.vehicle, crew.near_home)
        crew.say(f"{came}; change it, then order resume, or start again with --resume")
        while shared.crews.others_work(crew.robot.id) or time.monotonic() < patience:
            try:
                if (resumed := crew.obedience.awaits_resume(self._hindrance)) is not None:
                    crew.obedience.hands_off = False
                    crew.obedience.expect(resumed, lambda: crew.vehicle.state().armed)
                    crew.watch.tighten()
                    shared.crews.engage(crew.robot.id)
                    return True
            except Ordered as order:
                order.receipt.confirm("it stands on the ground")
                return False
            if shared.stop.wait(GLANCE_SECONDS):
                return False
        return False

    def _hindrance(self, order: str) -> str:
        """Return what keeps a robot that came down for its battery from obeying; empty: nothing does."""
        crew = self._crew
        if crew.robot.vehicle == "copter" and crew.vehicle.state().armed:
            return "its motors run: somebody else has it"
        if order not in (RESUME, RETURN):
            return ""
        if crew.link is not None and not is_heard(crew.link):
            return "its vehicle is not heard"
        if order == RETURN:
            return away(crew.robot, crew.vehicle, crew.near_home)
        return astray(crew.robot, crew.vehicle, crew.near_home) or crew.pilot.lacks_energy()


def _open(robot: Robot, shared: Shared, stack: ExitStack) -> Session | None:
    """Return a robot at work; None where its log says that there is nothing left to do.

    Raises:
        Fault: its log or its link cannot be opened, or its program has ended otherwise.
    """
    options = shared.options
    log = Log(options.log / robot.log, options.run, robot.id, resume=options.resume)
    stack.callback(log.close)
    over = progress_of(robot, log.steps).over
    if over.startswith("it has ended"):
        raise Refused(f"cannot go on: {over}")
    if over:
        say(f"{robot.id!r}: {over}")
        return None
    box = _box(robot, options, stack)
    shared.rehearsal.record(robot.id, lambda fault, content: box.write("injected", fault=fault, **content))
    stack.callback(shared.rehearsal.forget, robot.id)
    try:
        crew = _crew(robot, shared, log, box, stack)
    except Ordered as order:
        _end_unmanned(robot, shared, log, box, order)
        raise
    except Fault as fault:
        box.write("start", **start_of(robot, options.reach.urls.get(robot.id, ""), None))
        box.write("decision", what=fault.event, why=str(fault), response=NOTHING, move=robot.start)
        raise
    shared.crews.man(robot.id, crew.vehicle.state, crew.pilot.journal)
    return Session(crew, shared)


def _end_unmanned(robot: Robot, shared: Shared, log: Log, box: BlackBox, order: Ordered) -> None:
    """Answer an order that ends a program before there is a vehicle, and write down that it does.

    Raises:
        Fault: it cannot be written.
    """
    options, receipt = shared.options, order.receipt
    box.write("start", **start_of(robot, options.reach.urls.get(robot.id, ""), None))
    if options.resume:
        receipt.refuse("its vehicle was not heard, and was told nothing")
    else:
        now = options.clock.now()
        log.write("fault", robot.start, lamport=shared.slots.tick(), time=now, detail=order.event)
        receipt.confirm("there was no vehicle yet")
    box.write("order", **receipt.told)


def _crew(robot: Robot, shared: Shared, log: Log, box: BlackBox, stack: ExitStack) -> Crew:
    options, inbox = shared.options, shared.crews.inboxes[robot.id]
    watch = Watch(robot, options.clock, shared.stop)
    obedience = Obedience(inbox, options.clock, shared.stop, lambda line: say(f"{robot.id!r}: {line}"))

    shared.crews.held[robot.id] = lambda: obedience.held
    stack.callback(obedience.close, "its program has ended")
    guard = guarding(watch, obedience)
    others = None if options.dry else shared.vehicles
    linked = None if options.dry or others is not None else _linked(robot, shared, guard, stack)
    link = None if linked is None else linked.link
    vehicle: Vehicle
    if linked is not None:
        vehicle = linked.vehicle
    elif others is not None:
        vehicle = others(robot, options, guard, box)
    else:
        vehicle = DryVehicle(options.clock, robot.home, guard)
    desk = Desk(
        clock=options.clock,
        slots=shared.slots,
        log=log,
        box=box,
        conditions=shared.decides,
        locators=shared.judgement.locators,
        stop=shared.stop,
        say=say,
        questions=shared.crews.questions[robot.id],
        meet=_meeting(robot, shared),
        recognise=_recognition(robot, options, linked, vehicle, obedience, watch),
        abandon=shared.abandon,
        dry=options.dry,
    )
    box.write("start", **(start_of(robot, options.reach.urls.get(robot.id, ""), link) | dict(vehicle.about)))
    if linked is not None:
        from .services.satellites import attended  # needs MAVLink's library

        watch.begin(linked.link, linked.vehicle)
        linked.record(box, robot, options.clock)
        shared.rehearsal.attend(robot.id, attended(linked.link))
        shared.crews.wake[robot.id] = linked.link.wake
    pilot = Pilot(robot, vehicle, desk, watch, obedience, fence=options.fence)
    watch.current = lambda: pilot.waits.policies
    watch.track = lambda: pilot.track
    watch.unkept = lambda: shared.slots.trouble(robot.id)
    watch.decide = pilot.journal.decide
    watch.say = lambda line: say(f"{robot.id!r} {line}")
    return Crew(robot, vehicle, link, watch, obedience, desk, pilot, options.on_stop, options.tolerances.home)


def _meeting(robot: Robot, shared: Shared) -> Meet | None:
    robots, patience = robot.fleet or (robot.id,), shared.options.sync
    if patience is None:
        return None
    return lambda guard: begin_together(shared.slots.node, robot.id, robots, guard, patience=patience)


def _recognition(
    robot: Robot,
    options: Options,
    linked: Linked | None,
    vehicle: Vehicle,
    obedience: Obedience,
    watch: Watch,
) -> Callable[[bool, Sequence[Place]], None]:
    """Return what makes sure that the vehicle is the robot's, before anybody may tell it anything."""

    def rests() -> bool:
        heard = linked is not None and linked.link.latest("HEARTBEAT") is not None
        return heard and not vehicle.state().armed

    def look(under_way: bool, starts: Sequence[Place]) -> None:
        obedience.begin(None, rests)
        if linked is not None:
            watch.strange = True
            linked.recognise(robot, options, under_way, starts)
            watch.strange = False
        obedience.begin(vehicle)

    return look


def _box(robot: Robot, options: Options, stack: ExitStack) -> BlackBox:
    path, mark = black_box_path(options.log / robot.log), {"dry_run": True} if options.dry else {}
    box = BlackBox(path, options.run, robot.id, options.clock.now, mark=mark)
    stack.callback(box.close)
    return box


def _linked(robot: Robot, shared: Shared, guard: Callable[[], None], stack: ExitStack) -> Linked:
    from .linked import linked  # MAVLink's library need not be there where no robot speaks it

    assert shared.radios is not None
    return linked(robot, shared.options, shared.radios, guard, stack)


def _counts(dropped: Mapping[str, int]) -> str:
    return ", ".join(f"{reason} ({frames})" for reason, frames in sorted(dropped.items()))
