"""Items of a QGroundControl mission."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.behaviour.program import Move
from mmrs_core.scene import Position

WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, LAND, TAKE_OFF = 16, 17, 19, 21, 22
CONDITION_YAW, CHANGE_SPEED, ROI_LOCATION, ROI_NONE = 115, 178, 195, 197
RELATIVE, NO_FRAME = 3, 2
HEIGHT_ABOVE_HOME = 1


@dataclass(frozen=True, slots=True)
class Item:
    """A simple item: a MAV_CMD with its parameters.

    Attributes:
        params: at most seven, four where there is a position; the rest is 0.
        position: in the local frame; None for commands without a place.
        move: that it serves.
    """

    command: int
    move: Move
    params: tuple[float, ...] = ()
    position: Position | None = None


def item_json(item: Item, number: int, place: tuple[float, float, float] | None) -> dict[str, object]:
    """Return an item as plans hold it.

    Args:
        item: the item.
        number: counted from 1.
        place: latitude, longitude and height above home of its position, if it has one.
    """
    length = 7 if place is None else 4
    params = [*item.params, *[0.0] * (length - len(item.params)), *(place or ())]
    simple: dict[str, object] = {
        "type": "SimpleItem",
        "autoContinue": True,
        "command": item.command,
        "doJumpId": number,
        "frame": NO_FRAME if place is None else RELATIVE,
        "params": params,
    }
    if place is not None:
        simple |= {"Altitude": place[2], "AltitudeMode": HEIGHT_ABOVE_HOME, "AMSLAltAboveTerrain": None}
    return simple
