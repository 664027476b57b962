"""Orders in any sequence, among faults, doubts and ends: each is answered, once, and by what is true."""

from dataclasses import dataclass, field
from math import inf

from carried_out import carried_out
from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st
from live_runs import Idle

from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import hold, program, robot
from mmrs_runtime.engine.terms import Attention, Terms
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP, Order, Orders
from mmrs_runtime.records.steps import StepRecord

ROBOTS = ("a", "b")
KINDS = (HOLD, RESUME, RETURN, LAND, STOP)
POLICIES = (Policy("BATTERY_LOW", "RETURN"), Policy("OBSTACLE", "LAND"), Policy("NO_PROGRESS", "HOLD"))
FAULTS = ("BATTERY_LOW", "OBSTACLE", "NO_PROGRESS", "LINK_LOST", "TAKEN_OVER", "CRASHED")
BEHAVIOUR = program(*(robot(id, [hold("walk", 0.0), hold("rest", 0.0)], policies=POLICIES) for id in ROBOTS))
PATIENCE = 1000.0
COMES_DOWN = ("RETURN", "LAND")
LOOKS = 40
"""As many as a vehicle needs for whatever it was told, and the interpreter to see that."""


class Vehicle(Idle):
    """A robot that does what it is told step by step, each when the test says so, without a word about it."""

    def __init__(self, *, armed: bool, stays_armed: bool):
        self.armed, self.trouble, self.stays_armed = armed, None, stays_armed
        self.doubtful = self.holds = self.stands = self.hands_off = False
        self.response, self.steps, self.at = "", 0, ""

    def go_on(self) -> None:
        """Do a step: halt, go on, be seen to obey, and then be done."""
        self.stands = self.holds
        if self.steps > 0 and self.trouble is None and not (self.at and self.holds):
            self.steps -= 1
        if self.at in ("recover", "walk"):
            self.armed = self.armed or self.steps < 2 or self.at == "walk"
        if self.response in COMES_DOWN and self.steps == 0:
            self.armed = self.stays_armed

    def fail(self, which: str) -> None:
        if not self.hands_off:
            self.trouble = Fault(which)
            self.at = self.at if self.known(0.0) else "absent"

    @property
    def obeys_stop(self) -> bool:
        return bool(self.response) and self.steps < 2 and self.trouble is None

    @property
    def is_down(self) -> bool:
        return not self.armed or (self.response in COMES_DOWN and self.steps == 0)

    def _touch(self) -> None:
        assert self.known(0.0), "is told something although it is not known to be the robot's"

    def known(self, now):
        return self.at != "absent" and (self.at != "ready" or self.steps < 2)

    def _begin(self, at: str, steps: int) -> None:
        self._touch()
        self.at, self.steps, self.response = at, steps, ""

    def look(self, now):
        self.done = self.steps == 0
        return inf

    def prepare(self, now):
        self._begin("ready", 2)
        return True

    def do(self, order, now, *, through=False):
        self._begin(order.id, inf if order.id == "walk" else 0)

    def respond(self, response, now):
        if self.trouble is not None and self.trouble.which == "LINK_LOST" and response != "NOTHING":
            return
        self.hands_off = self.hands_off or response == "NOTHING"
        self.trouble, self.holds, self.stands, self.doubtful = None, False, False, False
        self._begin("", 0 if self.hands_off else 2)
        self.response = response

    def obeys(self, now):
        return self.obeys_stop

    def watched(self, now):
        return self.trouble is None and self.response == "HOLD" and self.steps == 0

    def undone(self, now):
        return ""

    def reachable(self, now):
        return self.trouble is None or self.trouble.which != "LINK_LOST"

    def in_doubt(self, now):
        return self.doubtful

    def pause(self, now):
        self._touch()
        self.holds = True

    def resume(self, now):
        self._touch()
        self.holds = False

    def paused(self, now):
        return self.stands

    def recover(self, passed, begun, now):
        self.holds, self.stands, self.trouble = False, False, None
        self._begin("recover", 2)
        return True

    def hindrance(self, passed, begun, now):
        return ""

    def away(self, now):
        return ""

    def moves(self, now):
        return self.armed

    def status(self):
        return {"armed": self.armed} if self.known(now=0.0) else {}


@dataclass
class World:
    """A clock that lets the next thing happen whenever the interpreter sleeps."""

    vehicles: dict[str, Vehicle]
    events: list[list[tuple[str, str]]]
    orders: Orders = field(default_factory=Orders)
    given: list[Order] = field(default_factory=list)
    answers: list[tuple[int, str, str | None]] = field(default_factory=list)
    time: float = 0.0
    looks: int = 0
    ends: int = 0
    passes_by_itself: bool = True

    def __post_init__(self):
        self.attention = Attention(self)

    def now(self):
        return self.time

    def wake(self):
        """Nobody sleeps here."""

    def sleep_until(self, until):
        while not self._turn() and until == inf:
            pass
        longest = 1.0 if self.looks < LOOKS else PATIENCE
        self.time = max(self.time + 1e-3, min(until, self.time + longest))

    def _turn(self) -> bool:
        """Have the next thing happen; return whether that wakes the interpreter."""
        if self.events:
            return any([self._happen(*each) for each in self.events.pop(0)])
        if self.looks < LOOKS:
            self.looks += 1
            for vehicle in self.vehicles.values():
                vehicle.doubtful = False
                self._happen("go on", "a")
                self._happen("go on", "b")
            return False
        assert [(order.kind, order.open) for order in self.given if order.open] == []
        self.ends += 1
        assert self.ends < 100, "the run does not end"
        for id, vehicle in self.vehicles.items():
            vehicle.steps, vehicle.trouble = 0, None
            self.attention.call(id)
        if self.ends == 1:
            self.orders.give(STOP, ROBOTS)
        return True

    def _happen(self, what: str, who: str) -> bool:
        vehicle = self.vehicles.get(who)
        if what in KINDS:
            self._order(what, ROBOTS if vehicle is None else (who,))
        elif what == "go on":
            before, _ = vehicle.steps, vehicle.go_on()
            if vehicle.steps != 0 or before == 0:
                return False
        elif what == "doubt":
            vehicle.doubtful = not vehicle.doubtful
            return False
        elif what == "done":
            if vehicle.at in ("walk", "rest"):
                vehicle.steps = 0
        else:
            vehicle.fail(what)
        self.attention.call(who)
        return True

    def _order(self, kind: str, robots: tuple[str, ...]) -> None:
        number = len(self.given)

        def told(id: str, why: str | None) -> None:
            if why is None:
                assert self._obeys(kind, self.vehicles[id]), (kind, vars(self.vehicles[id]))
            self.answers.append((number, id, why))

        self.given.append(self.orders.give(kind, robots, answered=told))

    def _obeys(self, kind: str, vehicle: Vehicle) -> bool:
        if kind == RESUME:
            return not (vehicle.stands or vehicle.holds) and (vehicle.armed or vehicle.at != "recover")
        if kind in (HOLD, STOP) and (vehicle.stands or (vehicle.response == "HOLD" and vehicle.obeys_stop)):
            return True
        wanted = (kind.upper(),) if kind in (RETURN, LAND) else ()
        return vehicle.is_down or (vehicle.response in wanted and vehicle.obeys_stop)


EVENTS = st.one_of(
    st.tuples(st.sampled_from(KINDS), st.sampled_from([*ROBOTS, "all"])),
    st.tuples(st.sampled_from([*FAULTS, "doubt", "done"]), st.sampled_from(ROBOTS)),
    st.tuples(st.just("go on"), st.sampled_from(ROBOTS)),
)


BEGUN = tuple(
    StepRecord("run-0", id, seq, seq, 0.0, label, move, detail, "")
    for id in ROBOTS
    for seq, (label, move, detail) in enumerate(
        [("begin", "start", ""), ("end", "start", ""), ("take", "start", "walk"), ("begin", "walk", "")]
    )
)
"""What the robots had done where their run was broken off before."""


AT_ONCE = st.lists(EVENTS, min_size=1, max_size=3)


@settings(max_examples=many(5_000))
@given(st.lists(AT_ONCE, max_size=12), *[st.booleans()] * 3)
def test_every_order_is_answered_once_and_confirmed_only_when_it_is_obeyed(events, armed, stays, resumed):
    vehicles = {id: Vehicle(armed=armed, stays_armed=stays) for id in ROBOTS}
    world = World(vehicles, list(events))
    terms = Terms(
        suspends=True,
        patience=PATIENCE,
        attention=world.attention,
        orders=world.orders,
        unready=resumed,
        resumed=BEGUN if resumed else (),
    )
    records, _ = carried_out(BEHAVIOUR, vehicles, clock=world, terms=terms)
    assert not [record for record in records if vehicles[record.robot].at == "absent"]
    asked = [(number, id) for number, order in enumerate(world.given) for id in order.robots]
    assert sorted((number, id) for number, id, _ in world.answers) == sorted(asked)
    for number, id, why in world.answers:
        overtaken_by, ordered, _ = (why or "").partition(" was ordered since")
        later = {order.kind for order in world.given[number + 1 :] if id in order.robots}
        assert not ordered or overtaken_by in later
