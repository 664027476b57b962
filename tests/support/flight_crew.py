"""A robot in this process: its vehicle as the driver has it, and what simulates that, by UDP."""

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field

from patience import until
from ports import free_port

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import open_port
from mmrs_mavlink.links.radio import Radio
from mmrs_mavlink.program import (
    Geographic,
    GoTo,
    Hold,
    Land,
    Place,
    Policy,
    Robot,
    Start,
    Step,
    Stop,
    TakeOff,
    Then,
)
from mmrs_mavlink.services.uploads import Uploads
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_mavlink.sitl.vehicle import LONGEST_STEP
from mmrs_mavlink.steps.watch import Watch
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.geodesy import distance
from mmrs_runtime.faults import FaultError
from mmrs_runtime.ports import NOTHING, Port, Received

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
    """A robot and its vehicle, watched in every wait.

    Attributes:
        simulated: its vehicle. track: the places passed in its sortie. decided: what its watch has decided.
    """

    robot: Robot
    vehicle: MavlinkVehicle
    link: Link
    watch: Watch
    simulated: SimulatedVehicle
    ears: Ears
    track: list[tuple[str, Place]] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    decided: list[tuple[str, str]] = field(default_factory=list)

    @property
    def clock(self) -> Clock:
        """Return the clock of its run."""
        return self.link.clock

    def fly_up(self) -> None:
        """Have the vehicle climb to ten metres, as the robot's program begins."""
        self.vehicle.prepare(Uploads())
        self.watch.renew()
        self.vehicle.take_off(10.0)
        self.track.append(("up", self.vehicle.state().place))

    def fly_out(self) -> None:
        """Have it climb, and go north."""
        self.fly_up()
        self.vehicle.go_to(NORTH, 5.0, None, False)
        self.track.append(("out", NORTH))

    def caught(self, seconds: float = 20.0) -> FaultError:
        """Return what the watch raises as soon as it does; fail if it raises nothing for so long."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                self.watch.check()
            except FaultError as fault:
                return fault
            time.sleep(0.005)
        raise AssertionError("the watch notices nothing")

    def quiet(self, seconds: float) -> None:
        """Look for so many seconds of the run, in which the watch must raise nothing."""
        clock = self.clock
        end = clock.now() + seconds
        while clock.now() < end:
            self.watch.check()
            time.sleep(0.005)

    def away(self, place: Geographic) -> float:
        """Return how far the vehicle is from a place, metres."""
        return distance(self.vehicle.state().place, place)

    @property
    def mode(self) -> str:
        """Return the mode of the vehicle itself."""
        return self.simulated.autopilot.mode_name


@contextmanager
def manned(robot: Robot | None = None, *, speedup: float = SPEEDUP, **settings: object) -> Iterator[Manned]:
    """Give a robot whose vehicle stands at home, ready, and whose program has not begun."""
    robot = robot or robot_of()
    clock = NearClock(speedup)
    with ExitStack() as stack:
        port = free_port()
        simulated = stack.enter_context(SimulatedVehicle(port, Settings(**settings), speedup=speedup))
        simulated.autopilot.link_timeout /= 2.0
        ears = Ears(open_port(f"udpin:127.0.0.1:{port}"))
        link = Link(Radio(ears, clock), clock, simulated.autopilot.settings.system)
        stack.callback(link.close)
        assert link.wait(lambda: link.component, 10.0 * speedup)
        vehicle = MavlinkVehicle(link, robot.profile, robot.home, travel=robot.travel)
        watch = Watch(robot, clock)
        watch.begin(link, vehicle)
        link.guard = watch.check
        made = Manned(robot, vehicle, link, watch, simulated, ears)
        watch.track, watch.say = lambda: made.track, made.said.append
        watch.decide = lambda event, why, response: made.decided.append((event, response))
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
