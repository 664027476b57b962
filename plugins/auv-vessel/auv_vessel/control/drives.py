"""Thrusters' drives as the actuator controller sees them: commands to them, and whether they follow."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Protocol, TypeAlias

from auv_vessel.control.allocation import Array
from auv_vessel.sheet import Sheet, Thruster
from auv_vessel.wire.catalogue import STATUS_BASE
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

SILENT = 0.5
"""Seconds without a status after which a drive counts as dead, where any drive gives some."""

IDLE, ASKED = 0.02, 0.1
"""Parts of peak thrust: below the first a drive gives nothing; above the second it was asked for some."""

IDLES = 0.5
"""Seconds for which a drive may give nothing though it was asked, before its thruster counts as dead."""


@dataclass(frozen=True, slots=True)
class Status:
    """The status of a drive and its thruster.

    Attributes:
        number: of the thruster, from 0 in the order of the sheet.
        thrust: newtons; None: it does not tell.
        fault: whether the drive says that it cannot work.
        runs: whether it obeys commands now.
    """

    number: int
    thrust: float | None
    fault: bool
    runs: bool = True


class Drives(Protocol):
    """The messages that command thrusters, on any bus; counters and parts of messages are kept here."""

    def commands(self, thrusts: Sequence[float], enable: bool) -> Sequence[Frame]:
        """Return the frames that ask for those newtons, in the order of thrusters; not enabled: for none.

        Called every `COMMAND_PERIOD`, whatever it said last.
        """
        ...

    def hear(self, frame: Frame) -> Status | None:
        """Return the status of a thruster in a frame; None if it has none, or not yet all of it."""
        ...


class CatalogueDrives:
    """Drives that go by the messages of the vehicle's own bus."""

    def __init__(self, sheet: Sheet, codec: Codec) -> None:
        self._codec = codec
        self._most = [each.max_thrust for each in sheet.thrusters]

    def commands(self, thrusts: Sequence[float], enable: bool) -> list[Frame]:
        """Return a command for each thruster, newtons."""
        return [
            self._codec.encode(
                f"Thruster{number}Command", Thrust=min(max(thrust, -most), most), Enable=enable
            )
            for number, (thrust, most) in enumerate(zip(thrusts, self._most, strict=True))
        ]

    def hear(self, frame: Frame) -> Status | None:
        """Return what a status says."""
        number = frame.id - STATUS_BASE
        if frame.extended or not 0 <= number < len(self._most):
            return None
        found = self._codec.decode(frame)
        if found is None:
            return None
        drive = found.values["Drive"]
        return Status(number, float(found.values["Thrust"]), drive == "FAULT", drive == "RUNS")


class DriveMonitor:
    """Which thrusters work, by what their drives say and do.

    A thruster is dead while its drive says so or is silent, and for good once it gave nothing when asked.

    Attributes:
        working: of each thruster.
    """

    def __init__(self, sheet: Sheet) -> None:
        count = len(sheet.thrusters)
        self._most = [each.max_thrust for each in sheet.thrusters]
        self.working = [True] * count
        self._last: list[Status | None] = [None] * count
        self._received: list[float] = []
        self._gave: list[float | None] = [None] * count
        self._lame = [False] * count

    def take(self, status: Status, now: float) -> None:
        """Note what a drive says."""
        self._last[status.number] = status
        self._received = self._received or [now] * len(self._last)
        self._received[status.number] = now

    def judge(self, asked: Array, now: float) -> list[bool] | None:
        """Judge which thrusters work, given the newtons asked of each; return that if it changed."""
        working = [self._works(number, float(thrust), now) for number, thrust in enumerate(asked)]
        if working == self.working:
            return None
        self.working = working
        return working

    def _works(self, number: int, asked: float, now: float) -> bool:
        status = self._last[number]
        if self._received and now - self._received[number] > SILENT:
            return False
        if status is None or status.fault:
            return status is None
        most = self._most[number]
        gives = status.thrust is None or not status.runs or abs(status.thrust) > IDLE * most
        if gives or abs(asked) < ASKED * most:
            self._gave[number] = None
        else:
            since = self._gave[number]
            self._gave[number] = since = now if since is None else since
            self._lame[number] = self._lame[number] or now - since > IDLES
        return not self._lame[number]


Opener: TypeAlias = Callable[[Sequence[Thruster], Mapping[str, str]], Drives]
"""Given the thrusters in the order of their numbers, and options by name, what speaks for them."""


class ForeignDrives:
    """Third-party drives, which may report more thrusters than the vehicle has."""

    def __init__(self, sheet: Sheet, theirs: Drives) -> None:
        self._count = len(sheet.thrusters)
        self._theirs = theirs

    def commands(self, thrusts: Sequence[float], enable: bool) -> Sequence[Frame]:
        """Return the frames that ask for those newtons."""
        return self._theirs.commands(thrusts, enable)

    def hear(self, frame: Frame) -> Status | None:
        """Return the status in a frame of a thruster of this vehicle, or None."""
        found = self._theirs.hear(frame)
        return found if found is not None and 0 <= found.number < self._count else None


def drives_of(text: str, sheet: Sheet) -> ForeignDrives:
    """Return the drives that a text names.

    Args:
        text: ``package.module:function``, with ``,option=value`` as often as need be, of an `Opener`.

    Raises:
        ValueError: the text is misspelt, names nothing, or what it names refuses.
    """
    place, *pairs = text.split(",")
    module, colon, name = place.partition(":")
    options = dict(pair.partition("=")[::2] for pair in pairs)
    if not colon or not all("=" in pair for pair in pairs):
        raise ValueError(f"drives {text!r}: expected MODULE:FUNCTION,OPTION=VALUE,...")
    try:
        opener: Opener = getattr(import_module(module), name)
    except (ImportError, AttributeError) as error:
        raise ValueError(f"drives {place}: {error}") from error
    try:
        return ForeignDrives(sheet, opener(sheet.thrusters, options))
    except Exception as error:
        raise ValueError(f"drives {place}: {error}") from error
