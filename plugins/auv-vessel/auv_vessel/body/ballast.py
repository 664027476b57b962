"""The drop weight's release, which lets go by itself when nobody commands the vehicle any more."""

from __future__ import annotations

from auv_vessel.body.hydrodynamics import GRAVITY
from auv_vessel.instruments import instruments_of
from auv_vessel.sheet import Sheet

_PATIENCE, _DEEP, _SOON = 5.0, 0.5, 1e-9


def patience_of(sheet: Sheet) -> float:
    """Return seconds without a valid command after which the drop weight falls; 0: it never does."""
    return max(0.0, sheet.extra.get("deadman.time", _PATIENCE))


def pressure_of_depth(sheet: Sheet) -> float:
    """Return the absolute pressure, Pa, beyond which a vehicle counts as deep."""
    return instruments_of(sheet).pressure_air + sheet.water_density * GRAVITY * _DEEP


class Release:
    """What holds the drop weight.

    It is held by the supply of the drives: once they have had a valid command, and then none for
    ``deadman.time`` of `Sheet.extra` (seconds; 5 if it does not say; 0: for ever) while deeper than half a
    metre, it lets go.

    Attributes:
        open: whether the weight is gone, which nothing undoes.
    """

    def __init__(self, sheet: Sheet) -> None:
        self.open = False
        self._patience = patience_of(sheet)
        self._commanded: float | None = None

    def command(self, now: float) -> None:
        """Take note that a drive had a valid command."""
        self._commanded = now

    def run(self, now: float, depth: float) -> None:
        """Let go if it is time to, seconds and metres."""
        if self._patience > 0.0 and self._commanded is not None and depth > _DEEP:
            self.open = self.open or now - self._commanded >= self._patience - _SOON
