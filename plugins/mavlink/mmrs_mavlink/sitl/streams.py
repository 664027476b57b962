"""Streams of telemetry: messages at their rates, and events as they occur."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import telemetry
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.camera import Photo
from mmrs_mavlink.sitl.commands import ACCEPTED, FAILED, arming_refusal
from mmrs_runtime.sights import seen

Message = Any

REFUSAL_SECONDS = 30.0
"""Time between two reports that a vehicle refuses to arm."""

TEXT_BYTES = 50


class Streams:
    """Sends the telemetry of one vehicle."""

    def __init__(self, pilot: SimulatedAutopilot, send: Callable[[Message], None]) -> None:
        self._pilot = pilot
        self._send = send
        self._begin(telemetry.usual_rates(pilot.settings))

    def reboot(self) -> None:
        """Forget all requests: an ArduPilot then sends heartbeats only."""
        usual = telemetry.usual_rates(self._pilot.settings)
        self._begin(usual if self._pilot.px4 else {"HEARTBEAT": usual["HEARTBEAT"]})

    def _begin(self, rates: Mapping[str, float]) -> None:
        self._periods = {name: 1.0 / rate for name, rate in rates.items()}
        self._due = dict.fromkeys(self._periods, 0.0)
        self._refusal_due = 0.0

    def set_interval(self, number: float, microseconds: float) -> int:
        """Send a message at an interval: -1 never, 0 the default; return a MAV_RESULT."""
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

    def send_once(self, number: float) -> int:
        """Send a requested message; return a MAV_RESULT."""
        name = self._name(number)
        message = telemetry.MAKERS[name](self._pilot) if name is not None else None
        if message is None:
            return FAILED
        self._send(message)
        return ACCEPTED

    def advance(self) -> None:
        """Send what is due."""
        pilot = self._pilot
        if pilot.heartbeat_due and not pilot.px4:
            self._due["HEARTBEAT"] = 0.0
        pilot.heartbeat_due = False
        for name, period in self._periods.items():
            if pilot.time >= self._due[name]:
                self._due[name] = max(self._due[name] + period, pilot.time - period)
                self.send(name)
        self._send_events()

    def send(self, name: str) -> None:
        """Send a message, and those that accompany it."""
        pilot = self._pilot
        message = telemetry.MAKERS[name](pilot)
        if message is not None:
            self._send(message)
        if name == "MISSION_CURRENT" and pilot.pending is not None:
            self._send(mavlink.MAVLink_mission_item_reached_message(pilot.pending))
            pilot.pending = None
        if name == "SYS_STATUS":
            now = telemetry.milliseconds(pilot)
            for sensor, value in pilot.settings.values.items():
                measured = value(pilot.time)
                self._send(mavlink.MAVLink_named_value_float_message(now, sensor.encode(), measured))

    def _name(self, number: float) -> str | None:
        name = telemetry.NUMBERS.get(int(number))
        return None if name in telemetry.missing(self._pilot.settings) else name

    def _send_events(self) -> None:
        pilot = self._pilot
        while pilot.texts:
            severity, text = pilot.texts.pop(0)
            self._send(mavlink.MAVLink_statustext_message(severity, text.encode()[:TEXT_BYTES]))
        while pilot.camera.unsent:
            taken = pilot.camera.photos[-pilot.camera.unsent]
            pilot.camera.unsent -= 1
            self._send(telemetry.photo(pilot, taken))
            self._report_detections(taken)
        if pilot.armed or pilot.uptime < max(self._refusal_due, pilot.settings.ready):
            return
        if why := arming_refusal(pilot):
            self._refusal_due = pilot.uptime + REFUSAL_SECONDS
            pilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"PreArm: {why}")

    def _report_detections(self, taken: Photo) -> None:
        """Report the objects in a photo, with their positions if those fit into a text."""
        for each in seen(self._pilot.settings.sights, *taken.place):
            latitude, longitude = self._pilot.degrees_at((each.north, each.east, 0.0))
            text = f"detected {each.name}"
            placed = f"{text} at {latitude:.6f},{longitude:.6f}"
            self._pilot.say(mavlink.MAV_SEVERITY_NOTICE, placed if len(placed) <= TEXT_BYTES else text)
