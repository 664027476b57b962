"""Motion of a simulated vehicle that steers like a car: as such it obeys commanded speeds and turn rates."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

from mmrs_mavlink.sitl.body import Body, CurvedLeg, Vector, course, plus, turned

SLACK, TURNED = 0.7, 0.45
"""Seconds in which it comes nearer to a commanded speed by e; and what it makes of a commanded turn rate.

Measured with ArduRover: at 0.4 m/s and 19 degrees per second it turned by about 35 degrees in 6 s, of which
it drove for 4 s; it halted within 1.5 to 2 s.
"""


@dataclass
class Car(Body):
    """A body that steers."""

    _askew: float = 0.0
    """Degrees by which it would look beside its last leg at the end of that."""

    def _leg(self, start: Vector, end: Vector) -> CurvedLeg:
        """Return a leg, which takes longer where it has to turn round."""
        leg = super()._leg(start, end)
        aside = turned(self.heading + self._askew, course(start, end))
        leg.lag = self.figures.turning_back(abs(aside))
        self._askew = self.figures.askew(aside, leg.duration)
        return leg

    def _slowness(self, leg: CurvedLeg) -> float:
        """Return how much longer each second of a leg takes."""
        return leg.lag / leg.duration

    def change_speed(self, speed: float) -> None:
        """Move at another speed, and no sooner."""
        lags, askew = [leg.lag for leg in self._legs], self._askew
        super().change_speed(speed)
        self._askew = askew
        for leg, lag in zip(self._legs, lags, strict=True):
            leg.lag = lag

    def _drive(self, ahead: float, aside: float, up: float, turn: float, step: float) -> None:
        """Approach a commanded speed, and turn."""
        self.plan_anew()
        self._askew = 0.0
        along = radians(self.heading)
        pace = self.velocity[0] * cos(along) + self.velocity[1] * sin(along)
        pace += (ahead - pace) * step / SLACK
        self.heading = (self.heading + TURNED * turn * step) % 360.0
        self.velocity = (pace * cos(radians(self.heading)), pace * sin(radians(self.heading)), 0.0)
        self.position = plus(self.position, self.velocity, step)
