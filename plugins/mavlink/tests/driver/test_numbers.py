"""Numbers of MAVLink that are written down, so that its library need not be there, are the library's."""

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import ARDUPILOT, PX4, autopilot
from mmrs_mavlink.services import items


def test_numbers_are_those_of_the_library() -> None:
    assert (ARDUPILOT.number, PX4.number) == (mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA, mavlink.MAV_AUTOPILOT_PX4)
    assert (autopilot.MISSION, autopilot.RALLY) == (items.MISSION, items.RALLY)
    assert (autopilot.WAYPOINT, autopilot.LOITER_UNLIMITED, autopilot.LOITER_TIME, autopilot.LAND) == (
        mavlink.MAV_CMD_NAV_WAYPOINT,
        mavlink.MAV_CMD_NAV_LOITER_UNLIM,
        mavlink.MAV_CMD_NAV_LOITER_TIME,
        mavlink.MAV_CMD_NAV_LAND,
    )
    assert (
        autopilot.RETURN_TO_LAUNCH,
        autopilot.TAKE_OFF,
        autopilot.ROI_LOCATION,
        autopilot.CAMERA_TRIGGER_DISTANCE,
        autopilot.RALLY_POINT,
    ) == (
        mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH,
        mavlink.MAV_CMD_NAV_TAKEOFF,
        mavlink.MAV_CMD_DO_SET_ROI_LOCATION,
        mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST,
        mavlink.MAV_CMD_NAV_RALLY_POINT,
    )
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
