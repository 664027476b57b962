"""Robots that were told to stop, until each has confirmed that it has, or is known to be unable to."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from mmrs_core.contributions.abilities import Noting, Recovering, Watched
from mmrs_core.contributions.execution import Clock, Fault
from mmrs_core.errors import LinkLostError
from mmrs_core.runtime.obedience import Obedience
from mmrs_core.runtime.robot import RunningRobot
from mmrs_runtime.faults import BATTERY_LOW, LINK_LOST
from mmrs_runtime.policies import CAME_DOWN_AWAY, COMES_DOWN, NOTHING


class Stopping:
    """Has robots stop, and sees to it that they do; in simulated time they are taken at their word."""

    def __init__(
        self,
        robots: Sequence[RunningRobot],
        clock: Clock,
        obedience: Obedience,
        say: Callable[[str], None],
    ) -> None:
        """Look after these robots; orders that stop them are told what became of it."""
        self._robots, self._clock, self._obedience, self._say = robots, clock, obedience, say
        self._unconfirmed: dict[str, None] = {}
        self._came_down: dict[str, str] = {}
        self._unheard: set[str] = set()
        self._listened_for: set[str] = set()
        self._lost: dict[str, None] = {}

    @property
    def unconfirmed(self) -> tuple[str, ...]:
        """Return the robots that have not confirmed that they stopped, and will not."""
        return tuple(self._unconfirmed)

    @property
    def lost(self) -> tuple[str, ...]:
        """Return the robots whose links were lost after their programs had ended, or were broken off."""
        return tuple(self._lost)

    @property
    def busy(self) -> bool:
        """Return whether a robot has still to confirm."""
        return any(robot.halt.stopping for robot in self._robots)

    @property
    def watching(self) -> bool:
        """Return whether a robot has stopped in a way that somebody must watch."""
        return any(self._needs_company(robot) for robot in self._robots)

    @property
    def came_down(self) -> Mapping[str, str]:
        """Return in words how robots came down that now wait for their batteries."""
        return {each.id: self._came_down[each.id] for each in self._robots if each.id in self._came_down}

    def answer(self, robot: RunningRobot, found: Fault) -> None:
        """Have a robot give the response that it decided on, and tell people why."""
        self._say(f"'{robot.id}': {found}; response: {robot.halt.response}")
        _note(robot, found.which, found.reason, robot.halt.response)
        self.stop(robot, robot.halt.response)

    def stop(self, robot: RunningRobot, response: str) -> None:
        """Have a robot stop in some way."""
        robot.halt.response = response
        self._came_down.pop(robot.id, None)
        try:
            robot.backend.stop(self._clock.now(), response)
        except LinkLostError:
            self._unconfirmed[robot.id] = None
        else:
            if self._clock.passes_by_itself:
                robot.halt.begin()

    def look_after(self) -> None:
        """Note which robots have confirmed that they stopped, or cannot, and what became of them since."""
        for robot in self._robots:
            if robot.halt.stopping:
                self._look_after(robot, self._clock.now())
            elif self._clock.passes_by_itself and robot.halt.fault and robot.halt.response != NOTHING:
                self._look_again(robot, self._clock.now())

    def _look_again(self, robot: RunningRobot, now: float) -> None:
        """Answer what overtakes a robot that has stopped, such as a pilot who takes it over."""
        try:
            trouble = robot.backend.fault(now)
        except LinkLostError:
            return  # it has stopped, and its link was not needed any more
        if trouble is not None and robot.overtaken_by(trouble):
            self.answer(robot, trouble)
            return
        self._stay_if_lost(robot, trouble)
        if isinstance(robot.backend, Watched):
            self._tell_link(robot, heard=robot.backend.reachable(now))

    def _stay_if_lost(self, robot: RunningRobot, trouble: Fault | None) -> None:
        """Listen for a robot whose link is lost, although it might have been left before that."""
        if trouble is None or trouble.which != LINK_LOST:
            self._listened_for.discard(robot.id)
        elif robot.id not in self._listened_for:
            self._listened_for.add(robot.id)
            self._unheard.add(robot.id)
            self._lost[robot.id] = None
            robot.halt.released = False

    def _tell_link(self, robot: RunningRobot, *, heard: bool) -> None:
        if not heard:
            self._unheard.add(robot.id)
        elif robot.id in self._unheard and self._needs_company(robot):
            self._say(f"'{robot.id}': is heard again: orders are obeyed")
            self._unheard.discard(robot.id)

    def _look_after(self, robot: RunningRobot, now: float) -> None:
        try:
            trouble = robot.backend.fault(now)
            stopping = trouble is None and not robot.backend.finished(now)
        except LinkLostError as error:
            trouble, stopping = Fault(LINK_LOST, str(error)), False
        if not stopping:
            down = trouble is None and robot.halt.response in COMES_DOWN
            robot.halt.settle(down=down, at_rest=down and robot.rests)
        if trouble is not None and robot.overtaken_by(trouble):
            self.answer(robot, trouble)
            return
        if trouble is not None:
            self._say(f"'{robot.id}': not known to have stopped ({robot.halt.response}): {trouble}")
            self._unconfirmed[robot.id] = None
            why = f"{robot.halt.response} cannot be carried out: {trouble.reason or trouble.which}"
            _note(robot, trouble.which, why, NOTHING)
            self._stay_if_lost(robot, trouble)
        elif not stopping:
            self._unconfirmed.pop(robot.id, None)
            self._say(f"'{robot.id}': {self._done(robot, now)}")
            self._tell_battery(robot, now)
        self._obedience.stopped(robot.id, stopping, trouble)

    def _done(self, robot: RunningRobot, now: float) -> str:
        """Return in words what a robot has done that has stopped."""
        if robot.halt.response == NOTHING:
            return "is left alone"
        if isinstance(robot.backend, Watched) and (why := robot.backend.undone(now)):
            return f"has not done {robot.halt.response}: {why}"
        return f"has done {robot.halt.response}"

    def _tell_battery(self, robot: RunningRobot, now: float) -> None:
        """Tell what is to be done for a robot that came down for its battery."""
        if robot.suspended and robot.halt.is_for(BATTERY_LOW) and robot.halt.response in COMES_DOWN:
            words = self._came_down[robot.id] = _came_down(robot, now)
            self._say(f"'{robot.id}': {words}; change it, then order resume, or start again with --resume")

    def _needs_company(self, robot: RunningRobot) -> bool:
        """Return whether this process must not end yet, since nobody has said that it may leave the robot."""
        halt = robot.halt
        return halt.fault is not None and not halt.released and robot.is_watched(self._clock.now())


def _note(robot: RunningRobot, what: str, why: str, response: str) -> None:
    if isinstance(robot.backend, Noting):
        robot.backend.note("decision", {"what": what, "why": why, "response": response})


def _came_down(robot: RunningRobot, now: float) -> str:
    if why := robot.astray(now):
        return f"came down for its battery, but {why}"
    if robot.away(now):
        return CAME_DOWN_AWAY
    return f"came {'home' if isinstance(robot.backend, Recovering) else 'down'} for its battery"
