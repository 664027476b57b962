"""The latest command of each sender, by which late requests are told from new ones."""

from __future__ import annotations

from .words import CommandId


class Latest:
    """Knows how far each sender is, and whether what it asked for last is settled."""

    def __init__(self) -> None:
        """Know of no sender."""
        self._places: dict[str, tuple[str, int, int]] = {}
        self._settled: dict[str, bool] = {}

    def is_stale(self, id: CommandId, round: int) -> bool:
        """Return whether a request comes after a later one, or after it was settled."""
        latest = self._places.get(id.sender)
        if latest is None:
            return False
        place = _place(id, round)
        return place < latest or (place == latest and self._settled[id.sender])

    def open(self, id: CommandId, round: int) -> None:
        """Take note that a request is the sender's latest."""
        self._places[id.sender] = _place(id, round)
        self._settled[id.sender] = False

    def settle(self, id: CommandId, round: int, *, for_good: bool = False) -> None:
        """Have a late request for what has been settled found stale; `for_good`: in all rounds."""
        place, latest = _place(id, round), self._places.get(id.sender)
        if latest is None or place >= latest:
            self._places[id.sender], self._settled[id.sender] = place, True
        elif latest[:2] == place[:2] and for_good:
            self._settled[id.sender] = True


def _place(id: CommandId, round: int) -> tuple[str, int, int]:
    return id.incarnation, id.sequence, round
