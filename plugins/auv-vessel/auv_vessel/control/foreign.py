"""Drives that are told what to do in another way than by the messages of the vehicle's own bus."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import TypeAlias

from auv_vessel.control.actuators import Drives
from auv_vessel.control.drives import Status
from auv_vessel.sheet import Sheet, Thruster
from auv_vessel.wire.frame import Frame

Opener: TypeAlias = Callable[[Sequence[Thruster], Mapping[str, str]], Drives]
"""Given the thrusters in the order of their numbers, and options by name, what speaks for them."""


class ForeignDrives:
    """Drives of somebody else's, which may hear of more thrusters than the vehicle has."""

    def __init__(self, sheet: Sheet, theirs: Drives) -> None:
        self._count = len(sheet.thrusters)
        self._theirs = theirs

    def commands(self, thrusts: Sequence[float], enable: bool) -> Sequence[Frame]:
        """Return the frames that ask for those newtons."""
        return self._theirs.commands(thrusts, enable)

    def hear(self, frame: Frame) -> Status | None:
        """Return what a frame tells of a thruster of this vehicle, or None."""
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
