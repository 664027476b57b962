"""What a backend may have beside the rest; whoever runs behaviours asks by `isinstance`.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from mmrs_core.contributions.execution import Sample
from mmrs_core.scene import Position


@runtime_checkable
class Preparing(Protocol):
    """A backend of robots that take time to get ready.

    A run in real time begins when all its robots are ready, or not at all.
    """

    def prepare(self, now: float) -> None:
        """Begin to get the robot ready; `finished` says when it is, `fault` why it cannot be."""
        ...


@runtime_checkable
class Recognising(Protocol):
    """A backend that finds out, while its robot gets ready, whether that is the one of the program."""

    def known(self, now: float) -> bool:
        """Return whether it is known to be, so that it may be told what to do about whatever goes wrong."""
        ...


@runtime_checkable
class Recovering(Protocol):
    """A backend whose robot can go on where its program was broken off."""

    def recover(self, passed: Sequence[str], begun: str, now: float) -> None:
        """Begin to bring the robot back to where it was; `finished` says when it is there.

        Args:
            passed: the moves that it has ended, in order.
            begun: the move that it is to begin once more; empty where it has ended its last one.
            now: the time.
        """
        ...

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why the robot could not be brought back now, as one that stands elsewhere; or nothing."""
        ...

    def away(self, now: float) -> str:
        """Return why the robot does not stand at home, as far as anybody knows, where it can go on or not."""
        ...

    def moves(self, now: float) -> bool:
        """Return whether the robot was seen to be under way, or able to be at any moment."""
        ...


@runtime_checkable
class Bearing(Protocol):
    """A backend whose robot breaks off what it does when something goes wrong."""

    def bear(self, now: float) -> bool:
        """Go on although that went wrong which it has told last, since a policy says so.

        Returns:
            Whether it can; what was broken off then counts as finished.
        """
        ...


@runtime_checkable
class Watched(Protocol):
    """A backend that says how far a robot is that was told to stop."""

    def obeys(self, now: float) -> bool:
        """Return whether the robot has confirmed that it now does what it was told by `stop`."""
        ...

    def watched(self, now: float) -> bool:
        """Return whether the robot has stopped, or is out of reach, and somebody must stay with it."""
        ...

    def undone(self, now: float) -> str:
        """Return why it has stopped without doing what it was told by `stop`; empty where it has done it."""
        ...

    def reachable(self, now: float) -> bool:
        """Return whether the robot was heard of lately, so that it can be told something."""
        ...


@runtime_checkable
class Doubting(Protocol):
    """A backend whose robot somebody else may have taken."""

    def in_doubt(self, now: float) -> bool:
        """Return whether that is being found out; orders wait for it, and it takes seconds at most."""
        ...


@runtime_checkable
class Pausable(Protocol):
    """A backend whose robot can halt in the middle of anything."""

    def pause(self, now: float) -> None:
        """Begin to halt; idempotent."""
        ...

    def resume(self, now: float) -> None:
        """Go on with what was begun before; idempotent."""
        ...

    def paused(self, now: float) -> bool:
        """Return whether the robot has confirmed that it halts, and not yet that it goes on."""
        ...


@runtime_checkable
class Noting(Protocol):
    """A backend that keeps a black box of its robot."""

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something that the interpreter decided, was ordered, or waited for; raises nothing."""
        ...


@runtime_checkable
class Learning(Protocol):
    """A backend that goes by what other robots have detected."""

    def learn(self, places: Mapping[str, Position]) -> None:
        """Take note of where robots that notified this one have detected things, by name."""
        ...


@runtime_checkable
class Telling(Protocol):
    """A backend that people may ask how its robot is."""

    def told(self) -> Mapping[str, object]:
        """Return what the robot has told last, as JSON has it; empty before it has; from any thread."""
        ...


@runtime_checkable
class Closing(Protocol):
    """A backend with links and threads that end with the run."""

    def close(self) -> None:
        """Release what it holds; the robot keeps whatever state it is in."""
        ...


@runtime_checkable
class Recorder(Protocol):
    """A backend that remembers the way of its robot, for pictures and people."""

    @property
    def notes(self) -> Sequence[str]:
        """Return what was taken for granted, each line without the robot's name."""
        ...

    def track(self) -> tuple[Sample, ...]:
        """Return the way that the robot has come."""
        ...
