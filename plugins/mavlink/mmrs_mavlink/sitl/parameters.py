"""Parameters of a simulated vehicle, and its side of the parameter protocol.

The defaults are those that vehicles act on or that ground software reads: ArduPilot's from its versions 4.3
to 4.6, integers where they are integers there, and PX4's from its parameter reference.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import Autopilot
from mmrs_mavlink.sitl.settings import PX4, Settings

Message = Any

LOW_CELL = 3.5
"""Volts of a cell at which a battery is low."""

_COMMON: Mapping[str, float] = {
    **dict.fromkeys(("FS_GCS_ENABLE", "BATT_FS_LOW_ACT", "BATT_LOW_MAH", "FENCE_ENABLE", "MIS_RESTART"), 0),
    "SYSID_MYGCS": 255,
    "FS_GCS_TIMEOUT": 5.0,
    "BATT_LOW_TIMER": 10,
    "FENCE_ACTION": 1,
    "FENCE_TYPE": 7,
    "FENCE_ALT_MAX": 100.0,
    "FENCE_RADIUS": 300.0,
    "FENCE_MARGIN": 2.0,
    "RALLY_LIMIT_KM": 0.3,
    "RALLY_INCL_HOME": 1,
    "SIM_GPS1_ENABLE": 1,
    **{f"RELAY{number}_FUNCTION": 1 for number in range(1, 7)},
    **{f"RELAY{number}_PIN": 49 + number for number in range(1, 7)},
    **{f"SERVO{number}_FUNCTION": 0 for number in range(5, 10)},
    **{"SERVO10_FUNCTION": 10, "SERVO11_FUNCTION": 28, "SERVO12_FUNCTION": 88},
    **dict.fromkeys(("CAM1_TYPE", "GRIP_ENABLE", "GRIP_TYPE", "WINCH_TYPE", "MNT1_TYPE"), 1),
    "CAM2_TYPE": 6,
}
"""Every device that a program may use is set up: two cameras, of which the second records videos."""

_RATES = {"WPNAV_SPEED_UP": 250.0, "WPNAV_SPEED_DN": 150.0, "ATC_SLEW_YAW": 6000.0}
_AVOIDING = {"AVOID_MARGIN": 2.0, "OA_TYPE": 0, "OA_MARGIN_MAX": 5.0}
_COPTER: Mapping[str, float] = {
    **_AVOIDING,
    **_RATES,
    "FS_OPTIONS": 16,
    "FS_EKF_ACTION": 1,
    "DISARM_DELAY": 10,
    "AUTO_OPTIONS": 0,
    "RTL_ALT": 1500,
    "WPNAV_SPEED": 500.0,
    "WPNAV_RADIUS": 200.0,
}
_ROVER: Mapping[str, float] = {
    **_AVOIDING,
    "FS_ACTION": 2,
    "FS_OPTIONS": 0,
    "RALLY_LIMIT_KM": 0.5,
    "FS_EKF_ACTION": 1,
    "WP_SPEED": 2.0,
    "WP_RADIUS": 2.0,
    "WP_PIVOT_ANGLE": 0.0,
}
_SUB: Mapping[str, float] = {
    **_RATES,
    "FS_GCS_ENABLE": 1,
    "FS_GCS_TIMEOUT": 3.0,
    "FS_EKF_ACTION": 0,
    "WPNAV_SPEED": 50.0,
    "WPNAV_RADIUS": 200.0,
}
_PX4: Mapping[str, float] = {
    **dict.fromkeys(("NAV_DLL_ACT", "COM_DLL_EXCEPT", "COM_OBL_RC_ACT", "COM_LOW_BAT_ACT", "RTL_TYPE"), 0),
    **dict.fromkeys(("GF_MAX_HOR_DIST", "GF_MAX_VER_DIST", "COM_TAKEOFF_ACT", "COM_OBS_AVOID"), 0),
    "BAT1_SOURCE": 0,
    "COM_DL_LOSS_T": 10,
    "GF_ACTION": 2,
    "COM_OF_LOSS_T": 1.0,
    "COM_DISARM_PRFLT": 10.0,
    "NAV_ACC_RAD": 2.0,
    "MPC_Z_V_AUTO_UP": 3.0,
    "MPC_Z_V_AUTO_DN": 1.5,
    "MPC_YAWRAUTO_MAX": 45.0,
    "MIS_DIST_1WP": 900.0,
    "RTL_RETURN_ALT": 15.0,
    "MPC_XY_CRUISE": 5.0,
    "MPC_XY_VEL_MAX": 12.0,
    "TRIG_MODE": 1,
    "PD_GRIPPER_EN": 1,
}
_BY_KIND: Mapping[str, Mapping[str, float]] = {"copter": _COPTER, "rover": _ROVER, "sub": _SUB}


def defaults(settings: Settings) -> dict[str, float]:
    """Return the parameters of a vehicle: the defaults, and those of its settings."""
    if settings.firmware == PX4:
        return {**_PX4, "BAT1_CAPACITY": settings.capacity, **settings.parameters}
    own = {"BATT_CAPACITY": settings.capacity, "BATT_LOW_VOLT": LOW_CELL * settings.cells}
    return {**_COMMON, **_BY_KIND[settings.kind], **own, **settings.parameters}


class ParameterService:
    """Sets and sends parameters; a request for an unknown one is not answered."""

    def __init__(
        self, values: dict[str, float], autopilot: Autopilot, send: Callable[[Message], None]
    ) -> None:
        self._values, self._autopilot, self._send = values, autopilot, send

    def take(self, message: Message) -> None:
        """Answer a message of the protocol, and ignore others."""
        kind, names = message.get_type(), list(self._values)
        if kind == "PARAM_REQUEST_LIST":
            for name in names:
                self._answer(name)
        elif kind == "PARAM_REQUEST_READ":
            found = 0 <= message.param_index < len(names)
            self._answer(names[message.param_index] if found else message.param_id)
        elif kind == "PARAM_SET" and message.param_id in self._values:
            value = self._autopilot.decoded(message.param_value, message.param_type)
            self._values[message.param_id] = value
            self._answer(message.param_id)

    def _answer(self, name: str) -> None:
        if name in self._values:
            value, kind = self._autopilot.encoded(name, self._values[name])
            index = list(self._values).index(name)
            self._send(
                mavlink.MAVLink_param_value_message(name.encode(), value, kind, len(self._values), index)
            )
