"""What the vehicle tells by itself, and how often."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import telemetry
from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.camera import Photo
from mmrs_mavlink.sitl.commands import ACCEPTED, complaint
from mmrs_mavlink.sitl.settings import PX4
from mmrs_runtime.sights import seen

Message = Any

FAILED = int(mavlink.MAV_RESULT_FAILED)
UNFIT_SECONDS = 30.0
TEXT_BYTES = 50


class Streams:
    """Tells each message at its rate, and what happens when it happens."""

    def __init__(self, pilot: Autopilot, send: Callable[[Message], None]) -> None:
        """Tell of a vehicle by `send`."""
        self._pilot = pilot
        self._send = send
        self.begin()

    def begin(self) -> None:
        """Forget what was asked for, as after a boot."""
        usual = telemetry.usual_rates(self._pilot.settings)
        self._periods = {name: 1.0 / rate for name, rate in usual.items()}
        self._due = dict.fromkeys(self._periods, 0.0)
        self._unfit_due = 0.0

    def ask(self, number: float, microseconds: float) -> int:
        """Tell a message so often from now on: -1 never, 0 as usual; return a MAV_RESULT."""
        name = self._name(number)
        if name is None:
            return FAILED
        if microseconds < 0.0:
            self._periods.pop(name, None)
            return ACCEPTED
        usual = telemetry.usual_rates(self._pilot.settings).get(name, 1.0)
        self._periods[name] = microseconds * 1e-6 or 1.0 / usual
        self._due[name] = 0.0
        return ACCEPTED

    def tell_now(self, number: float) -> int:
        """Tell a message once; return a MAV_RESULT."""
        name = self._name(number)
        message = telemetry.TELLERS[name](self._pilot) if name is not None else None
        if message is None:
            return FAILED
        self._send(message)
        return ACCEPTED

    def go_on(self) -> None:
        """Tell what is due."""
        pilot = self._pilot
        if pilot.beats_now:
            pilot.beats_now = False
            if pilot.settings.firmware != PX4:
                self._due["HEARTBEAT"] = 0.0
        for name, period in self._periods.items():
            if pilot.time >= self._due[name]:
                self._due[name] = max(self._due[name] + period, pilot.time - period)
                self.tell(name)
        self._tell_events()

    def tell(self, name: str) -> None:
        """Tell one message, and what goes with it."""
        message = telemetry.TELLERS[name](self._pilot)
        if message is not None:
            self._send(message)
        if name == "MISSION_CURRENT" and self._pilot.pending is not None:
            self._send(mavlink.MAVLink_mission_item_reached_message(self._pilot.pending))
            self._pilot.pending = None
        if name == "SYS_STATUS":
            self._tell_values()

    def _name(self, number: float) -> str | None:
        name = telemetry.NUMBERS.get(int(number))
        return None if name in telemetry.FIRMWARE[self._pilot.settings.firmware] else name

    def _tell_values(self) -> None:
        now = telemetry.milliseconds(self._pilot)
        for name, value in self._pilot.settings.values.items():
            told = value(self._pilot.time)
            self._send(mavlink.MAVLink_named_value_float_message(now, name.encode(), told))

    def _tell_events(self) -> None:
        pilot = self._pilot
        while pilot.texts:
            severity, text = pilot.texts.pop(0)
            self._send(mavlink.MAVLink_statustext_message(severity, text.encode()[:TEXT_BYTES]))
        while pilot.camera.untold:
            taken = pilot.camera.photos[-pilot.camera.untold]
            pilot.camera.untold -= 1
            self._send(telemetry.photo(pilot, taken))
            self._tell_detections(taken)
        self._complain()

    def _tell_detections(self, taken: Photo) -> None:
        """Tell what a photo shows, and where that is if there is room for it."""
        for each in seen(self._pilot.settings.sights, *taken.place):
            latitude, longitude = self._pilot.degrees_at((each.north, each.east, 0.0))
            text = f"detected {each.name}"
            placed = f"{text} at {latitude:.6f},{longitude:.6f}"
            self._pilot.say(mavlink.MAV_SEVERITY_NOTICE, placed if len(placed) <= TEXT_BYTES else text)

    def _complain(self) -> None:
        pilot = self._pilot
        if pilot.armed or pilot.uptime < max(self._unfit_due, pilot.settings.ready):
            return
        why = complaint(pilot)
        if why:
            self._unfit_due = pilot.uptime + UNFIT_SECONDS
            pilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"PreArm: {why}")
