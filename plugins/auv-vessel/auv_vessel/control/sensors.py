"""The sensor controller: from what instruments say to where the vehicle is, and what that is worth."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np

from auv_vessel.control import failsafe
from auv_vessel.control.allocation import Array
from auv_vessel.control.attitude import AttitudeFilter
from auv_vessel.control.drives import SILENT
from auv_vessel.control.plausibility import Channel
from auv_vessel.control.reckoning import Reckoning, Vertical, WaterSpeed
from auv_vessel.instruments import instruments_of
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import BEAT_PERIOD, MOST_UPTIME, SENSORS, STATE_PERIOD, STATUS_BASE, by_id
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.frame import Frame

FLOW_GAIN, FLOW_RELAXES = 0.6, 0.02
"""Part of the log's residual taken over; part of the current taken over at each tick without a log."""

CURRENT_PERIOD = 0.2

FASTEST = 5.0
"""Metres per second that no vehicle does."""

MOST_UNCERTAIN = 655.0
MOST_PLACE = 8388.0


class Sensors:
    """Fuses depth, attitude, speed and place, and says them with what they are worth.

    Depth comes from pressure, attitude from compass, tilt and gyroscopes, speed over ground from the Doppler
    log, or from thrust, drag and the current while it has none, place by dead reckoning (`Reckoning`) with
    fixes at the surface. Depth and attitude are trusted while their last plausible value is not older than
    `failsafe.STALE`.

    It lets go of the drop weight when the actuator controller was there and is gone.
    """

    name = SENSORS
    period = STATE_PERIOD

    def __init__(self, sheet: Sheet, codec: Codec) -> None:
        self._codec = codec
        instruments = instruments_of(sheet)
        self._log_noise = instruments.log_noise
        self._water = WaterSpeed(sheet)
        self._thrusts: Array = np.zeros(len(sheet.thrusters))
        self._thrusts_at: Array = np.full(len(sheet.thrusters), -np.inf)
        self._attitude = AttitudeFilter(sheet.heading, instruments)
        self._vertical = Vertical(sheet, instruments)
        self.reckoning = Reckoning(sheet.home[0], sheet.home[1], instruments)
        self._log = Channel(-FASTEST, FASTEST, 0.001, 3)
        self._flow: Array = np.zeros(3)
        self._hearers = by_id({
            "Pressure": self._hear_pressure, "Rates": self._hear_rates, "Attitude": self._hear_attitude,
            "GroundSpeed": self._hear_speed, "Fix": self._hear_fix, "ActuatorsBeat": self._hear_beat,
        })  # fmt: skip
        self._began: float | None = None
        self._beat_at: float | None = None
        self._due = {"Emergency": 0.0, "Current": 0.0, "Beat": 0.0}

    def hear(self, frame: Frame, now: float) -> None:
        """Take what an instrument or a drive says."""
        number = frame.id - STATUS_BASE
        hearer = self._hearers.get(frame.id)
        if hearer is None and not 0 <= number < len(self._thrusts):
            return
        if (found := self._codec.decode(frame)) is None:
            return
        if hearer is not None:
            hearer(found, now)
        else:
            self._thrusts[number], self._thrusts_at[number] = found.values["Thrust"], now

    def tick(self, now: float) -> list[Frame]:
        """Bring the state up to now, and say it."""
        self._began = now if self._began is None else self._began
        self._advance(now)
        return [*self._state(now), *self._tell(now)]

    def _advance(self, now: float) -> None:
        period = self.period
        self._attitude.advance(period)
        yaw_rate = radians(self._attitude.rates[2])
        thrusts = np.where(now - self._thrusts_at <= SILENT, self._thrusts, 0.0)
        self._water.advance(thrusts, yaw_rate, self._vertical.depth, period)
        self._flow[:2] += yaw_rate * period * np.array((self._flow[1], -self._flow[0]))
        self._vertical.advance(float(self._water.acceleration[2]), now, period)
        compass = radians(self._attitude.angles[2])
        if self._log.trusted(now):
            ahead, aside = self._level(self._water.speed + self._flow)
            self.reckoning.advance_over_ground(compass, ahead, aside, period)
        else:
            ahead, aside = self._level(self._water.speed)
            self.reckoning.advance_through_water(compass, ahead, aside, period)
            self._flow[:2] += FLOW_RELAXES * (self._current() + self.reckoning.log_bias() - self._flow[:2])

    def _state(self, now: float) -> list[Frame]:
        encode, angles = self._codec.encode, self._attitude.angles
        place = np.clip(self.reckoning.state[:2], -MOST_PLACE, MOST_PLACE)
        speed = self._water.speed + self._flow
        speed[:2] -= self.reckoning.log_bias()
        speed[2] = self._heave(speed)
        surge, sway, heave = np.clip(speed, -FASTEST, FASTEST).tolist()
        heading = (float(angles[2]) - np.degrees(self.reckoning.compass_bias)) % 360.0
        roll, pitch, yaw = np.clip(self._attitude.rates, -320.0, 320.0).tolist()
        return [
            encode("Position", North=float(place[0]), East=float(place[1])),
            encode("Depth", Depth=min(max(self._vertical.depth, -MOST_PLACE), MOST_PLACE),
                   Uncertainty=min(self.reckoning.uncertainty, MOST_UNCERTAIN), Trusted=self._trusted(now)),
            encode("Pose", Roll=float(angles[0]), Pitch=float(angles[1]), Heading=heading),
            encode("Velocity", Surge=surge, Sway=sway, Heave=heave),
            encode("Turning", Roll=roll, Pitch=pitch, Yaw=yaw),
        ]  # fmt: skip

    def _tell(self, now: float) -> list[Frame]:
        said = []
        gone = self._beat_at is not None and now - self._beat_at > failsafe.ACTUATORS_GONE
        if gone and now + 1e-6 >= self._due["Emergency"]:
            self._due["Emergency"] = now + failsafe.EMERGENCY_PERIOD_LATER
            said.append(self._codec.encode("SensorsEmergency", Reason="COMMANDS_SILENT", Release=True))
        if now + 1e-6 >= self._due["Current"]:
            self._due["Current"] = now + CURRENT_PERIOD
            north, east = np.clip(self.reckoning.current(), -FASTEST, FASTEST).tolist()
            said.append(self._codec.encode("Current", North=north, East=east))
        if now + 1e-6 >= self._due["Beat"]:
            self._due["Beat"] = now + BEAT_PERIOD
            state, reason = ("RUNS", "NONE") if self._trusted(now) else ("FAILS_SAFE", "SENSORS_SILENT")
            uptime = min(now - (self._began or 0.0), MOST_UPTIME)
            said.append(self._codec.encode("SensorsBeat", State=state, Uptime=uptime, Reason=reason))
        return said

    def _trusted(self, now: float) -> bool:
        return self._attitude.trusted(now) and self._vertical.trusted(now)

    def _level(self, speed: Array) -> tuple[float, float]:
        """Return the speed ahead and to starboard in the horizontal plane, of one along the body's axes."""
        roll, pitch = np.radians(self._attitude.angles[:2])
        u, v, w = speed
        across = v * sin(roll) + w * cos(roll)
        return float(u * cos(pitch) + across * sin(pitch)), float(v * cos(roll) - w * sin(roll))

    def _heave(self, speed: Array) -> float:
        """Return the speed along the body's downward axis that makes it sink as the depth tells."""
        roll, pitch = np.radians(self._attitude.angles[:2])
        upright = max(0.3, cos(roll) * cos(pitch))
        return float(
            (self._vertical.rate + speed[0] * sin(pitch) - speed[1] * cos(pitch) * sin(roll)) / upright
        )

    def _current(self) -> Array:
        """Return the current along the body's axes ahead and to starboard."""
        heading = radians(self._attitude.angles[2]) - self.reckoning.compass_bias
        north, east = self.reckoning.current()
        return np.array(
            (cos(heading) * north + sin(heading) * east, -sin(heading) * north + cos(heading) * east)
        )

    def _hear_pressure(self, found: Received, now: float) -> None:
        self._vertical.take_pressure(float(found.values["Pressure"]), now)

    def _hear_rates(self, found: Received, now: float) -> None:
        self._attitude.take_rates(_three(found, "Roll", "Pitch", "Yaw"), now)

    def _hear_attitude(self, found: Received, now: float) -> None:
        self._attitude.take_angles(_three(found, "Roll", "Pitch", "Heading"), now)

    def _hear_speed(self, found: Received, now: float) -> None:
        if not found.values["Valid"]:
            return
        speed = _three(found, "Surge", "Sway", "Heave")
        residual = speed - self._water.speed - self._flow
        age = self._log.age(now)
        allowed = np.inf if age >= 2.0 else 0.3 + 6.0 * self._log_noise + age
        if not self._log.judge(
            speed.tolist(), now, residual=float(np.abs(residual[:2]).max()), allowed=allowed
        ):
            return
        self._flow[:2] += (FLOW_GAIN if age < 2.0 else 1.0) * residual[:2]
        compass = radians(self._attitude.angles[2])
        water = np.array(self._level(self._water.speed))
        self.reckoning.note_current(compass, np.array(self._level(speed)), water)
        roll, pitch = np.radians(self._attitude.angles[:2])
        across = speed[1] * sin(roll) + speed[2] * cos(roll)
        self._vertical.take_rate(float(-speed[0] * sin(pitch) + across * cos(pitch)), now)

    def _hear_fix(self, found: Received, now: float) -> None:
        self.reckoning.fix(float(found.values["North"]), float(found.values["East"]))

    def _hear_beat(self, found: Received, now: float) -> None:
        self._beat_at = now


def _three(found: Received, *names: str) -> Array:
    return np.array([float(found.values[name]) for name in names])
