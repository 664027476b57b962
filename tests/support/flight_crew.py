"""A robot of the flight runtime in this process: all that works for it, and a simulated vehicle by UDP."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from patience import until
from ports import free_port

from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_core.sitl.hosting import LONGEST_STEP
from mmrs_mavlink.desk import Desk
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import open_port
from mmrs_mavlink.links.radio import Radio
from mmrs_mavlink.orders.obedience import Obedience
from mmrs_mavlink.places import distance
from mmrs_mavlink.program import (
    Geographic,
    GoTo,
    Hold,
    Land,
    Policy,
    Robot,
    Start,
    Step,
    Stop,
    TakeOff,
    Then,
)
from mmrs_mavlink.services.uploads import Uploads
from mmrs_mavlink.slots import LocalSlots
from mmrs_mavlink.steps.ending import Crew, Ending
from mmrs_mavlink.steps.guarding import guarding
from mmrs_mavlink.steps.pilot import Pilot
from mmrs_mavlink.steps.watch import Watch
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import Fault
from mmrs_runtime.orders.orders import Inbox
from mmrs_runtime.ports import NOTHING, Port, Received
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.records.log import Log, read

HOME = Geographic(42.37, 13.35, 0.0)
SPEEDUP = 30.0
OVERHEAD = Geographic(42.37, 13.35, 10.0)
NORTH = Geographic(42.3702, 13.35, 10.0)
"""22 metres north of home."""


def robot_of(*policies: Policy, id: str = "alpha", **more: object) -> Robot:
    """Return a robot that climbs, goes north, stays there, comes back, and lands."""
    moves = [
        ("start", Start()),
        ("up", TakeOff(10.0)),
        ("out", GoTo(NORTH, 5.0)),
        ("stay", Hold(5.0)),
        ("back", GoTo(OVERHEAD, 5.0)),
        ("down", Land()),
        ("stop", Stop()),
    ]
    following = [Then(name) for name, _ in moves[1:]]
    steps = tuple(
        Step(name, movement, then=then)
        for (name, movement), then in zip(moves, [*following, None], strict=True)
    )
    given = {"home": HOME, "start": "start", "reserve": 0.1, "vehicle": "copter"} | more
    return Robot(id, f"{id}.jsonl", steps=steps, policies=policies, fleet=(id,), **given)


class SteadyClock(Clock):
    """The clock of a run whose vehicle is in this process.

    While a machine that stalls keeps the process from running, it stands still, as the vehicle does. The
    reader of the link asks it many times a second, so that gaps between two questions are no waits.
    """

    def __init__(self, speedup: float, start: float = 0.0) -> None:
        super().__init__(speedup, start)
        self._asking = threading.Lock()
        self._asked, self._stalled = time.monotonic(), 0.0

    def now(self) -> float:
        """Return the seconds since the run began, without those in which nothing ran here."""
        with self._asking:
            real = time.monotonic()
            self._stalled += max(0.0, real - self._asked - LONGEST_STEP)
            self._asked = real
            return self._start + (real - self._zero - self._stalled) * self.speedup


class NearClock(SteadyClock):
    """One that knows that what takes real time anywhere else takes less here."""

    def patience(self, seconds: float, least: float = 0.5) -> float:
        """Return a time-out in seconds of the run, of half the usual real seconds at least."""
        return super().patience(seconds, least / 2.0)


class Ears:
    """A port that may be deaf, while whoever is at the other end hears everything.

    Attributes:
        deaf: whether it is.
    """

    def __init__(self, port: Port) -> None:
        self.deaf = False
        self._port = port
        self.write, self.close = port.write, port.close

    def read(self, seconds: float) -> Received:
        found = self._port.read(seconds)
        return NOTHING if self.deaf else found


@dataclass
class Manned:
    """A robot with its crew.

    Attributes:
        crew: of the flight runtime. inbox: for orders to it. stop: asks it to stop.
        simulated: its vehicle. said: what it told people. left: how often it told others that it has ended.
    """

    crew: Crew
    inbox: Inbox
    stop: threading.Event
    simulated: SimulatedVehicle
    said: list[str]
    log: Path
    box: BlackBox
    ears: Ears
    left: int = 0
    decided: list[tuple[str, str]] = field(default_factory=list)

    def fly_up(self) -> None:
        """Have the vehicle climb to ten metres, as the robot's program begins."""
        crew = self.crew
        crew.vehicle.prepare(Uploads())
        crew.watch.renew()
        crew.vehicle.take_off(10.0)
        crew.pilot.track.append(("up", crew.vehicle.state().place))

    def fly_out(self) -> None:
        """Have it climb, and go north."""
        self.fly_up()
        self.crew.vehicle.go_to(NORTH, 5.0, None, False)
        self.crew.pilot.track.append(("out", NORTH))

    def caught(self, seconds: float = 20.0) -> Fault:
        """Return what the watch raises as soon as it does; fail if it raises nothing for so long."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                self.crew.watch.check()
            except Fault as fault:
                return fault
            time.sleep(0.005)
        raise AssertionError("the watch notices nothing")

    def quiet(self, seconds: float) -> None:
        """Look for so many seconds of the run, in which the watch must raise nothing."""
        clock = self.crew.desk.clock
        end = clock.now() + seconds
        while clock.now() < end:
            self.crew.watch.check()
            time.sleep(0.005)

    def ending(self) -> Ending:
        """Return what ends its program."""

        def leave() -> None:
            self.left += 1

        return Ending(self.crew, leave)

    def events(self) -> list[str]:
        """Return the faults in its log."""
        return [line.detail for line in read(self.log) if line.label == "fault"]

    def away(self, place: Geographic) -> float:
        """Return how far the vehicle is from a place, metres."""
        return distance(self.crew.vehicle.state().place, place)

    def land_for_the_battery(self) -> None:
        """Have the vehicle land by itself since it finds its battery low."""
        found = {"BATT_FS_LOW_ACT": 1.0, "BATT_LOW_TIMER": 0.0, "BATT_LOW_VOLT": 99.0}
        with self.simulated.lock:
            self.simulated.autopilot.parameters |= found
        until(lambda: self.crew.vehicle.state().mode == "land")

    @property
    def mode(self) -> str:
        """Return the mode of the vehicle itself."""
        return self.simulated.autopilot.mode_name


@contextmanager
def crewed(
    folder: Path, robot: Robot, link: Link, stop: threading.Event, say: Callable[[str], None], on_stop: str
) -> Iterator[tuple[Crew, Inbox]]:
    """Give all that works for a robot whose vehicle has been met, and the inbox for orders to it."""
    clock = link.clock
    with ExitStack() as stack:
        log = folder / robot.log
        desk = Desk(
            clock=clock,
            slots=LocalSlots([robot]),
            log=Log(log, "run-0", robot.id),
            box=BlackBox(log.with_suffix(".blackbox.ndjson"), "run-0", robot.id, clock.now),
            conditions={},
            locators={},
            stop=stop,
            say=say,
        )
        stack.callback(desk.log.close)
        stack.callback(desk.box.close)
        inbox = Inbox(robot.id, arrived=link.wake)
        watch, obedience = Watch(robot, clock, stop), Obedience(inbox, clock, stop, say)
        vehicle = MavlinkVehicle(link, robot.vehicle, robot.home)
        watch.begin(link, vehicle)
        obedience.begin(vehicle)
        pilot = Pilot(robot, vehicle, desk, watch, obedience)
        watch.track = lambda: pilot.track
        link.guard = guarding(watch, obedience)
        yield Crew(robot, vehicle, link, watch, obedience, desk, pilot, on_stop), inbox


@contextmanager
def manned(
    folder: Path, robot: Robot | None = None, *, on_stop: str = "hold", **settings: object
) -> Iterator[Manned]:
    """Give a robot whose vehicle stands at home, ready, and whose program has not begun."""
    robot = robot or robot_of()
    clock, stop, said = NearClock(SPEEDUP), threading.Event(), []
    with ExitStack() as stack:
        port = free_port()
        simulated = stack.enter_context(SimulatedVehicle(port, Settings(**settings), speedup=SPEEDUP))
        simulated.autopilot.patience /= 2.0
        ears = Ears(open_port(f"udpin:127.0.0.1:{port}"))
        link = Link(Radio(ears, clock), clock, simulated.autopilot.settings.system)
        stack.callback(link.close)
        assert link.wait(lambda: link.component, 10.0 * SPEEDUP)
        crew, inbox = stack.enter_context(crewed(folder, robot, link, stop, said.append, on_stop))
        made = Manned(crew, inbox, stop, simulated, said, folder / robot.log, crew.desk.box, ears)
        crew.watch.decide = lambda event, why, response: made.decided.append((event, response))
        until(lambda: simulated.autopilot.ready)
        yield made


def in_background(work: Callable[[], object]) -> Future:
    """Return what some work will come to, begun in a thread of its own, as robots are."""
    found: Future = Future()

    def run() -> None:
        try:
            found.set_result(work())
        except BaseException as error:
            found.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    return found
