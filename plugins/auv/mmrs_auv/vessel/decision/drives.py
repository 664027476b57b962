"""News of thrusters whose drives fail, for people."""

from __future__ import annotations

from ..api import Craft
from ..sheet import Sheet


class Drives:
    """Notices which thrusters have failed since it was asked last, and which work again."""

    def __init__(self, craft: Craft, sheet: Sheet) -> None:
        """Take all for well."""
        self._craft, self._thrusters = craft, sheet.thrusters
        self._failed: frozenset[int] = frozenset()

    def news(self) -> tuple[str, ...]:
        """Return a sentence for each."""
        failed, before = self._craft.state().failed, self._failed
        self._failed = failed
        return tuple(
            f"thruster '{self._thrusters[number].id}' {'has failed' if number in failed else 'works again'}"
            for number in sorted(failed ^ before)
        )
