"""The latest command of each sender, by which late requests are told from new ones."""

from __future__ import annotations

from ..words import CommandId


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


class Starts:
    """Knows which starts of each sender were heard of.

    One that is no later than those and is none of them knows nothing of what the sender did before.
    """

    def __init__(self) -> None:
        """Know of no start."""
        self._known: dict[str, set[str]] = {}

    def admits(self, id: CommandId) -> bool:
        """Return whether a start of a sender is known, or later than all that are."""
        known = self._known.get(id.sender, set())
        return id.incarnation in known or all(_number(id.incarnation) > _number(each) for each in known)

    def is_first(self, id: CommandId) -> bool:
        """Return whether no other start of a sender is known."""
        return self._known.get(id.sender, set()) <= {id.incarnation}

    def add(self, id: CommandId) -> None:
        """Take note of a start of a sender."""
        self._known.setdefault(id.sender, set()).add(id.incarnation)


def _number(incarnation: str) -> str:
    return incarnation.partition("-")[0]


def _place(id: CommandId, round: int) -> tuple[str, int, int]:
    return id.incarnation, id.sequence, round
