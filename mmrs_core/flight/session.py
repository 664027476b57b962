"""One robot at work, from the opening of its log and link to whatever end it comes to."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from importlib.metadata import version
from platform import python_version
from traceback import format_exception

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from . import recording
from .ardupilot import MavlinkVehicle
from .blackbox import BlackBox, black_box_path
from .desk import Desk
from .dry import DryVehicle
from .faults import CRASHED, LINK_LOST, STOPPED, TAKEN_OVER, Fault
from .judgement import Judgement
from .link import Link
from .log import Log
from .options import Options
from .pilot import Pilot
from .program import Geographic, Robot
from .radios import Radios
from .responses import policy_for, respond
from .screen import say
from .slots import Slots
from .vehicle import Vehicle
from .watch import Watch

OK, FAILED, LINK, INTERRUPTED = 0, 1, 5, 130
WATCH_SECONDS = 0.5
CODES = {STOPPED: INTERRUPTED, LINK_LOST: LINK}


@dataclass(frozen=True, slots=True)
class Shared:
    """What all robots of a process share; `stop` is set when they are to stop."""

    options: Options
    slots: Slots
    judgement: Judgement
    radios: Radios
    stop: threading.Event


def run_robot(robot: Robot, shared: Shared) -> int:
    """Run one robot's program to its end, or to the end that its policies say; return the exit code."""
    try:
        with ExitStack() as stack:
            stack.callback(shared.slots.leave, robot.id)
            return _open(robot, shared, stack).run(shared.options.fence)
    except Fault as fault:
        say(f"{robot.id!a}: {fault}")
        return CODES.get(fault.event, FAILED)


@dataclass(frozen=True, slots=True)
class Session:
    """A robot with all that it needs: its pilot and vehicle, and who watches them.

    Attributes:
        link: None in a dry run.
        on_stop: the response when somebody asks the robot to stop.
    """

    robot: Robot
    vehicle: Vehicle
    link: Link | None
    watch: Watch
    desk: Desk
    pilot: Pilot
    on_stop: str

    def run(self, fence: bool) -> int:
        """Carry the program out, with or without a fence; return the exit code."""
        code = self._carry_out(fence)
        if self.link is not None and self.link.dropped:
            self._tell_dropped(self.link.dropped)
        return code

    def _carry_out(self, fence: bool) -> int:
        try:
            self.pilot.fly(fence)
        except Fault as fault:
            return self._end_early(fault)
        except Exception as error:
            say("".join(format_exception(error)))
            return self._end_early(Fault(CRASHED, f"the program itself fails: {error!r}"))
        say(f"{self.robot.id!a}: done")
        return OK

    def _end_early(self, fault: Fault) -> int:
        response = self._response_to(fault)
        say(f"{self.robot.id!a}: {fault.event}: {fault}; response: {response}")
        self.pilot.journal.decide(fault.event, str(fault), response)
        self.watch.relax()
        try:
            self.pilot.journal.fail(fault.event)
        except Fault as error:
            say(f"{self.robot.id!a}: the fault is not in the log: {error}")
        self.desk.slots.leave(self.robot.id)
        try:
            if respond(response, fault, self.robot, self.vehicle, self.pilot.track):
                self._watch_over()
        except Fault as error:
            say(f"{self.robot.id!a}: cannot carry out {response}: {error}; take over by hand")
            return CODES.get(error.event, FAILED)
        say(f"{self.robot.id!a}: stopped" if fault.event == STOPPED else f"{self.robot.id!a}: ended early")
        return CODES.get(fault.event, FAILED)

    def _watch_over(self) -> None:
        """Stay with a vehicle that holds until somebody stops the program or takes over.

        Raises:
            Fault: the link is lost.
        """
        say(f"{self.robot.id!a}: holds; interrupt to end")
        try:
            while not self.desk.stop.is_set():
                self.vehicle.rest(WATCH_SECONDS)
        except Fault as fault:
            if fault.event != TAKEN_OVER:
                raise
            say(f"{self.robot.id!a}: {fault}")

    def _tell_dropped(self, dropped: Mapping[str, int]) -> None:
        shown = ", ".join(f"{reason} ({frames})" for reason, frames in sorted(dropped.items()))
        say(f"{self.robot.id!a}: frames on the link that were not used: {shown}")
        self.desk.box.write("counted", frames=dropped)

    def _response_to(self, fault: Fault) -> str:
        if fault.event == STOPPED:
            return self.on_stop.upper()
        return policy_for(fault.event, self.robot, self.pilot.waits.policies).response


def _open(robot: Robot, shared: Shared, stack: ExitStack) -> Session:
    options, judgement = shared.options, shared.judgement
    log = Log(options.log / robot.log, options.run, robot.id)
    stack.callback(log.close)
    box = BlackBox(
        black_box_path(options.log / robot.log),
        options.run,
        robot.id,
        options.clock.now,
        mark={"dry_run": True} if options.dry else {},
    )
    stack.callback(box.close)
    desk = Desk(
        options.clock,
        shared.slots,
        log,
        box,
        judgement.conditions,
        judgement.locators,
        shared.stop,
        say,
        options.dry,
    )
    watch = Watch(robot, options.clock, shared.stop)
    link = None if options.dry else _link(robot, shared, watch, stack)
    vehicle = _vehicle(robot, options, watch, link)
    box.write("start", **_facts(robot, options, link))
    if link is not None:
        geographic = isinstance(robot.home, Geographic)
        link.observe(recording.Recording(box, options.clock, vehicle.state, geographic=geographic))
    pilot = Pilot(robot, vehicle, desk)
    watch.current = lambda: pilot.waits.policies
    return Session(robot, vehicle, link, watch, desk, pilot, options.on_stop)


def _vehicle(robot: Robot, options: Options, watch: Watch, link: Link | None) -> Vehicle:
    if link is None:
        return DryVehicle(options.clock, robot.home, watch.check)
    near = options.tolerances
    vehicle = MavlinkVehicle(
        link,
        robot.vehicle,
        robot.home,
        acceptance=near.place,
        travel=robot.travel,
        home_tolerance=near.home,
        tell=lambda line: say(f"{robot.id!a}: {line}"),
    )
    watch.begin(link, vehicle)
    return vehicle


def _link(robot: Robot, shared: Shared, watch: Watch, stack: ExitStack) -> Link:
    reach, clock = shared.options.reach, shared.options.clock
    url, system = reach.urls[robot.id], reach.systems[robot.id]
    link = shared.radios.open(url, system)
    stack.callback(link.close)
    link.guard = watch.check
    say(f"{robot.id!a}: waits for {f'system {system}' if system else 'a vehicle'} at {url}")
    shared.radios.meet(link, url, reach.patience * clock.speedup)
    return link


def _facts(robot: Robot, options: Options, link: Link | None) -> dict[str, object]:
    beat = link.latest("HEARTBEAT") if link is not None else None
    firmware = mavlink.enums["MAV_AUTOPILOT"].get(beat.autopilot) if beat is not None else None
    return {
        "link": options.reach.urls[robot.id] if link is not None else None,
        "vehicle": robot.vehicle,
        "firmware": firmware.name.removeprefix("MAV_AUTOPILOT_") if firmware is not None else None,
        "home": robot.home,
        "versions": {"python": python_version(), "pymavlink": version("pymavlink")},
    }
