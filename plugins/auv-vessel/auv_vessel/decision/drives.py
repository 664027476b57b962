"""News of thrusters whose drives fail, for people."""

from __future__ import annotations

from auv_vessel.api import Craft
from auv_vessel.sheet import Sheet


class Drives:
    """Notices which thrusters have failed since it was asked last, and which work again."""

    def __init__(self, craft: Craft, sheet: Sheet) -> None:
        """Take all for well."""
        self._craft, self._thrusters = craft, sheet.thrusters
        self._failed: frozenset[int] = frozenset()

    def news(self) -> tuple[tuple[str, str], ...]:
        """Return for each how grave it is, in a word of MAVLink's, and a sentence."""
        failed, before = self._craft.state().failed, self._failed
        self._failed = failed
        return tuple(
            _told(self._thrusters[number].id, number in failed) for number in sorted(failed ^ before)
        )


def _told(thruster: str, failed: bool) -> tuple[str, str]:
    grave, what = ("ERROR", "has failed") if failed else ("NOTICE", "works again")
    return grave, f"thruster '{thruster}' {what}"
