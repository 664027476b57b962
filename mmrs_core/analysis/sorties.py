"""How long robots run on one charge: from a launch, or from full batteries, until they are full again.

The most is what may be used in some run, and has no bound behind a loop or a wait without one. The least
is what is used in every run that comes to a move; it needs no such bound.

A robot that launches uses its batteries while it is off the ground; it may wait on the ground as long
as it likes. Any other robot uses them from the mission's start on. Waiting for other robots counts.
A `Recharge` fills the batteries; landing alone does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from math import inf

from mmrs_core.analysis.dependencies import goes_round
from mmrs_core.analysis.durations import Duration
from mmrs_core.analysis.figures import MissingFigureError
from mmrs_core.analysis.states import GROUNDED, States, possible_states, states_of
from mmrs_core.analysis.times import Times, times_of
from mmrs_core.analysis.verdicts import UnknownMove
from mmrs_core.behaviour.program import BEHAVIOUR, RobotProgram, Transition
from mmrs_core.behaviour.walk import components, successors
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene import Name

RECHARGE: Name = (BEHAVIOUR, "Recharge")


@dataclass(frozen=True, slots=True)
class Running:
    """How long a robot has run on its charge at most.

    Attributes:
        used: seconds.
        before: what it had used at most when the present stretch of running began.
        since: when that stretch began, at the earliest; None while it does not run.
    """

    used: float = 0.0
    before: float = 0.0
    since: float | None = None


@dataclass(frozen=True, slots=True)
class ChargeUse:
    """Seconds on one charge until a move has ended, and the wait after it is over."""

    move: int
    seconds: float


@dataclass(frozen=True, slots=True)
class Sorties:
    """The use at each move that is made.

    Attributes:
        uses: the most, of moves that run on batteries and have a bound. gaps: what has none, and why.
        least: the least with which any run comes past the move.
    """

    uses: tuple[ChargeUse, ...]
    gaps: tuple[UnknownMove, ...]
    least: tuple[ChargeUse, ...]


def sorties_of(input: CheckInput, robot: RobotProgram) -> Sorties:
    """Return how long one robot runs on each charge, at most and at least.

    Where it is unknown whether it launches, it is a gap, and the least is what holds either way.
    """
    times = times_of(input)
    try:
        states = states_of(input, robot)
    except MissingFigureError as missing:
        gap = UnknownMove(robot.start, str(missing).removeprefix(f"{robot.id}: "))
        return Sorties((), (gap,), _least_uses(robot, possible_states(input, robot), times))
    uses, gaps = _Walk(robot, states, times).run()
    return Sorties(uses, gaps, _least_uses(robot, states, times))


def _least_uses(robot: RobotProgram, states: States, times: Times) -> tuple[ChargeUse, ...]:
    """Return the least use at each move that some run comes to: the shortest of all paths since a charge.

    Dijkstra's algorithm, from the start and every Recharge at once.
    """
    found: dict[int, float] = {}
    charges = [move for move in states.before if robot.moves[move].is_a(RECHARGE)]
    pending = [(0.0, move) for move in (robot.start, *charges)]
    heapify(pending)
    while pending:
        used, move = heappop(pending)
        if move in found or (robot.id, move) not in times.earliest:
            continue
        if move not in charges:
            used += _least_run(times.durations[robot.id].of[move], states, move)
        transition = robot.transitions.get(move)
        if transition is not None and GROUNDED not in states.after[move]:
            release = times.earliest_release(robot, transition.waits)
            used += max(0.0, release - times.latest_end(robot.id, move))
        found[move] = used
        for after in transition.next_moves if transition else ():
            heappush(pending, (used, after))
    return tuple(ChargeUse(move, seconds) for move, seconds in found.items())


def _least_run(duration: Duration, states: States, move: int) -> float:
    """Return how long a move runs on batteries at least; actions on the ground do not count."""
    rests, lands = GROUNDED in states.before[move], GROUNDED in states.after[move]
    if rests and lands:
        return 0.0
    end = duration.moved.low if lands else duration.whole.low
    return end - (duration.before.low if rests else 0.0)


class _Walk:
    """One pass over a robot's moves, each after all that lead to it."""

    def __init__(self, robot: RobotProgram, states: States, times: Times) -> None:
        self.robot = robot
        self.states = states
        self.times = times
        self.durations = times.durations[robot.id]
        self.gaps: dict[int, UnknownMove] = {}
        self.uses: list[ChargeUse] = []
        self.arrivals: dict[int, list[Running]] = {robot.start: [Running()]}

    def run(self) -> tuple[tuple[ChargeUse, ...], tuple[UnknownMove, ...]]:
        graph = successors(self.robot)
        for group in reversed(components(graph)):
            if goes_round(group, graph):
                self._loop(group)
                continue
            for move in group:
                if move in self.states.before:
                    self._pass(move, _merged(self.arrivals.get(move, [])))
        return tuple(self.uses), tuple(self.gaps[move] for move in sorted(self.gaps))

    def _loop(self, group: tuple[int, ...]) -> None:
        """Let a robot out of a loop with no bound on what it has used, unless it stands meanwhile."""
        inside = [move for move in group if move in self.states.before]
        running = [move for move in inside if self._runs(move)]
        arrived = _merged([each for move in inside for each in self.arrivals.get(move, [])])
        if running:
            names = ", ".join(f"'{self.robot.moves[move].id}'" for move in inside)
            self.gaps[running[0]] = UnknownMove(
                running[0], f"nothing bounds how often the loop {names} is made"
            )
            arrived = Running(inf, inf, 0.0)
        for move in inside:
            self._leave(move, arrived)

    def _pass(self, move: int, running: Running) -> None:
        begin = self.times.earliest.get((self.robot.id, move))
        if begin is None:
            return
        if self._runs(move):
            since = begin if running.since is None else running.since
            before = running.used if running.since is None else running.before
            used = running.used + self.durations.of[move].whole.high
            running = Running(used, before, since)
        if self.robot.moves[move].is_a(RECHARGE):
            running = Running()
        if self.states.after[move] == {GROUNDED}:
            running = Running(running.used, running.used)
        elif running.since is None:
            running = Running(running.used, running.used, self.times.earliest_end(self.robot.id, move))
        self._leave(move, running)

    def _leave(self, move: int, running: Running) -> None:
        transition = self.robot.transitions.get(move)
        if transition is not None and transition.waits and running.since is not None:
            running = self._waited(move, running, transition)
        if self._runs(move):
            self._note(move, running)
        for after in transition.next_moves if transition else ():
            self.arrivals.setdefault(after, []).append(running)

    def _waited(self, move: int, running: Running, transition: Transition) -> Running:
        """Return the use after a wait, by the smaller of two bounds.

        The wait is no longer than from the earliest end of the move to the latest release; and the
        stretch that the robot is in is no longer than from its earliest begin to that.
        """
        release = self.times.latest_release(self.robot, transition.waits)
        if release == inf and running.used < inf:
            slots = ", ".join(self._awaited(slot) for slot in transition.waits)
            self.gaps[move] = UnknownMove(move, f"nothing bounds how long it then waits for {slots}")
            self._note(move, running)
        waited = running.used + max(0.0, release - self.times.earliest_end(self.robot.id, move))
        since = running.since or 0.0
        whole = max(running.used, running.before + max(0.0, release - since))
        return Running(min(waited, whole), running.before, running.since)

    def _awaited(self, slot: str) -> str:
        activations = self.times.dependencies.activations_of((self.robot.id, slot))
        givers = dict.fromkeys(each.at[0] for each in activations)
        return f"'{slot}' from {' or '.join(givers)}" if givers else f"'{slot}'"

    def _note(self, move: int, running: Running) -> None:
        if running.used < inf:
            self.uses.append(ChargeUse(move, running.used))
        elif not self.gaps:
            self.gaps[move] = self._reason(move)

    def _reason(self, move: int) -> UnknownMove:
        known = next(iter(self.durations.gaps), None)
        return known or UnknownMove(move, "its duration is unknown")

    def _runs(self, move: int) -> bool:
        return not self.states.only_grounded(move)


def _merged(arrivals: list[Running]) -> Running:
    """Return a bound on all paths on which a move is reached."""
    begun = [each.since for each in arrivals if each.since is not None]
    return Running(
        used=max((each.used for each in arrivals), default=0.0),
        before=max((each.before for each in arrivals), default=0.0),
        since=min(begun, default=None),
    )
