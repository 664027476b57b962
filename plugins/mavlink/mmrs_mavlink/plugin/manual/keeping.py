"""The black box of an underwater vehicle whose behaviour is interpreted."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mmrs_core.contributions.execution import RobotState
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_runtime.records.blackbox import BlackBox, black_box_path
from mmrs_runtime.records.steps import log_name

FIX = 0.2
"""Seconds between two places in the black box."""


class Keeper:
    """Keeps a black box, where there is one."""

    def __init__(self, box: BlackBox | None, place: Callable[[RobotState], Mapping[str, float]]) -> None:
        """Keep what a robot tells; `place`: where it is, as black boxes have it."""
        self._box, self._place = box, place
        self._fixed = float("-inf")

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something."""
        if self._box is not None:
            self._box.write(kind, **content)

    def seen(self, state: RobotState) -> None:
        """Keep where the robot is, now and then."""
        if state.time - self._fixed >= FIX and state.charge is not None:
            self._fixed = state.time
            self.note(
                "fix",
                {
                    "place": self._place(state),
                    "speed": round(state.speed, 3),
                    "heading": round(state.heading, 2),
                    "energy": state.charge,
                    "mode": "",
                    "armed": None,
                },
            )

    def close(self) -> None:
        """Close the box."""
        if self._box is not None:
            self._box.close()


def keeper_of(given: VehicleInput, live: Live) -> Keeper:
    """Return what keeps the black box of a robot in real time."""
    home = given.robot.home or (0.0, 0.0, 0.0)
    surface = given.program.frame.surface

    def place(state: RobotState) -> Mapping[str, float]:
        east, north, up = state.position
        return {
            "north": round(north - home[1], 3),
            "east": round(east - home[0], 3),
            "height": round(up - surface, 3),
        }

    if live.folder is None:
        return Keeper(None, place)
    path = black_box_path(live.folder / log_name(given.robot.id))
    return Keeper(BlackBox(path, live.run, given.robot.id, live.clock.now, say=live.say), place)
