"""Signs of a failed motor: a vehicle that tilts or falls as no command makes it, and what comes of that.

Durations are those of the vehicle's own clock, so that late messages and speed-ups change nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, cos, degrees, hypot, inf, radians

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Message
from .trail import place_in

TILT = radians(50.0)
"""Lean that no flight needs: autopilots lean by 30 to 45 degrees at most (ATC_ANGLE_MAX, MPC_TILTMAX_AIR)."""

TIPPED = radians(30.0)
"""Lean at which, near the ground, nothing that flies stays where it is unless the wind is strong."""

LOW = 3.0
"""Metres above home up to which a vehicle may be down: higher up, being still or level is hovering."""

STALE_SECONDS = 1.0
"""After which a lean that is not reported again counts as unknown."""

FALL = 6.0
"""Metres per second at which no command makes a vehicle descend: WPNAV_SPEED_DN takes 5 at most."""

UNSTOPPED, UNSTOPPED_SECONDS = 5.0, 3.0
"""Descent that nothing has stopped after so long, while the vehicle is tilted: a multicopter that can fly
with a motor less is level again after one or two seconds."""

BLOW, LEAST_BLOW = 20.0, 4.0
"""Deceleration, metres per second squared, and loss of speed, that only the ground or an obstacle causes."""

GAP_SECONDS = 0.6
"""Between two positions at most, for what is between them to be one blow."""

STILL, NEAR, LYING_SECONDS = 1.0, 1.5, 2.0
"""Metres per second, metres and seconds within which a vehicle lies where it has fallen."""

LEVEL, LEVEL_SECONDS = 0.3, 10.0
"""Metres by which a vehicle that is to land does not descend for so long only where it is on the ground."""


@dataclass(frozen=True, slots=True)
class _Fix:
    """A position: milliseconds of the vehicle, height in metres, and speeds in metres per second."""

    at: float
    height: float
    sink: float
    speed: float


class MotorFailures:
    """Notices when a flying vehicle loses its attitude or its thrust; an observer of its link.

    One that has stopped its motors falls, too: it counts only when the next heartbeat says that it is armed.

    Attributes:
        failure: what it does as no command makes it, in words; empty as long as it does not.
    """

    def __init__(
        self, kind: str, component: Callable[[], int], armed: Callable[[], bool], lands: Callable[[], bool]
    ) -> None:
        """Create without messages.

        Args:
            kind: of message with the position.
            component: gives that of the autopilot.
            armed: whether the motors may run.
            lands: whether the vehicle is in its mode for landing.
        """
        self._kind, self._component, self._armed, self._lands = kind, component, armed, lands
        self.renew()

    def renew(self) -> None:
        """Forget what was."""
        self.failure = self._suspected = ""
        self._before: _Fix | None = None
        self._now = self._leant_at = 0.0
        self._tilted = self._tipped = self._falling = self._still = self._level = inf
        self._rest = self._landing_height = 0.0
        self._struck: float | None = None

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Look at an attitude, a position or a heartbeat."""
        kind = message.get_type()
        if outgoing or kind not in ("HEARTBEAT", "ATTITUDE", self._kind):
            return
        if message.get_srcComponent() != self._component():
            return
        beats = kind == "HEARTBEAT"
        if not (message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED if beats else self._armed()):
            self.renew()
        elif beats:
            self.failure = self.failure or self._suspected
        elif kind == "ATTITUDE":
            self._lean(message.time_boot_ms, acos(cos(message.roll) * cos(message.pitch)))
        else:
            unit = 0.01 if self._kind == "GLOBAL_POSITION_INT" else 1.0
            sink = message.vz * unit
            speed = hypot(message.vx, message.vy, message.vz) * unit
            self._move(_Fix(message.time_boot_ms, place_in(message).height, sink, speed))

    def fallen(self, *, in_air: bool) -> str:
        """Return why its motors must stop: it is down, or cannot stop falling; empty where it may still fly.

        Args:
            in_air: whether a fall counts that nothing stops, and not only its end.
        """
        known = self._now - self._leant_at <= STALE_SECONDS * 1000.0
        if in_air and known and self._lasts(max(self._tilted, self._falling), UNSTOPPED_SECONDS):
            return f"it has been falling, tilted, for {UNSTOPPED_SECONDS:.0f} s"
        if self._before is None or self._before.height > LOW:
            return ""
        lies = self._struck is not None or (known and self._tipped <= self._still)
        if lies and self._lasts(self._still, LYING_SECONDS):
            return "it lies where it has fallen, with its motors running"
        if self._lasts(self._level, LEVEL_SECONDS):
            return f"it is to land, and has not descended for {LEVEL_SECONDS:.0f} s: it is down"
        return ""

    def _lasts(self, since: float, seconds: float) -> bool:
        return self._now - since >= seconds * 1000.0

    def _lean(self, at: float, tilt: float) -> None:
        if at - self._leant_at > STALE_SECONDS * 1000.0:
            self._tilted = self._tipped = inf
        self._leant_at = at
        if tilt > TILT and self._tilted < at:
            self._suspected = self._suspected or f"it tilts by {degrees(tilt):.0f} degrees"
        self._tilted = min(self._tilted, at) if tilt > TILT else inf
        self._tipped = min(self._tipped, at) if tilt > TIPPED else inf

    def _move(self, fix: _Fix) -> None:
        before, self._before, self._now = self._before, fix, fix.at
        if before is None or fix.at <= before.at:
            return
        if min(before.sink, fix.sink) > FALL:
            self._suspected = self._suspected or f"it falls at {fix.sink:.0f} m/s"
        self._falling = min(self._falling, fix.at) if fix.sink >= UNSTOPPED else inf
        self._note_blow(before, fix)
        if fix.speed > STILL or self._still == inf or abs(fix.height - self._rest) > NEAR:
            self._still, self._rest = (inf if fix.speed > STILL else fix.at), fix.height
        if not self._lands() or self._level == inf or abs(self._landing_height - fix.height) > LEVEL:
            self._level, self._landing_height = (fix.at if self._lands() else inf), fix.height

    def _note_blow(self, before: _Fix, fix: _Fix) -> None:
        seconds, lost = (fix.at - before.at) / 1000.0, before.sink - fix.sink
        if seconds <= GAP_SECONDS and before.sink >= LEAST_BLOW and lost >= max(LEAST_BLOW, BLOW * seconds):
            self._struck = fix.height
        elif self._struck is not None and fix.height > self._struck + NEAR:
            self._struck = None
