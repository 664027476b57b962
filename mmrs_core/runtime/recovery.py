"""How robots get back to where their programs were broken off."""

from __future__ import annotations

from mmrs_core.contributions.abilities import Recovering
from mmrs_core.contributions.backends import Backend


class Recovery:
    """What a robot has passed, and what its backend says of getting back to where it was.

    `underway` is the move that the robot is to begin once more; empty where it has ended its last one.
    """

    def __init__(self, backend: Backend) -> None:
        """Have passed nothing."""
        self._backend = backend
        self._passed: list[str] = []

    def passed(self, move: str) -> None:
        """Take note that the robot has ended a move."""
        self._passed.append(move)

    def begin(self, underway: str, now: float) -> bool:
        """Begin to bring the robot back; return whether its backend does that at all."""
        if not isinstance(self._backend, Recovering):
            return False
        self._backend.recover(tuple(self._passed), underway, now)
        return True

    def astray(self, underway: str, now: float) -> str:
        """Return why the robot cannot be brought back from where it is; empty: it can."""
        if not isinstance(self._backend, Recovering):
            return ""
        return self._backend.hindrance(tuple(self._passed), underway, now)

    def from_home(self, now: float) -> str:
        """Return why the robot does not stand at home, as far as anybody knows; empty where it may."""
        return self._backend.away(now) if isinstance(self._backend, Recovering) else ""

    def moves(self, now: float) -> bool:
        """Return whether the robot's motors are seen to run, or may at any moment."""
        return isinstance(self._backend, Recovering) and self._backend.moves(now)
