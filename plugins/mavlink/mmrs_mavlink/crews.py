"""The robots of a process: their inboxes, what is to be said of each, and which of them still work."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Mapping, Sequence

from mmrs_runtime.orders.orders import Inbox, Receipt
from mmrs_runtime.phases import ENDED, LOST, SUSPENDED, WAITS, WORKS, answering, if_held
from mmrs_runtime.questions import Questions
from mmrs_runtime.records.blackbox import plain

from .steps.journal import Journal
from .vehicles.vehicle import State


def told_of(state: State) -> dict[str, object]:
    """Return what there is to say of a vehicle's state, as JSON has it."""
    found = {
        "mode": state.mode,
        "armed": state.armed,
        "energy": state.energy,
        "place": state.place,
        "speed": round(state.speed, 2),
    }
    return {name: plain(value) for name, value in found.items()}


class Crews:
    """Keeps account of the robots of one process; any thread may ask.

    Attributes:
        inboxes: by robot. questions: that its choices ask, by robot.
        wake: by robot, what ends the present wait at once.
        held: by robot, tells whether it is held, or is to be.
    """

    def __init__(
        self, robots: Sequence[str], conditions: Mapping[str, Collection[str]] | None = None
    ) -> None:
        """Have all of them wait for their vehicles; `conditions`: of their choices, by robot."""
        asked = conditions or {}
        self.questions = {robot: Questions(asked.get(robot, ())) for robot in robots}
        self.wake: dict[str, Callable[[], None]] = {}
        self.held: dict[str, Callable[[], bool]] = {}
        self.inboxes = {robot: self._inbox(robot) for robot in robots}
        self._phases = dict.fromkeys(robots, WAITS)
        self._manned: dict[str, tuple[Callable[[], State], Journal]] = {}
        self._lock = threading.Lock()

    def man(self, robot: str, state: Callable[[], State], journal: Journal) -> None:
        """Have a robot work: with a vehicle, and somebody who writes down what it does."""
        self._manned[robot] = (state, journal)
        self.engage(robot)

    def engage(self, robot: str) -> None:
        """Have a robot work, or work again."""
        if robot in self._manned:
            self._manned[robot][1].response = ""
        self._enter(robot, WORKS)

    def suspend(self, robot: str) -> None:
        """Have a robot wait for its battery."""
        self._enter(robot, SUSPENDED)

    def lose(self, robot: str) -> None:
        """Have a robot that is out of reach wait for orders, without counting as one that works."""
        self._enter(robot, LOST)

    def dismiss(self, robot: str) -> None:
        """Have a robot work no more; whatever it is told is refused."""
        self._enter(robot, ENDED)
        self.inboxes[robot].close("its program has ended")

    def others_work(self, robot: str) -> bool:
        """Return whether another robot has not yet ended, and does not wait for its battery."""
        with self._lock:
            return any(phase in (WAITS, WORKS) for other, phase in self._phases.items() if other != robot)

    def status(self, robot: str) -> Mapping[str, object]:
        """Return what there is to say of a robot, as JSON has it."""
        held = robot in self.held and self.held[robot]()
        phase = if_held(self._phases[robot]) if held else self._phases[robot]
        if robot not in self._manned:
            return {"phase": phase}
        told, journal = self._manned[robot]
        found: dict[str, object] = {"phase": phase, "move": journal.move, **told_of(told())}
        if phase == WORKS and journal.response:
            found |= answering(journal.response)
        asked = self.questions[robot].asked
        found |= ({"asks": asked} if asked else {}) | (
            {"reported": journal.reported} if journal.reported else {}
        )
        return {name: plain(value) for name, value in found.items()}

    def _enter(self, robot: str, phase: str) -> None:
        with self._lock:
            self._phases[robot] = phase

    def _inbox(self, robot: str) -> Inbox:
        def arrived() -> None:
            if robot in self.wake:
                self.wake[robot]()

        def answered(receipt: Receipt) -> None:
            if robot in self._manned:
                self._manned[robot][1].ordered(receipt)

        return Inbox(robot, questions=self.questions[robot], arrived=arrived, answered=answered)
