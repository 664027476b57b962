"""Other ways to tell thrusters on a CAN bus what to do than the messages of the vehicle's own bus."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol


class CanFrame(Protocol):
    """A data frame of classic CAN."""

    @property
    def id(self) -> int:
        """Identifier: 11 bits, or 29 where `extended`."""
        ...

    @property
    def data(self) -> bytes:
        """At most 8 bytes."""
        ...

    @property
    def extended(self) -> bool:
        """Whether the identifier has 29 bits."""
        ...


@dataclass(frozen=True, slots=True)
class ThrusterData:
    """A thruster as a codec needs to know it.

    Attributes:
        id: as in the robot's type.
        operating_thrust: newtons that it can exert continually. max_thrust: for short periods.
    """

    id: str
    operating_thrust: float
    max_thrust: float


class ThrusterStatus(Protocol):
    """What a drive tells of its thruster."""

    @property
    def number(self) -> int:
        """Of the thruster, from 0."""
        ...

    @property
    def thrust(self) -> float | None:
        """Newtons; None: it does not tell."""
        ...

    @property
    def fault(self) -> bool:
        """Whether the drive says that it cannot work."""
        ...

    @property
    def runs(self) -> bool:
        """Whether it obeys commands now."""
        ...


class ThrusterDriver(Protocol):
    """Speaks for the thrusters of one vehicle; it keeps counters, and what has come of longer messages."""

    def commands(self, thrusts: Sequence[float], enable: bool) -> Sequence[CanFrame]:
        """Return the frames that ask for those newtons, in the order of thrusters; not enabled: for none.

        Called every 0.05 s, whatever it said last.
        """
        ...

    def hear(self, frame: CanFrame) -> ThrusterStatus | None:
        """Return what a frame tells of a thruster, or None if it tells nothing, or not yet all."""
        ...


@dataclass(frozen=True, slots=True)
class Codec:
    """A way to tell thrusters what to do.

    Attributes:
        name: as chosen by people.
        description: one line for people.
        open: given the thrusters in the order of their numbers, and options by name, what speaks for them;
            raises UnsupportedError for thrusters or options that it cannot express.
    """

    name: str
    description: str
    open: Callable[[Sequence[ThrusterData], Mapping[str, str]], ThrusterDriver]
