"""How autopilots take legs: figures that planning and the profiles of vehicles share.

``docs/concepts/timing.md`` explains them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, exp, hypot, inf, log, radians, sqrt

SETTLED = 0.5
"""Metres beyond a target from which a robot need not come back to be there."""

BESIDE = 0.5
"""Share of the thrust to its side for which a robot that slows down for corners waits."""

LEFT = 0.8
"""Share of its thrust that is left where a robot has stopped."""

ASTERN, KEPT_UP = 174.5, 0.55
"""Degrees aside up to which a target stays, since vehicles drift; logarithm of a lag that is made up under
way."""

SWUNG, STRAIGHTENING = 0.14, 28.0
"""Share of a turn by which a car looks too far round at first, and seconds in which that becomes less by e
while it makes up for its lag."""


@dataclass(frozen=True, slots=True)
class LegTiming:
    """How an autopilot takes legs in one way of being commanded; the defaults are those of an ideal one.

    Attributes:
        acceleration: level, speeding up, metres per second squared.
        deceleration: level, slowing down; None: as speeding up.
        vertical_acceleration: up and down, both ways; None: as the level one.
        jerk: change of acceleration, metres per second cubed.
        speed: largest that it makes, metres per second.
        climb, descent: largest that it makes, metres per second.
        corner_radius: metres from a corner within which it passes; 0: it comes to a stop at each.
        corner_seconds: for which it is on both legs at a corner that it passes, at most, if it turns right
            round; otherwise divided by the sine of half the turn.
        passes: whether it passes places; otherwise it comes to a stop at each.
        turning: share of its acceleration with which it goes round a corner that it passes, for which it
            slows down; 0: it begins the next leg before the end of the last one.
        level_within: metres by which the next place may be higher or lower where it passes one so; otherwise
            it comes to a stop, but does not settle.
        acceptance: metres from a target at which it may count as reached: so short a leg may take no time,
            and another one may be so much longer that begins there; so much shorter, too, without `still`.
        still: metres per second up to which it counts as standing still: so fast it may begin and end legs.
        settling: seconds from the end of a leg until it is reported as done; negative: before its end. Of one
            that trails a set-point, those in all for which it is within the acceptance.
        starting: seconds of the settling that pass as it sets out from a stop.
        lag, lag_within: seconds that a long level leg takes longer, as the robot comes near to its speed only
            after some time, as it builds up the thrust for it; and the time constant of that, seconds.
        lag_halved: commanded speed at which the lag is half of that, metres per second; faster, it is more.
        stall: seconds for which it may stand at a target before it counts as reached, at most, unless it goes
            on in the direction of its last leg.
        stall_within: metres of a leg with which that becomes less, by e.
        keeps_acceleration: whether it is expected to keep the acceleration that the robot type states.
        overshoot: how far it goes beyond a target, metres for each metre per second of the leg's largest
            speed, that is, seconds.
        returning: metres per second at which it comes back then.
        trailing: seconds by which it trails a set-point that moves along the leg at the commanded speed; what
            is left as that stops becomes less by e in each. 0: it follows none.
        swinging: seconds in which it comes to thrust against its drag then, and so goes beyond its target.
        spread: by which share legs take longer or shorter than expected.
        reporting: seconds within which what takes no time, such as a leg of no length, is reported as done.
        shunts_within: turning radii up to which a leg may be shunted for, where the robot cannot turn on the
            spot: to a place abreast of it; by one curve, it gets onto longer legs and to places more ahead.
        shunts_for: seconds up to which a leg may be shunted for in the same way, if that is longer.
        aside: degrees from where it looks within which it sets out to a place without either.
        pivots: degrees from where it looks beyond which one that turns on the spot does so before it sets
            out; up to these it turns while it sets out.
        swerving: seconds that one that turns on the spot takes longer to get onto a leg after a right angle;
            after other turns, by the sine of these.
        closing: seconds in which what its target has gone ahead while it turned round becomes less by e; 0:
            that waits for it.
        hesitating: seconds that it may drive on, at most, before it turns to a place straight behind.
        unlimited: how it takes legs where it does not keep the limits of the robot's type; None: as here.
        limited: how it takes them where it keeps them all; None: as here.
    """

    acceleration: float = inf
    deceleration: float | None = None
    vertical_acceleration: float | None = None
    jerk: float = inf
    speed: float = inf
    climb: float = inf
    descent: float = inf
    corner_radius: float = inf
    corner_seconds: float = inf
    passes: bool = True
    turning: float = 0.0
    level_within: float = inf
    acceptance: float = 0.0
    still: float = 0.0
    settling: float = 0.0
    starting: float = 0.0
    lag: float = 0.0
    lag_within: float = 1.0
    lag_halved: float = 0.0
    stall: float = 0.0
    stall_within: float = inf
    keeps_acceleration: bool = True
    overshoot: float = 0.0
    returning: float = 0.63
    trailing: float = 0.0
    swinging: float = 1.0
    spread: float = 0.0
    reporting: float = 0.0
    shunts_within: float = inf
    shunts_for: float = 0.0
    aside: float = 0.0
    pivots: float = inf
    swerving: float = 0.0
    closing: float = 0.0
    hesitating: float = 0.0
    unlimited: LegTiming | None = None
    limited: LegTiming | None = None

    @property
    def braking(self) -> float:
        """Return the level deceleration, metres per second squared."""
        return self.acceleration if self.deceleration is None else self.deceleration

    def settled(self, fastest: float, seconds: float = inf) -> float:
        """Return the seconds after the end of a leg of a largest speed until it is reported as done.

        A robot that has gone beyond its target comes back; one that trails its set-point comes near.

        Args:
            fastest: metres per second.
            seconds: that the leg takes until its end.
        """
        if self.trailing > 0.0:
            return self._come_to_rest(fastest, seconds)
        beyond = self.overshoot * fastest if self.overshoot > 0.0 else 0.0
        return self.settling + ((beyond - SETTLED) / self.returning if beyond > SETTLED else 0.0)

    def _come_to_rest(self, fastest: float, seconds: float) -> float:
        """Return the seconds from the stop of a set-point until a robot that trails it is settled there.

        It comes near, goes beyond, and back, until it has been near for long enough; it need not be still.
        While it turns back, its speed changes by what it comes back at in the seconds by which it trails.
        """
        behind = self.trailing * fastest * (1.0 - exp(-seconds / self.trailing))
        beyond = self.overshoot * fastest * (1.0 - exp(-seconds / self.swinging))
        near = self.trailing * log(max(1.0, behind / self.acceptance))
        away = 2.0 * sqrt(2.0 * max(0.0, beyond - self.acceptance) * self.trailing / self.returning)
        return near + away + self.settling

    def turning_back(self, aside: float) -> float:
        """Return the seconds that a leg takes longer whose target goes ahead while the robot turns round.

        It turns by the acceleration to the side that it wants, which becomes less with the sine of the angle:
        until it looks there, the target gains v / c · -2 ln cos (angle / 2) by a rate c of its turns. At the
        end it makes that up by and by.

        Args:
            aside: degrees from where it looks.
        """
        lag = -log(cos(radians(min(ASTERN, aside)) / 2.0))
        return self.closing * max(0.0, lag - KEPT_UP)

    def askew(self, turned: float, seconds: float) -> float:
        """Return by how many degrees it looks beside a leg at its end that it has turned to.

        It makes up for what it is beside the leg as slowly as for its lag, so that it comes in at an angle.

        Args:
            turned: degrees by which it has turned, clockwise.
            seconds: of the leg, without the turn.
        """
        return SWUNG * turned * exp(-seconds / STRAIGHTENING) if self.closing else 0.0

    @property
    def slows_down(self) -> bool:
        """Return whether it slows down for corners that it passes."""
        return self.turning > 0.0 and self.corner_radius > 0.0

    def lag_of(self, cruise: float, held: float, along: float, beside: float) -> float:
        """Return how much longer a long level leg takes that a robot begins with some thrust, seconds.

        One that slows down for corners waits while it is beside its path, too; another one that has stopped
        has lost some of its thrust.

        Args:
            cruise: commanded, metres per second.
            held: speed on the leg that drag is to be overcome for, metres per second.
            along, beside: speeds that the thrust holds, along the leg and to its side, metres per second.
        """
        if not self.slows_down:
            return self.lag * max(0.0, 1.0 - held * along / cruise**2)
        if along >= held:
            return 0.0
        return self.lag * hypot(held - along, BESIDE * beside) / (held + self.lag_halved)

    def pushed(
        self, push: tuple[float, float], way: tuple[float, float], held: float, seconds: float
    ) -> tuple[float, float]:
        """Return the thrust that is left after a level leg; it grows by the time constant of the lag.

        A robot that stops loses some, and what is to the side.

        Args:
            push: with which it began, as the speed that this holds, metres per second on two level axes.
            way: of the leg, on these axes, metres; not nothing.
            held: speed on the leg that drag is to be overcome for, metres per second. seconds: of the leg.
        """
        gone, (along, beside) = exp(-seconds / self.lag_within), split(push, way)
        along = held - (held - along) * gone
        along, beside = (along, beside * gone) if self.slows_down else (LEFT * along, 0.0)
        one, two = (each / hypot(*way) for each in way)
        return (along * one - beside * two, along * two + beside * one)

    def passing(self, aside: float, onward: float, rise: float) -> float:
        """Return how fast it is at a place that it slows down for, metres per second; 0: it stops there.

        That is as soon as it is within its radius. In the turn it is as fast as on a circle that touches both
        legs as far from there, and as it may be to stop at the end of the next leg
        (``computeStartXYSpeedFromWaypoints``).

        Args:
            aside: sine of half the turn, in the plane.
            onward: length of the next leg, in the plane, metres. rise: height that it gains, metres.
        """
        if abs(rise) >= self.level_within:
            return 0.0
        ahead = sqrt(max(0.0, 1.0 - aside * aside))
        circle = self.turning * self.acceleration * self.corner_radius * ahead
        turning = min(self.nearing(onward), sqrt(circle / aside) if aside > 0.0 else inf)
        return self.nearing(self.corner_radius, turning if onward > self.corner_radius else 0.0)

    def nearing(self, metres: float, last: float = 0.0) -> float:
        """Return how fast it may be so far from where it has a speed (``computeMaxSpeedFromDistance``)."""
        bend = 2.0 * self.braking**2 / self.jerk - last
        return max(last, sqrt(max(0.0, bend * bend + 2.0 * self.braking * metres - last * last)) - bend)

    def cut(self, speed: float) -> float:
        """Return by how many metres a corner is cut at most that is passed at a speed.

        At a steady acceleration that is v² / 2a, and never more than the radius.
        """
        return min(self.corner_radius, speed * speed / (2.0 * min(self.acceleration, self.braking)))


def split(push: tuple[float, float], way: tuple[float, float]) -> tuple[float, float]:
    """Return how much of a push is along a way, and to its side; nothing where the way is none."""
    (one, two), length = way, hypot(*way)
    if length <= 0.0:
        return 0.0, 0.0
    return (one * push[0] + two * push[1]) / length, (one * push[1] - two * push[0]) / length


def half_turn(before: Sequence[float], after: Sequence[float]) -> float | None:
    """Return the sine of half the turn between two directions; None where one has no length."""
    lengths = hypot(*before) * hypot(*after)
    if lengths <= 0.0:
        return None
    return sqrt(max(0.0, 1.0 - sum(p * q for p, q in zip(before, after, strict=True)) / lengths) / 2.0)


IDEAL = LegTiming()
"""At once at any speed, and at a standstill."""


@dataclass(frozen=True, slots=True)
class AutopilotTiming:
    """How long the autopilots of a class of vehicles take, where the robot type does not state it.

    Attributes:
        step: legs that are commanded one by one.
        mission: legs of a mission that was uploaded; None: none is, or these are taken as steps are.
        upright: legs of launching and landing; None: these are taken as steps are.
        launch: seconds that launching takes beside the climb; None: as its kind says.
        recovery: seconds from touching the ground until it stands still; None: as its kind says.
        noticing: seconds of launching, of landing, and of the last leg of a run that is flown as a mission,
            until a program notices its end: none where all is one mission that was uploaded.
        guiding: seconds by which the first leg after launching begins later that is commanded alone.
        landing_rate: metres per second at which it comes down below `landing_height`, metres above ground.
        rounds: whether a vehicle that cannot turn on the spot drives round instead of shunting.
        turn_rate: largest, degrees per second.
        charging: how many times as long as declared charging may take.
    """

    step: LegTiming = IDEAL
    mission: LegTiming | None = None
    upright: LegTiming | None = None
    launch: float | None = None
    recovery: float | None = None
    noticing: float = 0.0
    guiding: float = 0.0
    landing_rate: float = inf
    landing_height: float = 0.0
    rounds: bool = False
    turn_rate: float = inf
    charging: float = 1.0
