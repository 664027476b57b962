"""Reports of a vehicle's batteries (BATTERY_STATUS), one after the other."""

from __future__ import annotations

from collections.abc import Callable

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Message


class Batteries:
    """Keeps the last report of each battery except the payload's; an observer of the vehicle's link."""

    def __init__(self, component: Callable[[], int]) -> None:
        """Create without reports; `component` gives that of the autopilot, which reports its batteries."""
        self._component = component
        self._told: dict[int, tuple[int, int]] = {}

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Keep the report of a battery that propels the vehicle."""
        if outgoing or message.get_type() != "BATTERY_STATUS":
            return
        payload = message.battery_function == mavlink.MAV_BATTERY_FUNCTION_PAYLOAD
        if message.get_srcComponent() == self._component() and not payload:
            told = (int(message.battery_remaining), int(message.charge_state))
            self._told = {**self._told, int(message.id): told}

    @property
    def left(self) -> float | None:
        """Return the part that is left in the battery that has least; None where none tells it."""
        known = [left for left, _ in self._told.values() if left >= 0]
        return min(known) / 100.0 if known else None

    @property
    def state(self) -> int:
        """Return the gravest MAV_BATTERY_CHARGE_STATE of those that do not charge; 0: none tells one."""
        charging = mavlink.MAV_BATTERY_CHARGE_STATE_CHARGING
        return max((state for _, state in self._told.values() if state < charging), default=0)
