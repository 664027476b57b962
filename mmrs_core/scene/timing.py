"""How long legs take: the one model that planning, checks, simulation, reports and targets share.

Autopilots take a straight leg from a stop to a stop: they speed up, keep their speed, and slow down, with a
limited acceleration that itself changes no faster than the jerk (`mmrs_runtime.s_curves`). What is left until
they report it as done is settling. What they save where they pass a corner is in `passing`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import atan2, ceil, cos, dist, exp, hypot, inf, pi, radians, sin, sqrt
from typing import NamedTuple, TypeAlias

from mmrs_core.scene.headings import bearing, turn
from mmrs_core.scene.primitives import Position
from mmrs_runtime.s_curves import largest_speed, reached, speeding, stop_to_stop
from mmrs_runtime.timing import ASTERN, IDEAL, LegTiming, split

LEVEL = 1e-6
"""Metres up to which a leg counts as level."""

SPEEDING = 0.97
"""Share of the seconds at even speed that a leg takes at least whose ends are passed."""

NOTICING = 0.5
"""Seconds after which a beginning, the end of a stay or that of a turn is noticed, at most."""

ANSWERING = 0.2
"""Seconds after which a device has answered, at most."""

UNSURE = 30.0
"""Degrees by which a robot may look elsewhere than is expected."""

ARC, FACING = 0.63, 0.09
"""Radians of an arc of shunting at most, with what it rolls on; and how exactly a robot shunts."""

Leg: TypeAlias = tuple[Position, Position]
"""Where a straight leg begins and ends."""

Push: TypeAlias = tuple[float, float]
"""East and north: the thrust against its drag that a robot has built up, as the speed that this holds, metres
per second. It is left when the robot stops: a leg in that direction lags less, and one back lags more."""

STANDING: Push = (0.0, 0.0)
"""The push of a robot that has not moved yet."""


class MoveSeconds(NamedTuple):
    """How long a move takes, seconds: at least, as it is planned, and at most."""

    shortest: float
    expected: float
    longest: float

    @staticmethod
    def exactly(seconds: float) -> MoveSeconds:
        """Return what is known to the second."""
        return MoveSeconds(seconds, seconds, seconds)


def arcs(aside: float) -> int:
    """Return the number of arcs by which a robot shunts to a place that is aside by so much, degrees."""
    return ceil((radians(aside) - FACING) / ARC)


def bounded(expected: float, timing: LegTiming) -> MoveSeconds:
    """Return what takes as long as expected, or by its spread longer or shorter."""
    return MoveSeconds(expected * max(0.0, 1.0 - timing.spread), expected, expected * (1.0 + timing.spread))


def acting(seconds: float, timing: LegTiming) -> MoveSeconds:
    """Return how long an action of a device takes that is to take so long."""
    shortest, expected, longest = bounded(seconds, timing)
    return MoveSeconds(shortest, expected, max(longest, expected + min(ANSWERING, timing.reporting)))


def noticing(timing: LegTiming) -> float:
    """Return the seconds after which a beginning, or the end of a stay or of a turn, is noticed, at most."""
    return min(NOTICING, timing.reporting)


@dataclass(frozen=True, slots=True)
class Rates:
    """How fast a robot goes along straight legs.

    Paths are chosen by even speed; times count a stop at both ends of every leg.

    Attributes:
        cruise: metres per second, level.
        climb, descent: metres per second; one that is not positive rules that direction out.
        timing: of its autopilot.
        shunting: seconds that turning takes before a level leg, at most. halt: of each arc of that.
        rounds: whether it drives round rather than turns before it goes, if there is room.
        shunts_within: metres up to which a leg may be shunted for.
        circling: seconds in which it drives a full circle, which getting onto a longer leg takes at most.
        accepts: metres from a target at which it counts as reached: shorter legs are taken together.
        bound: -1: these are the fewest seconds; 1: the most; 0: those expected.
        share: of the expected seconds that legs from a stop to a stop take.
        least: seconds that each takes, one of no length as well.
    """

    cruise: float
    climb: float
    descent: float
    timing: LegTiming = IDEAL
    shunting: float = 0.0
    halt: float = 0.0
    rounds: bool = False
    shunts_within: float = inf
    circling: float = 0.0
    accepts: float = 0.0
    bound: int = 0
    share: float = 1.0
    least: float = 0.0
    _both_ends: float = field(init=False, repr=False, compare=False)
    """Seconds by which a level leg takes longer that reaches its cruise, settling included."""
    _reaching: float = field(init=False, repr=False, compare=False)
    """Metres from which a level leg reaches its cruise."""
    _slowness: float = field(init=False, repr=False, compare=False)
    """Seconds per metre per second that both phases of a level leg take, where they reach their limits."""
    _bending: float = field(init=False, repr=False, compare=False)
    """Seconds that they take longer by the jerk."""
    _bent: float = field(init=False, repr=False, compare=False)
    """Metres per second from which they reach their limits."""

    def __post_init__(self) -> None:
        """Keep what all level legs share: planning asks for the seconds of very many."""
        up, down, jerk = self.timing.acceleration, self.timing.braking, self.timing.jerk
        phases = speeding(self.cruise, up, jerk) + speeding(self.cruise, down, jerk)
        object.__setattr__(self, "_both_ends", phases / 2.0 + self.timing.settled(self.cruise))
        object.__setattr__(self, "_reaching", self.cruise * phases / 2.0)
        limited = max(up, down) < inf
        object.__setattr__(self, "_slowness", 1.0 / up + 1.0 / down if limited or jerk == inf else 1.0)
        object.__setattr__(self, "_bending", (up + down) / jerk if limited and jerk < inf else 0.0)
        object.__setattr__(self, "_bent", max(up, down) ** 2 / jerk if jerk < inf else 0.0)

    def soonest(self) -> Rates:
        """Return the rates of a robot that is as quick as it may be.

        It need not turn before it goes, and its autopilot may not keep its type's limits.
        """
        free = self.timing.unlimited or self.timing
        return replace(
            self,
            timing=free,
            climb=max(self.climb, free.climb) if self.climb > 0.0 and self.timing.unlimited else self.climb,
            descent=max(self.descent, free.descent)
            if self.descent > 0.0 and self.timing.unlimited
            else self.descent,
            shunting=0.0,
            bound=-1,
            share=1.0 - self.timing.spread,
        )

    def latest(self) -> Rates:
        """Return the rates of a robot that is as slow as it may be: its autopilot keeps its type's limits."""
        timing, share = self.timing.limited or self.timing, 1.0 + self.timing.spread
        return replace(self, timing=timing, rounds=False, bound=1, share=share, least=timing.reporting)

    def even(self, start: Position, end: Position) -> float:
        """Return the seconds of a straight leg at even speed: the slower of its level and upright parts."""
        level = hypot(end[0] - start[0], end[1] - start[1]) / self.cruise
        return max(level, self.upright(end[2] - start[2]))

    def upright(self, rise: float) -> float:
        """Return the seconds of a vertical leg at even speed; inf where it is ruled out."""
        if abs(rise) <= LEVEL:
            return 0.0
        rate = self.climb if rise > 0 else self.descent
        return abs(rise) / rate if rate > 0 else inf

    def from_stop_to_stop(
        self, start: Position, end: Position, facing: float | None = None, push: Push | None = None
    ) -> float:
        """Return the seconds of a straight leg from a stop to a stop, turning and settling included.

        Args:
            start, end: of the leg.
            facing: degrees clockwise from north in which the robot looks before it; None: not known.
            push: with which it begins; None: not known.
        """
        if self.bound < 0 and dist(start, end) <= self.timing.acceptance:
            return 0.0
        if self.bound < 0:
            end = self._early(start, end)
        if self.bound > 0 and self.timing.slows_down:
            start = self._behind_start(start, end)
        seconds = self.share * self._straight(start, end, push)
        if (together := self.together(start, end)) > 1:
            seconds = (
                self._straight(start, moved(start, (start, end), together * dist(start, end))) / together
            )
        if self.bound and self.timing.still > 0.0:
            inexact = self._between_inexact_ends(start, end)
            seconds = min(seconds, inexact) if self.bound < 0 else max(seconds, inexact)
        if self.bound > 0 and self.timing.stall and (push is None or _split(start, end, push)[0] < 0.0):
            seconds += self.timing.stall * exp(-dist(start, end) / self.timing.stall_within)
        return max(self.least, seconds + self.turning(start, end, facing))

    def together(self, start: Position, end: Position) -> int:
        """Return how many legs like this one the robot is expected to take as one.

        That is as many as are so short together that it takes no notice of the ends of all but the last.
        """
        length = dist(start, end)
        return int(self.accepts / length) + 1 if not self.bound and 0.0 < length <= self.accepts else 1

    def turning(self, start: Position, end: Position, facing: float | None = None) -> float:
        """Return the seconds that it takes to get onto a leg, by shunting or by a curve.

        The most are those of any heading. Where it is not known, one that may drive round is expected to be
        on the leg already.
        """
        along, away = bearing(start, end), dist(start[:2], end[:2])
        if self.shunting <= 0.0 or along is None:
            return 0.0
        if self.bound > 0:
            astern = 180.0 if facing is None else min(180.0, abs(turn(facing, along)) + UNSURE)
            late = max(self.circling, (1.0 + self.timing.spread) * self.timing.turning_back(astern))
            late += self.timing.hesitating if astern >= ASTERN else 0.0
            return (1.0 + self.timing.spread) * self.shunting if away <= self.shunts_within else late
        if facing is None and not self.rounds:
            return self.shunting if away <= self.shunts_within else self.circling
        aside = 0.0 if facing is None else abs(turn(facing, along))
        if not (self.circling or self.halt):
            turning = self.shunting * aside / 180.0 if aside > self.timing.pivots else 0.0
            return turning + self.timing.swerving * sin(radians(aside))
        if aside <= self.timing.aside:
            return 0.0
        if self._drives_round(away, aside):
            radius = self.circling * self.cruise / (2.0 * pi)
            round = (_rounded(away, radians(aside), radius) - away) / self.cruise
            return max(round, self.timing.turning_back(aside))
        driving = self.shunting - self.halt * arcs(180.0)
        return driving * aside / 180.0 + self.halt * arcs(aside)

    def _drives_round(self, away: float, aside: float) -> bool:
        """Return whether it drives round to what is so far away, metres, and so far aside, degrees."""
        return self.rounds and away > self.shunts_within * sin(radians(min(90.0, aside)))

    def faces(self, start: Position, end: Position, facing: float | None) -> float | None:
        """Return where it looks once it has stopped at the end of a leg, degrees clockwise from north.

        Args:
            start, end: of the leg.
            facing: where it looks before; None: not known.
        """
        along = bearing(start, end)
        if along is None or facing is None or not self.circling:
            return facing if along is None else along
        aside = turn(facing, along)
        if not self._drives_round(dist(start[:2], end[:2]), abs(aside)):
            return along
        return (along + self.timing.askew(aside, self.from_stop_to_stop(start, end))) % 360.0

    def rise(self, metres: float) -> float:
        """Return the seconds of a vertical leg from a stop to a stop, settling included."""
        return self.share * self._straight((0.0, 0.0, 0.0), (0.0, 0.0, metres))

    def eased(self, start: Position, end: Position, entering: float = 0.0) -> float:
        """Return the fewest seconds of a leg whose ends may be passed.

        An autopilot that passes within a radius is on the neighbouring legs at the same time, for as long
        as it speeds up and slows down; of another nothing is known but its speed. One that slows down for
        places may turn back within the radius. One that comes from a faster leg slows down on this one.

        Args:
            start, end: of the leg.
            entering: metres per second commanded on the leg before.
        """
        stopping = self.from_stop_to_stop(start, end)
        if self.timing.corner_radius == inf:
            return min(stopping, self.even(start, end))
        end = self._early(start, end)
        if self.timing.slows_down:
            end = self._early(start, end)
        more = max(0.0, entering - self.cruise)
        saved = more * speeding(more, self.timing.braking, self.timing.jerk) / (2.0 * self.cruise)
        eased = SPEEDING * self.even(start, end)
        if not self.timing.slows_down:
            seconds, _ = self.stopping(start, end)
            eased = max(eased, self.share * (seconds - sum(self.phases(start, end)) / 2.0))
        return min(stopping, max(0.0, eased - saved))

    def _behind_start(self, start: Position, end: Position) -> Position:
        """Return where a leg may begin of a robot that counts the last one as over within a radius."""
        return moved(start, (start, end), -self.timing.corner_radius)

    def _early(self, start: Position, end: Position) -> Position:
        """Return where a leg may end that counts as over while the robot moves."""
        early = 0.0 if self.timing.still > 0.0 else min(self.timing.acceptance, dist(start, end))
        return moved(end, (start, end), -early)

    def _between_inexact_ends(self, start: Position, end: Position) -> float:
        """Return the fewest or most seconds of a leg: one counts as over before the robot stands at its end.

        That is where the next one begins, and how fast: so the robot may save the end and the begin of its
        curve, or make up for what is left of the leg before, and come to a stop. One that is so slow all the
        way has ended its leg as soon as it is near enough.
        """
        length, speed, up, down = self.limits(start, end)
        timing = self.timing
        if length <= 0.0 or speed <= 0.0:
            return self.stopping(start, end)[0]
        if self.bound > 0:
            seconds, fastest = stop_to_stop(length + timing.acceptance, speed, up, down, timing.jerk)
            settled = self.timing.settled(fastest, seconds)
            return seconds + self.lag(seconds, start, end) + max(0.0, settled)
        still = min(timing.still, speed)
        if speed <= timing.still:
            length -= min(length, timing.acceptance)
        ends = [reached(still, limit, timing.jerk) for limit in (up, down)]
        whole = length + sum(metres for _, metres in ends)
        seconds, _ = stop_to_stop(whole, speed, up, down, timing.jerk)
        return max(0.0, seconds - sum(each for each, _ in ends))

    def _straight(self, start: Position, end: Position, push: Push | None = None) -> float:
        if -LEVEL <= end[2] - start[2] <= LEVEL and not self.timing.lag and not self.timing.trailing:
            length = hypot(end[0] - start[0], end[1] - start[1])
            if length <= 0.0:
                return 0.0
            if length >= self._reaching:
                return length / self.cruise + self._both_ends
            slowness, bending = self._slowness, self._bending
            fastest = (sqrt(bending * bending + 8.0 * slowness * length) - bending) / (2.0 * slowness)
            if fastest >= self._bent:
                return slowness * fastest + bending + self.timing.settled(fastest)
        seconds, fastest = self.stopping(start, end)
        if seconds <= 0.0:
            return seconds
        lag = self.lag(seconds, start, end, push)
        return max(0.0, seconds + lag + self.timing.settled(fastest, seconds))

    def lag(self, seconds: float, start: Position, end: Position, push: Push | None = None) -> float:
        """Return how much longer a leg takes that would take so long, seconds."""
        if not self.timing.lag or start[:2] == end[:2]:
            return 0.0
        along, beside = (-self.bound * self.cruise, 0.0) if push is None else _split(start, end, push)
        lag = self.timing.lag_of(self.cruise, self._held(start, end), along, beside)
        return lag * (1.0 - exp(-seconds / self.timing.lag_within))

    def _held(self, start: Position, end: Position) -> float:
        """Return the largest level speed on a leg; the mean one where places may be passed."""
        level, length = dist(start[:2], end[:2]), dist(start, end)
        seconds, fastest = self.stopping(start, end)
        speed = length / seconds if self.timing.slows_down else fastest
        return speed * level / length

    def push(self, start: Position, end: Position, before: Push | None) -> Push | None:
        """Return the push that is left after a leg (`LegTiming.pushed`).

        Args:
            start, end: of the leg.
            before: with which it began; None: not known.
        """
        east, north = end[0] - start[0], end[1] - start[1]
        if not self.timing.lag or hypot(east, north) <= LEVEL:
            return before if self.timing.lag else None
        seconds = self.stopping(start, end)[0]
        return self.timing.pushed(before or STANDING, (east, north), self._held(start, end), seconds)

    def stopping(self, start: Position, end: Position) -> tuple[float, float]:
        """Return the seconds of a leg from a stop to a stop, and its largest speed."""
        length, speed, up, down = self.limits(start, end)
        if length <= 0.0:
            return (0.0, 0.0)
        if speed <= 0.0:
            return (inf, 0.0)
        return stop_to_stop(length, speed, up, down, self.timing.jerk)

    def phases(self, start: Position, end: Position) -> tuple[float, float]:
        """Return for how many seconds a leg from a stop to a stop speeds up, and slows down."""
        length, speed, up, down = self.limits(start, end)
        if length <= 0.0 or speed <= 0.0:
            return (0.0, 0.0)
        jerk = self.timing.jerk
        fastest = min(speed, largest_speed(length, up, down, jerk))
        return (speeding(fastest, up, jerk), speeding(fastest, down, jerk))

    def limits(self, start: Position, end: Position) -> tuple[float, float, float, float]:
        """Return the length of a leg, and its largest speed, acceleration and deceleration along it."""
        up, down, upright = self.timing.acceleration, self.timing.braking, self.timing.vertical_acceleration
        rise, level = end[2] - start[2], hypot(end[0] - start[0], end[1] - start[1])
        if abs(rise) <= LEVEL:
            return level, self.cruise, up, down
        length, even = hypot(level, rise), self.even(start, end)
        if upright is not None:
            steep = length / abs(rise) * upright
            up, down = (min(each * length / level, steep) if level > 0.0 else steep for each in (up, down))
        return length, length / even if even > 0.0 else inf, up, down


def moved(place: Position, leg: Leg, metres: float) -> Position:
    """Return where a place is moved to in the direction of a leg."""
    start, end = leg
    part = metres / length if (length := dist(start, end)) > 0.0 else 0.0
    east, north, up = (at + part * (q - p) for at, p, q in zip(place, start, end, strict=True))
    return (east, north, up)


def _split(start: Position, end: Position, push: Push) -> tuple[float, float]:
    """Return how much of a push is along a leg, and to its side."""
    return split(push, (end[0] - start[0], end[1] - start[1]))


def _rounded(away: float, aside: float, radius: float) -> float:
    """Return the metres by a curve and a tangent to a place so far away, and so many radians aside."""
    ahead, beside = away * cos(aside), away * sin(aside) - radius
    straight = sqrt(max(0.0, ahead * ahead + beside * beside - radius * radius))
    return radius * ((atan2(beside, ahead) + atan2(radius, straight)) % (2.0 * pi)) + straight
