"""Runs in real time, with robots that do each thing for as long as a test says."""

import threading
import time
from dataclasses import replace
from math import inf

from mmrs_core.behaviour.program import Move
from mmrs_core.contributions.execution import Fault, RobotState
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_core.errors import MmrsError
from mmrs_core.simulation.live import live_run_for, run_live
from mmrs_core.simulation.run import inputs_of
from mmrs_core.testing.small_programs import ROBOT_TYPE, hold, program, robot, robot_type
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.orders.orders import STOP, Orders
from mmrs_runtime.slots import LocalSlots
from mmrs_runtime.vehicle import Vehicle

FAST = 100.0


class Idle(Vehicle):
    """What any robot of a test says that has no events of its own.

    Attributes:
        charge: part of its battery that is left; None: unknown.
    """

    charge: float | None = None
    comes_home = pauses = True

    def state(self, now):
        return RobotState(now, (0.0, 0.0, 0.0), 0.0, 0.0, None, charge=self.charge)


class Walker(Idle):
    """A robot that does each thing until it is told that it is done; it wakes the engine itself."""

    def __init__(self, given: VehicleInput, script):
        self.given, self.script = given, script
        self.done, self.trouble, self.stops, self.begun = True, None, [], []
        self.halted = self.closed = self.watched_for = self.doubted = False
        self.recovered, self.astray, self.heard, self.armed = None, "", True, True
        self.elsewhere = ""
        self.recognised = False
        self.changes = 0
        self.noted = []
        script.robots[given.robot.id] = self

    @property
    def charge(self):
        return self.script.charge

    def _go(self, what):
        self.begun.append(what)
        seconds = self.script.seconds.get(what, 0.0)
        self.done = seconds == 0.0
        if 0.0 < seconds < inf:
            threading.Timer(seconds, self._finish, (what,)).start()

    def _finish(self, what):
        if self.begun[-1] == what:
            self.done = True
            self.given.live.wake()

    def fail(self, which):
        self.trouble = Fault(which, "says the test")
        self.given.live.wake()

    def prepare(self, now):
        self._go("ready")
        return True

    def known(self, now):
        return self.recognised

    def do(self, order, now, *, through=False):
        self._go(order.id if isinstance(order, Move) else order.name)

    def respond(self, response, now):
        self.stops.append(response)
        self.trouble, self.halted = None, False
        self._go(f"stop {response}")

    def obeys(self, now):
        return self.begun[-1].startswith("stop") and not self.undone(now)

    def in_doubt(self, now):
        return self.doubted or (self.trouble is not None and self.trouble.which == "TAKEN_OVER")

    def watched(self, now):
        return self.watched_for and (self.trouble is None or self.trouble.which == "LINK_LOST")

    def undone(self, now):
        return self.astray if self.stops[-1:] == ["RETURN"] else ""

    def reachable(self, now):
        return self.heard

    def hindrance(self, passed, begun, now):
        return self.astray

    def away(self, now):
        return self.elsewhere

    def moves(self, now):
        return self.armed

    def status(self):
        return {"armed": self.armed} if self.armed is not None else {}

    def change_battery(self, now):
        self.changes += 1

    def battery_change(self, now):
        return self.script.battery_change

    def pause(self, now):
        self.halted = True

    def resume(self, now):
        self.halted = False

    def paused(self, now):
        return self.halted

    def recover(self, passed, begun, now):
        self.recovered = (tuple(passed), begun)
        self._go("recovered")
        return True

    def note(self, kind, content):
        self.noted.append((kind, dict(content)))

    def close(self):
        self.closed = True


class Script:
    """How long things take, in real seconds; what is not named takes none, and inf never ends."""

    def __init__(self, **seconds):
        self.seconds = {name.replace("_", " "): value for name, value in seconds.items()}
        self.robots, self.charge, self.battery_change = {}, 0.5, ""

    @property
    def factory(self):
        return VehicleFactory("walker", "a robot of the test", lambda given: Walker(given, self))


class Flight:
    """A run in a thread of its own."""

    def __init__(self, behaviour, script, kinds, speedup=1.0, here=None, **more):
        self.behaviour, self.script, self.records, self.said = behaviour, script, [], []
        self.orders = Orders()
        inputs = inputs_of(TargetInput(behaviour, {ROBOT_TYPE: robot_type()}, **kinds), {})
        inputs = {id: given for id, given in inputs.items() if here is None or id in here}
        factory = script.factory if isinstance(script, Script) else script
        given = {"bus": LocalSlots(behaviour.executable), "conditions": {}, **more}
        kept = given.pop("observe", None)

        def observe(record):
            if kept is not None:
                kept(record)
            self.records.append(record)

        self.live_run = replace(
            live_run_for(behaviour, inputs, factory, given.pop("bus"), given.pop("conditions")),
            clock=RealClock(speedup),
            orders=self.orders,
            say=self.said.append,
            observe=observe,
            **given,
        )
        self.ending = self.error = None
        self._thread = threading.Thread(target=self._go, daemon=True)
        self._thread.start()

    def _go(self):
        try:
            self.ending = run_live(self.live_run)
        except (MmrsError, KeyboardInterrupt) as error:
            self.error = error

    def wait_for(self, test, seconds=20.0):
        until = time.monotonic() + seconds
        while not test():
            assert time.monotonic() < until, (self.shown(), self.said)
            time.sleep(0.002)

    def wait_for_step(self, words):
        self.wait_for(lambda: words in self.shown())

    def shown(self):
        return [f"{r.robot} {r.label} {r.move} {r.detail}".strip() for r in list(self.records)]

    def order(self, kind, *robots):
        order = self.orders.give(kind, robots or [each.id for each in self.behaviour.robots])
        assert order.settled.wait(20.0), (kind, order.open)
        return order

    def end(self, seconds=20.0):
        self._thread.join(seconds)
        assert not self._thread.is_alive(), (self.shown(), self.said)
        return self.ending

    def abort(self):
        """End the thread of a test that has failed, or does not wait for the end."""
        if isinstance(self.script, Script):
            self.script.seconds.clear()
        while self._thread.is_alive():
            self.orders.give(STOP, [each.id for each in self.behaviour.robots])
            for each in self.script.robots.values() if isinstance(self.script, Script) else ():
                each._finish(each.begun[-1])
            self._thread.join(0.2)


def do(id, **more):
    """Return a move that may last as long, or as short, as it likes."""
    return hold(id, 0.0, **more)


WALK = program(robot("r", [do("walk"), do("rest")]))


TWO = program(robot("a", [do("walk")]), robot("b", [do("walk")]))


def walking(live, **seconds):
    """Return a run whose robot walks until it is told otherwise, and the robot."""
    run = live(WALK, Script(walk=inf, **seconds))
    run.wait_for_step("r begin walk")
    return run, run.script.robots["r"]
