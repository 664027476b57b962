"""The actuator controller: from a wrench to thrusters' commands, and no thrust when it is not to be."""

from __future__ import annotations

import numpy as np

from auv_vessel.body.thrust import curve_of
from auv_vessel.control import failsafe
from auv_vessel.control.allocation import DEGREES, Allocation, Array
from auv_vessel.control.drives import CatalogueDrives, DriveMonitor, Drives
from auv_vessel.instruments import instruments_of
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import (
    ACTUATORS,
    BEAT_PERIOD,
    COMMAND_PERIOD,
    EMERGENCIES,
    MOST_UPTIME,
    STATUS_PERIOD,
    by_id,
)
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.frame import Frame

PEAK_TIME, RISE_TIME = 10.0, 0.4
"""Seconds of peak thrust from cold (`Sheet.extra`: ``peak.time``), and from zero to it (``rise.time``)."""

WARM = 0.5
"""Part of its heat that a thruster that was at its limit keeps when it may exceed operating thrust again."""


class ThrustLimits:
    """The state of a vehicle's thrusters as to what they may give.

    A thruster heats by the square of its thrust above operating thrust, and cools by the square of what it
    gives less: peak thrust lasts `PEAK_TIME` from cold, and after that as long at rest makes it cold.
    ``power.limit`` in `Sheet.extra`, watts for all thrusters together, is kept; without it there is none.

    Raises:
        ValueError: a limit in the sheet is not positive.
    """

    def __init__(self, sheet: Sheet) -> None:
        self._peak_time = _positive(sheet, "peak.time", PEAK_TIME)
        self._rise_time = _positive(sheet, "rise.time", RISE_TIME)
        self.power_limit = _positive(sheet, "power.limit", float("inf"))
        self._operating = np.array([each.operating_thrust for each in sheet.thrusters], float)
        self._most = np.array(
            [max(each.max_thrust, each.operating_thrust) for each in sheet.thrusters], float
        )
        curves = [curve_of(each) for each in sheet.thrusters]
        self._watts, self._newtons, self._exponents = np.array(curves, float).reshape(-1, 3).T
        self._heat = np.zeros(len(sheet.thrusters))
        self._hot = np.zeros(len(sheet.thrusters), bool)

    def bounds(self, last: Array, working: Array, period: float) -> tuple[Array, Array]:
        """Return the least and the most newtons of each thruster, `period` seconds after it gave `last`."""
        most = np.where(self._hot, self._operating, self._most) * working
        change = self._most * period / self._rise_time
        low = np.maximum(-most, np.minimum(last - change, most))
        high = np.minimum(most, np.maximum(last + change, -most))
        return low, high

    def used(self, thrusts: Array, period: float) -> None:
        """Account for the thrust that thrusters gave during `period` seconds."""
        square, operating = np.square(thrusts), np.square(self._operating)
        above = np.maximum(np.square(self._most) - operating, 1e-9)
        warming = np.where(square > operating, (square - operating) / above, square / operating - 1.0)
        self._heat = np.clip(self._heat + warming * period / self._peak_time, 0.0, 1.0)
        self._hot = (self._heat >= 1.0) | (self._hot & (self._heat > WARM))

    def power(self, thrusts: Array) -> float:
        """Return the watts that thrusts take together."""
        return float(np.sum(self._watts * (np.abs(thrusts) / self._newtons) ** self._exponents))


def _positive(sheet: Sheet, name: str, default: float) -> float:
    value = sheet.extra.get(name, default)
    if not value > 0.0:
        raise ValueError(f"{sheet.robot}: {name} is {value:g}, and has to be positive")
    return value


GRAVITY = 9.80665
UPRIGHT = 0.1
"""Part of its thrust that a thruster gives up or down, at least, to be one that does."""

LIMITED = 0.05
"""Part of what thrusters can give of a degree that may be missing before a wrench counts as beyond them."""


class Actuators:
    """Shares the wrench of movement among the thrusters that work, within what they may give.

    It gives none before a state was trusted. From the first wrench obeyed on it gives zero thrust, and says
    so to every drive, when no wrench that is complete and valid came in `failsafe.COMMANDS_SILENT`; and for
    good, having sent an emergency that releases the drop weight, when movement or the sensor controller are
    gone, when the state is not to be trusted, when water is inside or its reports have ended,
    when no thruster is left that pushes up or down, or when it is too deep. An emergency of any other node
    counts as its own.

    Args:
        driver: of thrusters; by default the messages of the vehicle's own bus.

    Attributes:
        emergency: why the dive was given up; None: it was not.
        thrusts: newtons commanded last.
        served: of each of `DEGREES`, whether the thrusters that work can push along it alone.
    """

    name = ACTUATORS
    period = COMMAND_PERIOD

    def __init__(self, sheet: Sheet, codec: Codec, driver: Drives | None = None) -> None:
        self._codec = codec
        self._drives: Drives = driver or CatalogueDrives(sheet, codec)
        self._allocation = Allocation(sheet)
        self._limits = ThrustLimits(sheet)
        self._watch = DriveMonitor(sheet)
        self._most = self._allocation.most(np.array([each.operating_thrust for each in sheet.thrusters]))
        self._air = instruments_of(sheet).pressure_air
        self._too_deep = failsafe.deepest(sheet.max_depth) * sheet.water_density * GRAVITY
        self._hearers = by_id({
            "WrenchForce": self._hear_force, "WrenchMoment": self._hear_moment, "Depth": self._hear_depth,
            "Pressure": self._hear_pressure, "Health": self._hear_health, "MovementBeat": self._hear_beat,
            **dict.fromkeys(EMERGENCIES, self._hear_emergency),
        })  # fmt: skip
        self.emergency: str | None = None
        self.thrusts: Array = np.zeros(len(sheet.thrusters))
        self.served = self._allocation.served(self._watch.working)
        self._upright = [abs(each.direction[2]) >= UPRIGHT for each in sheet.thrusters]
        self._upright_at = 0.0
        self._limited = False
        self._force: Received | None = None
        self._wrench: Array = np.zeros(6)
        self._enabled = False
        self._dived = False
        self._sequence: int | None = None
        self._wrench_at: float | None = None
        self._state_at = 0.0
        self._trusted_at: float | None = None
        self._shallow_at: float | None = None
        self._deep = False
        self._leaks = 0
        self._health_at: float | None = None
        self._movement_at: float | None = None
        self._began: float | None = None
        self._emergency_at = 0.0
        self._release = True
        self._due = {"Emergency": 0.0, "Reach": 0.0, "Beat": 0.0}

    def hear(self, frame: Frame, now: float) -> None:
        """Take a wrench, a report of danger, or the status of a thruster."""
        if (status := self._drives.hear(frame)) is not None:
            self._watch.take(status, now)
            return
        hearer = self._hearers.get(frame.id)
        if hearer is not None and (found := self._codec.decode(frame)) is not None:
            hearer(found, now)

    def tick(self, now: float) -> list[Frame]:
        """Command every thruster; send what else is due."""
        self._began = now if self._began is None else self._began
        if (reason := self._danger(now)) is not None:
            self._give_up(reason, now)
        working = self._watch.judge(self.thrusts, now)
        if working is not None:
            self.served = self._allocation.served(working)
        if any(upright and works for upright, works in zip(self._upright, self._watch.working, strict=True)):
            self._upright_at = now
        enable = self._obeys(now)
        self.thrusts = self._shared() if enable else np.zeros(len(self.thrusts))
        self._limits.used(self.thrusts, self.period)
        return [
            *self._emergencies(now),
            *self._drives.commands(self.thrusts.tolist(), enable),
            *self._tell(now, enable),
        ]

    def _obeys(self, now: float) -> bool:
        """Return whether there is a valid wrench."""
        received = self._wrench_at is not None and now - self._wrench_at <= failsafe.COMMANDS_SILENT
        self._dived = self._dived or (received and self._enabled and self._trusted_at is not None)
        return received and self._enabled and self._trusted_at is not None and self.emergency is None

    def _shared(self) -> Array:
        working = np.array(self._watch.working, float)
        low, high = self._limits.bounds(self.thrusts, working, self.period)
        thrusts = self._allocation.thrusts(self._wrench, low, high)
        if self._limits.power(thrusts) > self._limits.power_limit:
            thrusts = self._within_power(low, high)
        missing = np.abs(self._allocation.missing(self._wrench, thrusts))
        self._limited = bool(np.any((missing > LIMITED * self._most + 0.1) & np.array(self.served)))
        return thrusts

    def _within_power(self, low: Array, high: Array) -> Array:
        """Return what comes nearest to the wrench within the power limit: bounds shrink till it is kept."""
        least, most = 0.0, 1.0
        thrusts: Array = np.zeros(len(low))
        for _ in range(8):
            part = (least + most) / 2.0
            tried = self._allocation.thrusts(
                self._wrench, np.minimum(low, 0.0) * part, np.maximum(high, 0.0) * part
            )
            if self._limits.power(tried) > self._limits.power_limit:
                most = part
            else:
                least, thrusts = part, tried
        return thrusts

    def _danger(self, now: float) -> str | None:
        """Return why the dive is to be given up now, or None."""
        if self.emergency is not None:
            return None
        if self._leaks >= failsafe.LEAK_SAID:
            return "LEAK"
        if self._deep and self._shallow_at is not None and now - self._shallow_at > failsafe.DEEP_FOR:
            return "TOO_DEEP"
        if self._trusted_at is None or self._wrench_at is None or not self._dived:
            return None
        if self._movement_at is not None and now - self._movement_at > failsafe.MOVEMENT_GONE:
            return "COMMANDS_SILENT"
        if self._health_at is not None and now - self._health_at > failsafe.HEALTH_SILENT:
            return "SENSORS_SILENT"
        if any(self._upright) and now - self._upright_at > failsafe.UNSERVED:
            return "THRUSTER_FAULT"
        if now - self._wrench_at > failsafe.COMMANDS_GONE:
            return "COMMANDS_SILENT"
        if now - self._state_at > failsafe.STATE_SILENT or now - self._trusted_at > failsafe.STATE_UNTRUSTED:
            return "SENSORS_SILENT"
        return None

    def _give_up(self, reason: str, now: float) -> None:
        self.emergency = reason
        self._emergency_at = now

    def _emergencies(self, now: float) -> list[Frame]:
        if self.emergency is None or now + 1e-6 < self._due["Emergency"]:
            return []
        often = now - self._emergency_at < failsafe.EMERGENCY_OFTEN
        self._due["Emergency"] = now + (
            failsafe.EMERGENCY_PERIOD if often else failsafe.EMERGENCY_PERIOD_LATER
        )
        return [self._codec.encode("ActuatorsEmergency", Reason=self.emergency, Release=self._release)]

    def _tell(self, now: float, enable: bool) -> list[Frame]:
        said = []
        working = self._watch.working
        if now + 1e-6 >= self._due["Reach"]:
            self._due["Reach"] = now + STATUS_PERIOD
            degrees = dict(zip(DEGREES, self.served, strict=True))
            limited = self._limited and enable
            said.append(self._codec.encode("Reach", **degrees, Limited=limited, Thrusters=sum(working)))
        if now + 1e-6 >= self._due["Beat"]:
            self._due["Beat"] = now + BEAT_PERIOD
            fault = "NONE" if all(working) else "THRUSTER_FAULT"
            state = "RUNS" if self.emergency is None else "FAILS_SAFE"
            uptime = min(now - (self._began or 0.0), MOST_UPTIME)
            said.append(
                self._codec.encode(
                    "ActuatorsBeat", State=state, Uptime=uptime, Reason=self.emergency or fault
                )
            )
        return said

    def _hear_force(self, found: Received, now: float) -> None:
        self._force = found

    def _hear_moment(self, found: Received, now: float) -> None:
        """Take a wrench: its force came before with the same counter, and it is not one that came already."""
        force = self._force
        if force is None or force.sequence != found.sequence or found.sequence == self._sequence:
            return
        values = {**force.values, **found.values}
        self._wrench = np.array([float(values[degree]) for degree in DEGREES])
        self._sequence, self._wrench_at = found.sequence, now
        self._enabled = bool(values["Enable"])

    def _hear_depth(self, found: Received, now: float) -> None:
        self._state_at = now
        if found.values["Trusted"]:
            self._trusted_at = now

    def _hear_pressure(self, found: Received, now: float) -> None:
        self._deep = float(found.values["Pressure"]) - self._air > self._too_deep
        if not self._deep or self._shallow_at is None:
            self._shallow_at = now

    def _hear_health(self, found: Received, now: float) -> None:
        self._leaks = self._leaks + 1 if found.values["Leak"] else 0
        self._health_at = now

    def _hear_beat(self, found: Received, now: float) -> None:
        self._movement_at = now

    def _hear_emergency(self, found: Received, now: float) -> None:
        if self.emergency is None:
            self._give_up(str(found.values["Reason"]), now)
            self._release = False
        self._release = self._release or bool(found.values["Release"])
