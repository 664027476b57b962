"""Whatever is ordered, fails, or is stopped, and whenever: each order is answered, and once."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from flight_crew import robot_of
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mmrs_mavlink.crews import Crews
from mmrs_mavlink.desk import Desk
from mmrs_mavlink.judgement import Judgement
from mmrs_mavlink.links.radios import Radios
from mmrs_mavlink.options import options_of, parser_for
from mmrs_mavlink.orders.obedience import Obedience
from mmrs_mavlink.program import Place, Policy
from mmrs_mavlink.session import Session, Shared
from mmrs_mavlink.slots import LocalSlots
from mmrs_mavlink.steps.ending import Crew
from mmrs_mavlink.steps.guarding import guarding
from mmrs_mavlink.steps.pilot import Pilot
from mmrs_mavlink.steps.watch import Watch
from mmrs_mavlink.vehicles.dry import DryVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import Fault
from mmrs_runtime.injection import Rehearsal
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP, Inbox, Order
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.records.log import Log, read

ROBOT = robot_of(Policy("OBSTACLE", "HOLD"), Policy("DEVICE_SILENT", "CONTINUE"))
UNSEEN = ("shows", "")
SETTLED = 40
"""Looks of the robot without anything new before somebody has it land, so that it comes to an end."""

orders = st.sampled_from((HOLD, RESUME, RETURN, LAND, STOP))
faults = st.sampled_from(
    ("OBSTACLE", "BATTERY_LOW", "LINK_LOST", "TAKEN_OVER", "POSITION_LOST", "REFUSED", "VEHICLE_RESTARTED")
)
quiet = st.just(("quiet", ""))
events = st.one_of(
    quiet,
    st.tuples(st.just("order"), orders),
    st.tuples(st.just("order"), orders),
    st.tuples(st.just("fault"), faults),
    st.just(("bug", "")),
    st.just(("stop", "")),
    st.tuples(st.just("shows"), st.sampled_from(("", "all"))),
)


class Steps(Clock):
    """A clock that goes on by a tenth of a second whenever somebody looks at it."""

    def __init__(self) -> None:
        super().__init__()
        self._now = 0.0

    def now(self) -> float:
        self._now += 0.1
        return self._now

    def real(self, seconds: float) -> float:
        return 0.0


class Doubted(DryVehicle):
    """A vehicle that may or may not show that it obeys."""

    shows = True

    def in_mode(self, mode: str) -> bool:
        return self.shows and super().in_mode(mode)

    def bound_for(self, place, speed) -> bool:
        return self.shows


class World:
    """Has one thing after another happen whenever the robot looks."""

    def __init__(self, told) -> None:
        self.left = list(told)
        self.looks = 0
        self.receipts = []
        self.answers: Counter[int] = Counter()
        self.stop = Halt(self)
        self.abandon = threading.Event()
        self.inbox = Inbox("alpha", answered=lambda receipt: self.answers.update([id(receipt)]))
        self.vehicle: Doubted | None = None

    def order(self, name: str) -> None:
        self.receipts.append(self.inbox.give(Order(name)))

    def happen(self, *, between: bool = False) -> None:
        """Have the next thing happen; `between`: while nothing can fail."""
        kind, what = self.left.pop(0) if self.left else ("over", "")
        if kind == "order":
            self.order(what)
        elif kind == "stop":
            self.stop.set()
        elif kind == "shows" and self.vehicle is not None:
            self.vehicle.shows = bool(what)
        elif kind == "fault" and not between:
            raise Fault(what, f"{what} was drawn")
        elif kind == "bug" and not between:
            raise RuntimeError("something is wrong in the program itself")
        elif kind == "over":
            self._end()

    def _end(self) -> None:
        self.looks += 1
        if self.looks % SETTLED == 0:
            self.abandon.set()
            self.order(STOP if self.looks % (2 * SETTLED) else LAND)


class Halt(threading.Event):
    """A request to stop, at which things happen while somebody waits for it."""

    def __init__(self, world: World) -> None:
        super().__init__()
        self._world = world

    def wait(self, timeout=None) -> bool:
        self._world.happen(between=True)
        return self.is_set()


def shared_of(world: World, folder: Path) -> Shared:
    robots = [ROBOT, robot_of(id="beta")]
    options = options_of(parser_for(robots), robots, ["--dry-run", "--log", str(folder)])
    judgement = Judgement({}, {})
    crews = Crews([robot.id for robot in robots])
    return Shared(
        options=options,
        slots=LocalSlots(robots),
        judgement=judgement,
        decides={},
        rehearsal=Rehearsal(options.inject, options.clock, print),
        radios=Radios(options.clock),
        crews=crews,
        stop=world.stop,
        abandon=world.abandon,
    )


def fly(world: World, folder: Path) -> int:
    """Have a robot carry out its program, and let go of all that it worked with; return its exit code."""
    clock, shared = Steps(), shared_of(world, folder)
    with ExitStack() as stack:
        log = Log(folder / ROBOT.log, "run-0", ROBOT.id)
        stack.callback(log.close)
        box = BlackBox(folder / "alpha.blackbox.ndjson", "run-0", ROBOT.id, clock.now)
        stack.callback(box.close)
        stack.callback(world.inbox.close, "its program has ended")
        watch = Watch(ROBOT, clock, world.stop)
        obedience = Obedience(world.inbox, clock, world.stop, lambda line: None)
        stack.callback(obedience.close, "its program has ended")
        usual = guarding(watch, obedience)

        def guard() -> None:
            world.happen()
            usual()

        vehicle = world.vehicle = Doubted(clock, ROBOT.home, guard)

        def recognise(under_way: bool, starts: Sequence[Place]) -> None:
            obedience.begin(None, lambda: vehicle.shows)
            for _ in range(3):
                guard()
            obedience.begin(vehicle)

        desk = Desk(
            clock,
            shared.slots,
            log,
            box,
            {},
            {},
            world.stop,
            lambda line: None,
            recognise=recognise,
            abandon=world.abandon,
            dry=True,
        )
        pilot = Pilot(ROBOT, vehicle, desk, watch, obedience)
        shared.crews.man(ROBOT.id, vehicle.state, pilot.journal)
        return Session(Crew(ROBOT, vehicle, None, watch, obedience, desk, pilot, "hold"), shared).run()[0]


def check(told) -> None:
    with TemporaryDirectory() as folder:
        world = World(told)
        code = fly(world, Path(folder))
        labels = [step.label for step in read(Path(folder) / ROBOT.log)]
    assert [receipt.confirmed for receipt in world.receipts if receipt.confirmed is None] == []
    assert [world.answers[id(receipt)] for receipt in world.receipts] == [1] * len(world.receipts)
    assert code in (0, 1, 5, 130)
    assert "fault" not in labels[:-1], "nothing follows a fault"


@given(st.lists(events, max_size=12))
@example([UNSEEN, ("quiet", ""), ("quiet", ""), ("order", RETURN), ("order", HOLD)])
@example([UNSEEN, ("order", HOLD), ("order", HOLD), ("quiet", ""), ("fault", "OBSTACLE")])
@settings(max_examples=100, deadline=None)
def test_every_order_is_answered_once(told):
    check(told)


@pytest.mark.thorough
@given(st.lists(events, max_size=30))
@settings(max_examples=2000, deadline=None)
def test_every_order_is_answered_once_however_much_happens(told):
    check(told)
