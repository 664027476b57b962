"""Drives that are told what to do in another way than by the messages of the vehicle's own bus."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any

from ..sheet import Sheet
from ..wire.frame import Frame
from .drives import Status


class ForeignDrives:
    """Drives behind an object of somebody else's that has `commands` and `hear` as `actuators.Drives` has.

    Its frames and statuses may be of any class with the same attributes.
    """

    def __init__(self, sheet: Sheet, theirs: Any) -> None:
        self._count = len(sheet.thrusters)
        self._theirs = theirs

    def commands(self, thrusts: Sequence[float], enable: bool) -> list[Frame]:
        """Return the frames that ask for those newtons."""
        return [
            Frame(frame.id, bytes(frame.data), frame.extended)
            for frame in self._theirs.commands(thrusts, enable)
        ]

    def hear(self, frame: Frame) -> Status | None:
        """Return what a frame tells of a thruster of this vehicle, or None."""
        found = self._theirs.hear(frame)
        if found is None or not 0 <= found.number < self._count:
            return None
        return Status(found.number, found.thrust, found.fault, found.runs)


Opener = Callable[[Sequence[Any], Mapping[str, str]], Any]


def drives_of(text: str, sheet: Sheet) -> ForeignDrives:
    """Return the drives that a text names.

    Args:
        text: ``package.module:function``, with ``,option=value`` as often as need be. The function is
            called with the thrusters and the options.

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
