"""Numbers of MAVLink that are written down, so that its library need not be there, are the library's."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.autopilots import PX4
from mmrs_mavlink.services import items
from mmrs_mavlink.vehicles.modes import MAV_PARAM_TYPE_INT32


def test_numbers_are_those_of_the_library() -> None:
    assert mavlink.MAV_AUTOPILOT_PX4 == PX4
    assert mavlink.MAV_PARAM_TYPE_INT32 == MAV_PARAM_TYPE_INT32
    assert (items.MISSION, items.FENCE, items.RALLY) == (
        mavlink.MAV_MISSION_TYPE_MISSION,
        mavlink.MAV_MISSION_TYPE_FENCE,
        mavlink.MAV_MISSION_TYPE_RALLY,
    )
    assert (items.RELATIVE, items.NO_FRAME) == (
        mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
        mavlink.MAV_FRAME_MISSION,
    )
    assert (items.WAYPOINT, items.LOITER, items.CHANGE_SPEED, items.FENCE_VERTEX, items.RALLY_POINT) == (
        mavlink.MAV_CMD_NAV_WAYPOINT,
        mavlink.MAV_CMD_NAV_LOITER_UNLIM,
        mavlink.MAV_CMD_DO_CHANGE_SPEED,
        mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
        mavlink.MAV_CMD_NAV_RALLY_POINT,
    )
