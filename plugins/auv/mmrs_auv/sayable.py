"""What of a behaviour no goal or command on a vehicle's bus can say, or no vehicle may do."""

from __future__ import annotations

from collections.abc import Iterator

from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import layout_of, messages_of
from mmrs_core.behaviour.program import DEVICE_ACTION, Action, Move
from mmrs_core.scene import Position, RobotType
from mmrs_core.scene.attributes import finite

ROUNDING = 1e-3
"""Metres by which places may differ that are the same."""


class Bus:
    """Limits of a vehicle's bus to moves and actions."""

    def __init__(self, sheet: Sheet, surface: float) -> None:
        """Take the vehicle; `surface`: height of the water surface above the mission's origin, metres."""
        self._sheet, self._surface = sheet, surface
        self._layouts = {message.name: layout_of(message) for message in messages_of(sheet)}

    def refused(self, move: Move) -> Iterator[str]:
        """Yield why a move, or what is done before and after it, is refused."""
        if move.target is not None and move.target.position is not None:
            yield from self._of_place(move.target.position)
        for action in (*move.before, *move.after):
            if action.is_a(DEVICE_ACTION):
                yield from self._of_action(action)

    def _of_place(self, place: Position) -> Iterator[str]:
        east, north, up = place
        for name, metres in (("North", north), ("East", east)):
            if not self._holds("GoalPlace", name, metres):
                yield f"leads {metres:g} m to the {name.lower()}, farther than its bus can say"
        deepest, depth = self._sheet.max_depth, self._surface - up
        if depth > deepest + ROUNDING:
            yield f"leads {depth:g} m deep, where its vehicle may go {deepest:.1f} m deep"
        if depth < -ROUNDING:
            yield f"leads {-depth:g} m above the surface"

    def _of_action(self, action: Action) -> Iterator[str]:
        number = parameter_of(action)
        if not self._holds("DeviceCommand", "Parameter", number):
            yield f"parameter {number:g} of device '{action.device}' is more than its bus can say"

    def _holds(self, message: str, field: str, value: float) -> bool:
        part = self._layouts[message].slots[field].field
        return part.low <= value <= part.high


def parameter_of(action: Action) -> float:
    """Return the number that goes with an action: that of its first parameter that is one, else 0."""
    for _, text in action.parameters:
        try:
            return float(text)
        except ValueError:
            continue
    return 0.0


def mount_of(device: str, type: RobotType | None) -> float:
    """Return where a device points when the vehicle looks north, degrees clockwise; the front: 0."""
    return _yaw(device, type) or 0.0


def unturnable(device: str, type: RobotType | None) -> Iterator[str]:
    """Yield why a vehicle cannot turn so that a device of it points somewhere."""
    known = type.devices.get(device) if type is not None else None
    if known is not None and "mavlink.gimbal" in known.properties:
        yield f"device '{device}' turns on its own, where only the vehicle can be turned"
    if _yaw(device, type) is None:
        yield f"device '{device}': mount.yaw is not a number"


def _yaw(device: str, type: RobotType | None) -> float | None:
    known = type.devices.get(device) if type is not None else None
    return finite(known.properties.get("mount.yaw", "0")) if known is not None else 0.0
