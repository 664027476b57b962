"""How the robots of a run are, for people who ask while it goes on."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from mmrs_core.contributions.abilities import Telling
from mmrs_core.contributions.backends import Backend
from mmrs_core.runtime.robot import RunningRobot
from mmrs_runtime.faults import LINK_LOST
from mmrs_runtime.phases import ENDED, LOST, SUSPENDED, WAITS, WORKS, answering, if_held


class Standing:
    """Knows how robots are, in the words of generated controllers; any thread may ask.

    Attributes:
        held: robots that are to be held as soon as they could begin.
    """

    def __init__(self) -> None:
        """Know of no robot yet."""
        self.held: Collection[str] = ()
        self._backends: Mapping[str, Backend] | None = None
        self._robots: Mapping[str, RunningRobot] = {}

    def connect(self, backends: Mapping[str, Backend]) -> None:
        """Take the backends of all robots that have something left to do."""
        self._backends = dict(backends)

    def begin(self, robots: Iterable[RunningRobot]) -> None:
        """Take the robots that now begin."""
        self._robots = {robot.id: robot for robot in robots}

    def status(self, robot: str) -> Mapping[str, object]:
        """Return what there is to say of a robot, as JSON has it."""
        running = self._robots.get(robot)
        backend = (self._backends or {}).get(robot)
        phase = self._phase(robot, running)
        held = running.held if running is not None else robot in self.held
        found: dict[str, object] = {"phase": if_held(phase) if held else phase}
        if running is not None:
            found["move"] = running.move.id
        if isinstance(backend, Telling):
            found |= backend.told()
        if running is not None and _responds(running, armed=found.get("armed") is True):
            found |= answering(running.halt.response)
        if running is not None and running.questions.asked:
            found["asks"] = running.questions.asked
        return found

    def _phase(self, robot: str, running: RunningRobot | None) -> str:
        if running is None:
            return WAITS if self._backends is None or robot in self._backends else ENDED
        if running.preparing:
            return WAITS
        if running.point.is_final or running.absent:
            return LOST if running.halt.is_for(LINK_LOST) else ENDED
        return SUSPENDED if running.suspended else WORKS


def _responds(robot: RunningRobot, *, armed: bool) -> bool:
    """Return whether a robot does, or is held by, what has broken its program off."""
    halt = robot.halt
    lost = halt.is_for(LINK_LOST) and not halt.stopping
    answers = halt.fault is not None and not robot.absent and not lost
    return answers and (halt.stopping or armed)
