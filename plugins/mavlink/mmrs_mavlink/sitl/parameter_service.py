"""The vehicle's side of the parameter protocol."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.parameters import decoded, encoded

Message = Any

AT_ONCE = 10
"""Parameters of a list that are told in one go."""

GPS_SWITCH = "SIM_GPS1_ENABLE"
"""By which ArduPilot's simulation, too, switches its GPS receiver off and on."""


class ParameterService:
    """Sets parameters and tells them; one that the vehicle does not have is not answered."""

    def __init__(self, pilot: Autopilot, send: Callable[[Message], None]) -> None:
        """Answer for a vehicle by `send`."""
        self._pilot = pilot
        self._send = send
        self._listed: list[str] = []

    def begin(self) -> None:
        """Forget what was asked for, as after a boot."""
        self._listed.clear()

    def take(self, message: Message) -> None:
        """Answer a message, if it is one of the protocol."""
        handler = _HANDLERS.get(message.get_type())
        if handler is not None:
            handler(self, message)

    def go_on(self) -> None:
        """Tell a few more of those that are to be listed."""
        for name in self._listed[:AT_ONCE]:
            self._tell(name)
        del self._listed[:AT_ONCE]

    def _set(self, message: Message) -> None:
        name, pilot = message.param_id, self._pilot
        if name not in pilot.parameters:
            return
        value = decoded(name, message.param_value, message.param_type, pilot.settings.firmware)
        pilot.parameters[name] = value
        if name == GPS_SWITCH:
            pilot.located = bool(value)
        self._tell(name)

    def _read(self, message: Message) -> None:
        names = list(self._pilot.parameters)
        name = names[message.param_index] if 0 <= message.param_index < len(names) else message.param_id
        if name in self._pilot.parameters:
            self._tell(name)

    def _list(self, message: Message) -> None:
        self._listed = list(self._pilot.parameters)

    def _tell(self, name: str) -> None:
        values = self._pilot.parameters
        value, kind = encoded(name, values[name], self._pilot.settings.firmware)
        index = list(values).index(name)
        self._send(mavlink.MAVLink_param_value_message(name.encode(), value, kind, len(values), index))


_HANDLERS: Mapping[str, Callable[[ParameterService, Message], None]] = {
    "PARAM_SET": ParameterService._set,
    "PARAM_REQUEST_READ": ParameterService._read,
    "PARAM_REQUEST_LIST": ParameterService._list,
}
