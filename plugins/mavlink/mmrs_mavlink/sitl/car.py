"""Motion of a simulated vehicle that steers like a car, where its targets are commanded one at a time.

What would turn at once is its set-point; it steers there by the acceleration to the side that it wants, as
``AR_PosControl::update`` does (``AR_PosControl.cpp``). On missions and returns it is a body like the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, cos, degrees, hypot, radians, sin

from mmrs_mavlink.sitl.body import CLOSE, STEP, STILL, Body, Vector, plus

CIRCLE = 0.9
"""Metres from its centre in its narrowest curve (``SIM_Rover.h``)."""

POSITION_GAIN, VELOCITY_GAIN = 0.2, 1.0
"""PSC_POS_P and PSC_VEL_P, 1/s."""

SLACK, TURNED = 0.7, 0.45
"""Seconds in which it comes nearer to a commanded speed by e; and what it makes of a commanded turn rate.

Measured with ArduRover: at 0.4 m/s and 19 degrees per second it turned by about 35 degrees in 6 s, of which
it drove for 4 s; it halted within 1.5 to 2 s.
"""

WOBBLE = 0.1
"""Sine of the angle by which it always differs from a place that is straight behind it."""


@dataclass
class Car(Body):
    """A body that steers.

    Attributes:
        steers: whether it does, rather than turn at once.
    """

    steers: bool = False
    _point: Vector | None = None
    """Its set-point, if it follows one."""
    _shaped: Vector = STILL
    """Velocity of the set-point."""

    def advance(self, seconds: float) -> None:
        """Move for that long."""
        if not self.steers or self.driven is not None:
            self._point = None
            super().advance(seconds)
            return
        while seconds > 1e-9:
            step = min(seconds, STEP)
            seconds -= step
            self._steer(step)

    def rest_at(self, up: float) -> None:
        """Stop at a height."""
        super().rest_at(up)
        self._point = None

    def _steer(self, step: float) -> None:
        """Move the set-point, and follow it."""
        here, velocity, heading = self.position, self.velocity, self.heading
        self.position, self.velocity = (
            (here, velocity) if self._point is None else (self._point, self._shaped)
        )
        super().advance(step)
        self._point, self._shaped = self.position, self.velocity
        along = radians(heading)
        ahead, right = (cos(along), sin(along)), (-sin(along), cos(along))
        stopping = hypot(*self._shaped[:2]) < CLOSE
        wanted = plus(self._shaped, plus(self._point, here, -1.0), POSITION_GAIN)
        fastest = hypot(*wanted[:2])
        wanted = plus(STILL, wanted, min(1.0, self.speed / max(fastest, CLOSE)))
        forward, aside = (
            sum(p * q for p, q in zip(wanted[:2], each, strict=True)) for each in (ahead, right)
        )
        if forward < 0.0 and abs(aside) < WOBBLE * fastest:
            aside = copysign(WOBBLE * fastest, aside)
        pace = velocity[0] * ahead[0] + velocity[1] * ahead[1]
        change = (forward if stopping else max(min(fastest, self.speed), forward)) - pace
        pace += max(-step, min(step, change / self.figures.acceleration)) * self.figures.acceleration
        sharpest = abs(pace) / CIRCLE
        rate = 0.0 if stopping else VELOCITY_GAIN * aside / max(abs(pace), CLOSE)
        rate = max(-sharpest, min(sharpest, rate))
        self.heading = (heading + degrees(rate) * step) % 360.0
        self.velocity = (pace * cos(radians(self.heading)), pace * sin(radians(self.heading)), 0.0)
        self.position = plus(here, self.velocity, step)

    def _drive(self, ahead: float, aside: float, up: float, turn: float, step: float) -> None:
        """Approach a commanded speed, and turn."""
        self.plan_anew()
        along = radians(self.heading)
        pace = self.velocity[0] * cos(along) + self.velocity[1] * sin(along)
        pace += (ahead - pace) * step / SLACK
        self.heading = (self.heading + TURNED * turn * step) % 360.0
        self.velocity = (pace * cos(radians(self.heading)), pace * sin(radians(self.heading)), 0.0)
        self.position = plus(self.position, self.velocity, step)
