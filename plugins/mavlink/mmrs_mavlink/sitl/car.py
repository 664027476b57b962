"""Motion of a simulated vehicle that steers like a car: as such it obeys commanded speeds and turn rates."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

from mmrs_mavlink.sitl.body import Body, plus

SLACK, TURNED = 0.7, 0.45
"""Seconds in which it comes nearer to a commanded speed by e; and what it makes of a commanded turn rate.

Measured with ArduRover: at 0.4 m/s and 19 degrees per second it turned by about 35 degrees in 6 s, of which
it drove for 4 s; it halted within 1.5 to 2 s.
"""


@dataclass
class Car(Body):
    """A body that steers."""

    def _drive(self, ahead: float, aside: float, up: float, turn: float, step: float) -> None:
        """Approach a commanded speed, and turn."""
        self.plan_anew()
        along = radians(self.heading)
        pace = self.velocity[0] * cos(along) + self.velocity[1] * sin(along)
        pace += (ahead - pace) * step / SLACK
        self.heading = (self.heading + TURNED * turn * step) % 360.0
        self.velocity = (pace * cos(radians(self.heading)), pace * sin(radians(self.heading)), 0.0)
        self.position = plus(self.position, self.velocity, step)
