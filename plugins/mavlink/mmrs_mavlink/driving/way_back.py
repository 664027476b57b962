"""The return to where a robot's program was broken off: along its own path, which is known to be clear."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

from mmrs_runtime.controllers.geodesy import at_height, distance_to_leg, ends_of
from mmrs_runtime.faults import BATTERY_LOW, FaultError, RefusedError
from mmrs_runtime.policies import CONTINUE, NOTHING, still_low

from ..program import GoTo, Land, Place, Recharge, Robot, Start, TakeOff
from ..steps.responses import policy_for
from ..vehicles.footing import aside, footing, misplaced, there
from ..vehicles.vehicle import Vehicle
from .cameras import Cameras
from .moves import IN_THE_AIR, Moves
from .worker import Job

Point = tuple[str, Place]


class WayBack:
    """Finds the path from a vehicle's position to the beginning of a leg of its program."""

    def __init__(
        self, robot: Robot, moves: Moves, vehicle: Vehicle, cameras: Cameras, home_tolerance: float
    ) -> None:
        """Find ways for that vehicle; on the ground it may be that far from where it is to stand, metres."""
        self._robot, self._moves, self._vehicle, self._cameras = robot, moves, vehicle, cameras
        self._tolerance = home_tolerance
        self._steps = {step.move: step for step in robot.steps}

    def job(self, passed: Sequence[str], begun: str) -> Job:
        """Return what brings the vehicle to where it can begin its next move.

        A vehicle on the ground where its sortie began takes off and retraces its path. One that is in the
        air, on its path or ahead on the run that it had begun, continues along that path. On the leg that it
        had begun, it ends the leg from where it is, since a car that turns round leaves its line; where a
        camera works along the leg, it goes back to the beginning, so that no image is missed. One that is
        anywhere else is refused, since no path from there is verified; if its autopilot has begun to bring
        it home or down, it is left to that.

        If it is disarmed, the battery must not be low, unless a policy tolerates that.

        Args:
            passed: moves that the robot has ended, in order.
            begun: the move that it will begin once more; may be empty.
        """
        job = Job()

        def set_out() -> None:
            try:
                parts = self._parts(passed, begun)
            except RefusedError as why:
                if self._vehicle.state().armed and self._vehicle.returns_alone:
                    raise FaultError(why.event, f"{why}; its failsafe continues", NOTHING) from None
                raise
            if parts:
                self._refuse_low()
            job.then(*parts)

        job.append(set_out)
        return job

    def check(self, passed: Sequence[str], begun: str) -> None:
        """Check that there is a return path, without a command to the vehicle.

        Where an object has yet to be found, there may be one; it is looked for when the vehicle sets out.

        Raises:
            RefusedError: there is no verified one.
        """
        if not all(self._moves.knows(move) for move in (*passed, *self._run(begun))):
            return
        track = self._moves.track
        self._parts(passed, begun)
        self._moves.track = track

    def know(self, passed: Sequence[str], begun: str) -> None:
        """Restore the positions by which a flying vehicle can return: those passed in this sortie.

        Raises:
            RefusedError: it is not on its path.
        """
        self._parts(passed, begun)

    def starts(self, passed: Sequence[str], begun: str) -> tuple[Place, ...]:
        """Return where the vehicle may stand: where its sortie began, or where it was to land last."""
        ends = [passed[: len(passed) - len(sortie_of(self._robot, passed))]]
        if self._lands(begun):
            ends.append([*passed, begun])
        return tuple(footing(self._robot.home, self._start(moves)) for moves in ends)

    def _run(self, begun: str) -> tuple[str, ...]:
        """Return the moves of the run that a move belongs to, or only itself, if there is one."""
        alone = (begun,) if begun else ()
        return next((run.moves for run in self._robot.runs if begun in run.moves), alone)

    def _lands(self, move: str) -> bool:
        return bool(move) and self._moves.kind(move) is Land

    def _is_down(self, passed: Sequence[str], begun: str) -> bool:
        """Return whether the vehicle stands where it was to land, or is about to."""
        state = self._vehicle.state()
        if not self._lands(begun) or (state.armed and state.place.height > IN_THE_AIR):
            return False
        place = state.place if state.armed else self._vehicle.start
        return aside(place, self._start([*passed, begun])) <= OFF_ITS_WAY

    def _parts(self, passed: Sequence[str], begun: str) -> list[Callable[[], None]]:
        if self._is_down(passed, begun):
            return []
        sortie = sortie_of(self._robot, passed)
        start = self._start(passed[: len(passed) - len(sortie)])
        state = self._vehicle.state()
        here, low = state.place, not state.armed or state.place.height <= IN_THE_AIR
        came = list(self._places(start, sortie))
        if not came:
            if begun and self._moves.kind(begun) is GoTo and self._astray(start, here):
                self._leg(here, [start, *way_ahead(self._robot, begun, start, self._moves.target_of)])
            else:
                self._refuse_astray(start, here)
            return []
        first = self._steps[sortie[0]].movement
        if isinstance(first, TakeOff) and low:
            self._refuse_astray(start, here)
            height = first.height
            return [lambda: self._moves.climb(sortie[0], height), *self._legs(came[1:])]
        last = came[-1][1]
        ahead = way_ahead(self._robot, begun, last, self._moves.target_of) if begun else ()
        leg = self._leg(here, [start, *(place for _, place in came), *ahead])
        if leg < len(came):
            self._moves.track = came[:leg]
            return self._legs(came[leg:])
        if leg == len(came) and not self._cameras.work:
            self._moves.track = came
            return []
        run = self._run(begun)
        flown = list(self._places(last, run[run.index(begun) :]))[: leg - len(came)] if begun else []
        self._moves.track = [*came, *flown]
        return self._legs_back(came, flown)

    def _start(self, before: Sequence[str]) -> Place:
        """Return where a sortie begins: at home, or where the robot has landed before by its program."""
        here = self._robot.home
        for move in before:
            movement = self._steps[move].movement
            if isinstance(movement, Start):
                here = self._robot.home
            elif isinstance(movement, Land):
                here = at_height(here, self._robot.home.height)
            else:
                here = next((place for _, place in reversed(list(self._places(here, [move])))), here)
        return here

    def _leg(self, here: Place, way: Sequence[Place]) -> int:
        """Return on which leg of its path a vehicle is; of two, the later one."""
        gaps = [distance_to_leg(here, *leg) for leg in pairwise(way)]
        nearest = max(range(len(gaps)), key=lambda leg: (-round(gaps[leg] / ALIKE), leg))
        if gaps[nearest] > OFF_ITS_WAY:
            home = self._robot.home
            back = there(footing(home, way[0]), home)
            raise RefusedError(
                f"it is {gaps[nearest]:.0f} m off its path: bring it {back} before it continues"
            )
        return nearest

    def _legs_back(self, came: list[Point], flown: list[Point]) -> list[Callable[[], None]]:
        """Return the legs back from places that were flown past to the last of those that count as passed."""

        def leg(kept: list[Point]) -> Callable[[], None]:
            move, place = kept[-1]

            def go() -> None:
                self._vehicle.go_to(place, self._moves.speed_of(move), None, False)
                self._moves.track = kept

            return go

        return [leg([*came, *flown[:count]]) for count in range(len(flown), -1, -1)]

    def _places(self, here: Place, moves: Sequence[str]) -> Iterator[Point]:
        for move in moves:
            movement = self._steps[move].movement
            if isinstance(movement, TakeOff):
                here = at_height(here, self._moves.above_home(movement.height).height)
                yield move, here
            elif isinstance(movement, GoTo):
                target = self._moves.target_of(movement)
                for end in ends_of(here, target, movement.legs, movement.distance):
                    here = end
                    yield move, end

    def _legs(self, way: Sequence[Point]) -> list[Callable[[], None]]:
        def leg(move: str, place: Place) -> Callable[[], None]:
            def go() -> None:
                self._vehicle.go_to(place, self._moves.speed_of(move), None, False)
                self._moves.track.append((move, place))

            return go

        return [leg(move, place) for move, place in way]

    def _refuse_low(self) -> None:
        state = self._vehicle.state()
        why = "" if state.armed else still_low(state.energy, self._robot.reserve)
        if why and policy_for(BATTERY_LOW, self._robot).response != CONTINUE:
            raise FaultError(BATTERY_LOW, why)

    def _astray(self, start: Place, here: Place) -> str:
        return misplaced(self._robot.home, footing(self._robot.home, start), here, self._tolerance)

    def _refuse_astray(self, start: Place, here: Place) -> None:
        if why := self._astray(start, here):
            raise RefusedError(why)


def sortie_of(robot: Robot, passed: Sequence[str]) -> tuple[str, ...]:
    """Return the moves since the robot stood where its batteries can be changed, the last of them last."""
    steps = {step.move: step.movement for step in robot.steps}
    begin = 0
    for index, move in enumerate(passed):
        movement = steps[move]
        if isinstance(movement, Land | Recharge | Start):
            begin = index + 1
        elif isinstance(movement, TakeOff):
            begin = index
    return tuple(passed[begin:])


OFF_ITS_WAY = 5.0
"""Metres that a robot may be from the path of its program to continue in the air."""

ALIKE = 0.1
"""Metres by which one leg must be nearer than another to count as that: of two, the later one is meant."""


def way_ahead(robot: Robot, move: str, here: Place, locate: Callable[[GoTo], Place]) -> tuple[Place, ...]:
    """Return the ends of the legs that a vehicle may be on without another command of its program.

    Args:
        robot: whose program it is.
        move: that was in progress.
        here: where that move began.
        locate: finds where a movement leads to.
    """
    run = next((run.moves for run in robot.runs if move in run.moves), (move,))
    ahead: list[Place] = []
    for each in run[run.index(move) :]:
        begun, movement = ahead[-1] if ahead else here, robot.step(each).movement
        if isinstance(movement, TakeOff):
            ahead.append(at_height(begun, movement.height))
        elif isinstance(movement, Land):
            ahead.append(at_height(begun, robot.home.height))
        elif isinstance(movement, GoTo):
            ahead += ends_of(begun, locate(movement), movement.legs, movement.distance)
    return tuple(ahead)
