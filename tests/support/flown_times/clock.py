"""The vehicle's clock by that of the log, which runs ahead where a simulation falls behind."""

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from math import inf
from statistics import median

from flown_times.models import Modelled
from flown_times.tracks import NEAR, Sample, left_at, missions_in, stop_at

STALL = 1.0
"""Seconds from which the log's clock has run ahead."""

LATE = 0.4
"""Seconds by which a step is logged to take longer than its track shows, beyond what is usual, from which it
was logged late, or the simulation fell behind in it."""

AT_ONCE = 0.1
"""Seconds after the end of a step within which the next one begins that does so at once."""

SETTING_OUT = 0.4
"""Seconds from a command until the track shows that the vehicle moves."""

FIRST, LATER = 60.0, 15.0
"""Seconds within which a stop is sought: the first one, and others."""

Step = tuple[str, str, float]
"""What was logged: label, move, time."""


class Clock:
    """Knows the vehicle's time where its track shows a stop: as it comes to one, and sets out again."""

    def __init__(self, steps: Sequence[Step], track: Sequence[Sample], modelled: Modelled) -> None:
        """Fit the log of a robot to its track; without one, the log counts."""
        known = _steady(list(_known(steps, track, modelled)) if track else [])
        ahead = [time - seen for time, seen in known]
        self._at = [time for time, _ in known]
        self._ahead = [median(ahead[max(0, i - 1) : i + 2]) for i in range(len(ahead))]
        self._late = dict(_late(steps, dict(known))) if modelled.takes_off else {}

    def passed(self, begin: float, end: float) -> float:
        """Return the vehicle's seconds between two times of the log.

        Where a stop shows on a track to a few tenths of a second only, the log counts, but for stalls and
        late steps; those of copters only, as others turn, or speed up slowly, before a track shows it.
        """
        seconds = self.at(end) - self.at(begin)
        if end - begin - seconds > STALL:
            return seconds
        return end - begin - self._late.get(end, 0.0)

    def at(self, time: float) -> float:
        """Return the vehicle's time at a time of the log."""
        if not self._at:
            return time
        after = bisect_right(self._at, time)
        if after == 0 or after == len(self._at):
            return time - self._ahead[0 if after == 0 else -1]
        one, two = self._at[after - 1], self._at[after]
        part = (time - one) / (two - one) if two > one else 0.0
        return time - (self._ahead[after - 1] + part * (self._ahead[after] - self._ahead[after - 1]))


def _steady(known: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Leave out where the log's clock would run ahead, and be back at the next time: no stop was seen there.

    A vehicle that turns on the spot seems to set out.
    """
    ahead = [time - seen for time, seen in known]
    beside = zip(ahead[:1] + ahead, ahead, ahead[1:] + ahead[-1:], strict=False)
    return [
        each
        for each, (before, here, after) in zip(known, beside, strict=False)
        if here <= max(before, after) + STALL
    ]


def _late(steps: Sequence[Step], seen: Mapping[float, float]) -> Iterator[tuple[float, float]]:
    """Yield the ends of steps that the log tells to be longer than the track does, and by how much.

    What is usual for the robot is no delay: so long it takes to set out, and until its stop is noticed. A
    step that begins at once does so where the last one ended.
    """
    longer: dict[float, float] = {}
    begin = before = -inf
    for label, _, time in steps:
        if label == "begin":
            begin = time if time in seen or time - before > AT_ONCE else before
        elif label == "end":
            if begin in seen and time in seen and seen[begin] < seen[time]:
                longer[time] = time - begin - (seen[time] - seen[begin])
            before = time
    if longer:
        usual = median(longer.values())
        most = usual + max(LATE, 2.0 * median(abs(each - usual) for each in longer.values()))
        yield from ((end, each - usual) for end, each in longer.items() if each > most)


def _known(
    steps: Sequence[Step], track: Sequence[Sample], modelled: Modelled
) -> Iterator[tuple[float, float]]:
    """Yield times of the log, and those of the vehicle; one that turns before it goes shows only stops."""
    sets_out = modelled.takes_off
    legs, runs = modelled.legs, modelled.runs
    missions = iter(missions_in(track))
    passed: dict[str, float] = {}
    ahead, within = 0.0, FIRST
    for label, move, time in steps:
        run = next((each for each in runs if each[0] == move), None)
        seen = None
        if label == "begin" and run is not None and (mission := next(missions, None)) is not None:
            seen, *ends = mission
            passed |= dict(zip(run, ends, strict=False))
        elif label == "end" and move in passed:
            seen = passed[move]
        elif label == "end" and move in modelled.stepped and move in legs:
            seen = stop_at(legs[move][-1], track, time - ahead, within)
        elif label == "begin" and sets_out and move in modelled.stepped and move in legs and within == LATER:
            left = left_at(legs[move][0], track, time + SETTING_OUT - ahead, within)
            seen = None if left is None else left - SETTING_OUT
        if seen is not None:
            ahead, within = time - seen, LATER
            yield time, seen
    landed = [(time, move) for label, move, time in steps if label == "end" and move in legs]
    if landed and within == LATER and legs[landed[-1][1]][-1][2] < NEAR < legs[landed[-1][1]][0][2]:
        yield landed[-1][0], max(each.time for each in track if each.armed)
