"""Robots that somebody holds: since when, and whether their vehicles were told to halt yet."""

from __future__ import annotations

from mmrs_core.contributions.abilities import Pausable
from mmrs_core.contributions.backends import Backend


class Pause:
    """The hold of a robot.

    Attributes:
        held: whether somebody ordered it to hold, and nothing else since.
    """

    def __init__(self, backend: Backend) -> None:
        self.held = False
        self._backend = backend
        self._halts, self._since = False, 0.0

    def begin(self, now: float, *, known: bool) -> None:
        """Have it stay where it is, as soon as it may be told; `known`: whether it may be."""
        if not self.held:
            self.held, self._halts, self._since = True, False, now
        if known and not self._halts and isinstance(self._backend, Pausable):
            self._halts = True
            self._backend.pause(now)

    def end(self, now: float) -> float:
        """Have it be held no longer; return the seconds for which it was."""
        self.held = False
        if self._halts and isinstance(self._backend, Pausable):
            self._backend.resume(now)
        return now - self._since

    def forget(self) -> None:
        """Take it that something else ends the hold, which need not be undone."""
        self.held = False
