"""Writes what goes over a link into a black box: fixes, commands, uploads, parameters, photos, messages."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from math import hypot
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.box_entries import FIX_SECONDS, fix
from mmrs_runtime.controllers.state import State
from mmrs_runtime.records.blackbox import BlackBox

from ..links.link import Message
from ..links.messages import tells_place
from ..program import Geographic
from ..services.items import NAMES
from ..vehicles.telemetry import NO_HEADING
from ..vehicles.trail import place_in

OTHER_SECONDS = 1.0
"""Least time between two messages of one type that nothing here knows."""


def _names(words: str) -> frozenset[str]:
    return frozenset(words.split())


SET_POINTS = frozenset(
    {"SET_POSITION_TARGET_GLOBAL_INT", "SET_POSITION_TARGET_LOCAL_NED", "SET_ATTITUDE_TARGET"}
)
TELEMETRY = _names(
    """ADSB_VEHICLE AHRS AHRS2 ALTITUDE ATTITUDE ATTITUDE_QUATERNION BATTERY_STATUS DISTANCE_SENSOR
    EKF_STATUS_REPORT ESTIMATOR_STATUS EXTENDED_SYS_STATE FENCE_STATUS GLOBAL_POSITION_INT GPS_GLOBAL_ORIGIN
    GPS_RAW_INT GPS2_RAW HEARTBEAT HIGHRES_IMU HWSTATUS LOCAL_POSITION_NED MEMINFO MISSION_CURRENT
    NAMED_VALUE_FLOAT NAMED_VALUE_INT NAV_CONTROLLER_OUTPUT OBSTACLE_DISTANCE ODOMETRY POWER_STATUS
    POSITION_TARGET_GLOBAL_INT POSITION_TARGET_LOCAL_NED RADIO_STATUS RAW_IMU RC_CHANNELS SCALED_IMU2
    SCALED_IMU3 SCALED_PRESSURE SENSOR_OFFSETS SERVO_OUTPUT_RAW SIMSTATE SYS_STATUS SYSTEM_TIME TERRAIN_REPORT
    TIMESYNC VFR_HUD VIBRATION WIND WIND_COV UTM_GLOBAL_POSITION"""
)
"""What vehicles send all the time."""

TOLD_OTHERWISE = _names(
    """COMMAND_ACK MISSION_ACK MISSION_COUNT MISSION_ITEM MISSION_ITEM_INT MISSION_REQUEST MISSION_REQUEST_INT
    PARAM_VALUE STATUSTEXT CAMERA_IMAGE_CAPTURED CAMERA_FEEDBACK"""
)
SECRET = frozenset({"secret_key", "mavpackettype"})
NO_ANSWER = "no answer"


class Recording:
    """Observes one link; the robot's thread reports messages sent, the link's reader those received.

    Commands are written when the vehicle has answered, or when the next one shows that it never did.
    """

    def __init__(
        self, box: BlackBox, clock: Clock, state: Callable[[], State], *, geographic: bool = True
    ) -> None:
        """Write into a box.

        Args:
            box: open.
            clock: of the run.
            state: gives what the vehicle last told; its place is not taken from there.
            geographic: whether places are degrees, as in the robot's program.
        """
        self._box = box
        self._clock = clock
        self._state = state
        self._geographic = geographic
        self._fixed = float("-inf")
        self._armed = False
        self._others: dict[str, float] = {}
        self._set_points: dict[str, Mapping[str, object]] = {}
        self._commands: dict[int, tuple[float, int, list[float]]] = {}
        self._upload: dict[int, tuple[float, int]] = {}
        self._values: dict[str, float] = {}
        self._asked: dict[str, float] = {}
        self._lock = threading.Lock()

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Write what a message tells."""
        kind = message.get_type()
        with self._lock:
            if outgoing:
                self._sent(message, kind)
            elif kind in _HEARD:
                _HEARD[kind](self, message)
            elif kind not in TELEMETRY | TOLD_OTHERWISE:
                self._other(message, kind)

    def _sent(self, message: Message, kind: str) -> None:
        if kind == "HEARTBEAT":
            return
        fields = _fields(message)
        if kind in SET_POINTS:
            same = {name: value for name, value in fields.items() if name != "time_boot_ms"}
            if self._set_points.get(kind) == same:
                return
            self._set_points[kind] = same
        self._box.write("message", direction="out", type=kind, fields=fields)
        if kind in _SENT:
            _SENT[kind](self, message)

    def _other(self, message: Message, kind: str) -> None:
        now = self._clock.now()
        if now - self._others.get(kind, float("-inf")) >= OTHER_SECONDS:
            self._others[kind] = now
            self._box.write("message", direction="in", type=kind, fields=_fields(message))

    def _on_command(self, message: Message) -> None:
        params = [getattr(message, f"param{n}") for n in range(1, 8)]
        self._asks(int(message.command), params, again=bool(message.confirmation))

    def _on_command_at(self, message: Message) -> None:
        number = int(message.command)
        params = [*(getattr(message, f"param{n}") for n in range(1, 5)), message.x, message.y, message.z]
        _, _, before = self._commands.get(number, (0.0, 0, []))
        self._asks(number, params, again=params == before)

    def _asks(self, number: int, params: list[float], *, again: bool) -> None:
        begun, tries, _ = self._commands.get(number, (self._clock.now(), 0, []))
        if tries and not again:
            self._answered(number, NO_ANSWER)
            begun, tries = self._clock.now(), 0
        self._commands[number] = (begun, tries + 1, params)

    def _on_command_ack(self, message: Message) -> None:
        if message.result != mavlink.MAV_RESULT_IN_PROGRESS and message.command in self._commands:
            self._answered(int(message.command), _word("MAV_RESULT", message.result))

    def _answered(self, number: int, result: str) -> None:
        begun, tries, params = self._commands.pop(number)
        name, seconds = _word("MAV_CMD", number), round(self._clock.now() - begun, 3)
        self._box.write("command", name=name, params=params, result=result, seconds=seconds, tries=tries)

    def _on_count(self, message: Message) -> None:
        self._upload.setdefault(message.mission_type, (self._clock.now(), message.count))

    def _on_clear(self, message: Message) -> None:
        self._upload.setdefault(message.mission_type, (self._clock.now(), 0))

    def _on_mission_ack(self, message: Message) -> None:
        found = self._upload.pop(message.mission_type, None)
        if found is None:
            return
        begun, items = found
        result = _word("MAV_MISSION_RESULT", message.type).removeprefix("MISSION_")
        self._box.write(
            "upload",
            what=NAMES.get(message.mission_type, str(message.mission_type)),
            items=items,
            seconds=round(self._clock.now() - begun, 3),
            result=result,
        )

    def _on_set(self, message: Message) -> None:
        self._asked[_text(message.param_id)] = message.param_value

    def _on_parameter(self, message: Message) -> None:
        name, value = _text(message.param_id), message.param_value
        was = self._values.get(name)
        if self._asked.get(name) == value or (was is not None and was != value):
            self._box.write("parameter", name=name, value=value, was=was)
        self._asked.pop(name, None)
        self._values[name] = value

    def _on_position(self, message: Message) -> None:
        now, geographic = self._clock.now(), message.get_type() == "GLOBAL_POSITION_INT"
        wanted = geographic == self._geographic and tells_place(message)
        if not wanted or now - self._fixed < FIX_SECONDS:
            return
        self._fixed = now
        # The link keeps a message once everybody has seen it: the state is still that of the one before.
        state = replace(self._state(), place=place_in(message), speed=_speed(message))
        fix(self._box, state if (north := _heading(message)) is None else replace(state, heading=north))

    def _on_heartbeat(self, message: Message) -> None:
        """Write where it was armed or disarmed: a program ends with that, before the next position."""
        armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
        if message.autopilot == mavlink.MAV_AUTOPILOT_INVALID or armed == self._armed:
            return
        self._armed = armed
        if self._fixed > float("-inf"):
            fix(self._box, replace(self._state(), armed=armed))

    def _on_text(self, message: Message) -> None:
        severity = _word("MAV_SEVERITY", message.severity)
        self._box.write("text", severity=severity, text=_text(message.text))

    def _on_captured(self, message: Message) -> None:
        if message.capture_result == 1:
            place = Geographic(message.lat * 1e-7, message.lon * 1e-7, message.relative_alt * 1e-3)
            self._box.write("photo", index=message.image_index, place=place)
        else:
            self._other(message, message.get_type())

    def _on_feedback(self, message: Message) -> None:
        place = Geographic(message.lat * 1e-7, message.lng * 1e-7, message.alt_rel)
        self._box.write("photo", index=message.img_idx, place=place)


_SENT: Mapping[str, Callable[[Recording, Any], None]] = {
    "COMMAND_LONG": Recording._on_command,
    "COMMAND_INT": Recording._on_command_at,
    "MISSION_COUNT": Recording._on_count,
    "MISSION_CLEAR_ALL": Recording._on_clear,
    "PARAM_SET": Recording._on_set,
}
_HEARD: Mapping[str, Callable[[Recording, Any], None]] = {
    "COMMAND_ACK": Recording._on_command_ack,
    "MISSION_ACK": Recording._on_mission_ack,
    "PARAM_VALUE": Recording._on_parameter,
    "HEARTBEAT": Recording._on_heartbeat,
    "GLOBAL_POSITION_INT": Recording._on_position,
    "LOCAL_POSITION_NED": Recording._on_position,
    "STATUSTEXT": Recording._on_text,
    "CAMERA_IMAGE_CAPTURED": Recording._on_captured,
    "CAMERA_FEEDBACK": Recording._on_feedback,
}


def _speed(message: Message) -> float:
    unit = 0.01 if message.get_type() == "GLOBAL_POSITION_INT" else 1.0
    return unit * hypot(message.vx, message.vy, message.vz)


def _heading(message: Message) -> float | None:
    if message.get_type() != "GLOBAL_POSITION_INT" or message.hdg == NO_HEADING:
        return None
    return float(message.hdg) / 100.0


def _fields(message: Message) -> dict[str, object]:
    return {name: value for name, value in message.to_dict().items() if name not in SECRET}


def _word(enum: str, number: int) -> str:
    entry = mavlink.enums[enum].get(number)
    return entry.name.removeprefix(f"{enum}_") if entry is not None else str(number)


def _text(value: object) -> str:
    return value.decode("utf-8", "replace").rstrip("\0") if isinstance(value, bytes) else str(value)
