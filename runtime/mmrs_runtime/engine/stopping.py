"""Robots that were ordered to stop, until each has confirmed it, or is known to be unable to."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf

from ..faults import BATTERY_LOW, LINK_LOST
from ..policies import CAME_DOWN_AWAY, COMES_DOWN, NOTHING
from ..vehicle import Fault, LinkLost
from .clocks import RunClock
from .event_queue import Until
from .life import PACE, Broken, Life, Waits
from .order_handling import OrderHandler

WATCH_PACE = 0.5
"""Seconds between two looks at a stopped robot that must be watched."""


class Stopping:
    """Has robots stop, and sees to it that they do; in simulated time they are taken at their word."""

    def __init__(
        self,
        robots: Sequence[Life],
        clock: RunClock,
        order_handler: OrderHandler,
        say: Callable[[Life, str], None],
    ) -> None:
        """Watch these robots; orders that stop them receive the outcome."""
        self._robots, self._clock, self._order_handler, self._say = robots, clock, order_handler, say
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
        """Return whether a stopped robot must be watched."""
        return any(self._needs_company(robot) for robot in self._robots)

    @property
    def came_down(self) -> Mapping[str, str]:
        """Return in words how robots came down that now wait for their batteries."""
        return {each.id: self._came_down[each.id] for each in self._robots if each.id in self._came_down}

    def answer(self, robot: Life, found: Fault) -> None:
        """Carry out the response that a robot decided on, and report why."""
        self._say(robot, f"{found}; response: {robot.halt.response}")
        robot.decided(found.which, found.reason, robot.halt.response)
        self.stop(robot, robot.halt.response)

    def stop(self, robot: Life, response: str) -> None:
        """Stop a robot with the given response."""
        robot.halt.response = response
        self._came_down.pop(robot.id, None)
        try:
            robot.vehicle.respond(response, self._clock.now())
        except LinkLost:
            self._unconfirmed[robot.id] = None
        else:
            if self._clock.passes_by_itself:
                robot.halt.begin()

    def stay_with(self, robot: Life) -> Waits:
        """Look after a robot whose program has ended, or is broken off, until it continues.

        Raises:
            Broken: an order is to end its program.
        """
        while robot.suspended or robot.point.is_final:
            if robot.ordered is not None:
                raise Broken(*robot.ordered)
            self.look_after(robot)
            yield Until(self._clock.now() + self._pace(robot))

    def _pace(self, robot: Life) -> float:
        """Return for how many seconds a robot need not be looked at."""
        if robot.halt.stopping:
            return PACE
        return WATCH_PACE if self._needs_company(robot) else inf

    def look_after(self, robot: Life) -> None:
        """Note whether a robot has confirmed that it stopped, or cannot, and what became of it since."""
        if robot.halt.stopping:
            self._see_stop(robot, self._clock.now())
        elif self._clock.passes_by_itself and robot.halt.fault and robot.halt.response != NOTHING:
            self._look_again(robot, self._clock.now())

    def _look_again(self, robot: Life, now: float) -> None:
        """Answer what overtakes a robot that has stopped, such as a pilot who takes it over."""
        try:
            robot.vehicle.look(now)
            trouble = robot.vehicle.trouble
        except LinkLost:
            return  # it has stopped, and its link was not needed any more
        if trouble is not None and robot.overtaken_by(trouble):
            self.answer(robot, trouble)
            return
        self._stay_if_lost(robot, trouble)
        self._tell_link(robot, reachable=robot.vehicle.reachable(now))

    def _stay_if_lost(self, robot: Life, trouble: Fault | None) -> None:
        """Listen for a robot whose link is lost, although it might have been left before that."""
        if trouble is None or trouble.which != LINK_LOST:
            self._listened_for.discard(robot.id)
        elif robot.id not in self._listened_for:
            self._listened_for.add(robot.id)
            self._unheard.add(robot.id)
            self._lost[robot.id] = None
            robot.halt.released = False

    def _tell_link(self, robot: Life, *, reachable: bool) -> None:
        if not reachable:
            self._unheard.add(robot.id)
        elif robot.id in self._unheard and self._needs_company(robot):
            self._say(robot, "link restored: orders are obeyed")
            self._unheard.discard(robot.id)

    def _see_stop(self, robot: Life, now: float) -> None:
        try:
            robot.vehicle.look(now)
            trouble = robot.vehicle.trouble
            stopping = trouble is None and not robot.vehicle.done
        except LinkLost as error:
            trouble, stopping = Fault(LINK_LOST, str(error)), False
        if not stopping:
            down = trouble is None and robot.halt.response in COMES_DOWN
            robot.halt.settle(down=down, at_rest=down and robot.rests)
        if trouble is not None and robot.overtaken_by(trouble):
            self.answer(robot, trouble)
            return
        if trouble is not None:
            self._say(robot, f"not known to have stopped ({robot.halt.response}): {trouble}")
            self._unconfirmed[robot.id] = None
            why = f"{robot.halt.response} cannot be carried out: {trouble.reason or trouble.which}"
            robot.decided(trouble.which, why, NOTHING)
            self._stay_if_lost(robot, trouble)
        elif not stopping:
            self._unconfirmed.pop(robot.id, None)
            self._say(robot, self._done(robot, now))
            if self._needs_company(robot) and robot.halt.response != NOTHING:
                self._say(robot, "is watched; interrupt to end")
            self._tell_battery(robot)
        self._order_handler.stopped(robot.id, stopping, trouble)

    def _done(self, robot: Life, now: float) -> str:
        """Return in words what a robot has done that has stopped."""
        if robot.halt.response == NOTHING:
            return "is left alone"
        if why := robot.vehicle.undone(now):
            return f"has not done {robot.halt.response}: {why}"
        return f"has done {robot.halt.response}"

    def _tell_battery(self, robot: Life) -> None:
        """Report the next step for a robot that landed for its battery."""
        if robot.suspended and robot.halt.is_for(BATTERY_LOW) and robot.halt.response in COMES_DOWN:
            words = self._came_down[robot.id] = _came_down(robot)
            self._say(
                robot,
                f"{words}; change it, order battery-changed if its charge does not rise, then resume,"
                " or start again with --resume",
            )

    def _needs_company(self, robot: Life) -> bool:
        """Return whether this process must not end yet, since the robot was not released."""
        halt = robot.halt
        return halt.fault is not None and not halt.released and robot.is_watched()


def _came_down(robot: Life) -> str:
    if why := robot.astray():
        return f"came down for its battery, but {why}"
    if robot.away():
        return CAME_DOWN_AWAY
    return f"came {'home' if robot.vehicle.comes_home else 'down'} for its battery"
