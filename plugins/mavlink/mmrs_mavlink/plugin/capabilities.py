"""How the targets for MAVLink express the Behaviour Language, in words for their tables of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.contributions.samples import SampleWiring

OF_CONTROLLERS: Mapping[str, str] = {
    "Behaviour.crs": "places are converted to WGS 84",
    "Behaviour.origin": "places in degrees with seven decimals",
    "Behaviour.origin absent": "places in metres north and east of each robot's home",
    "Behaviour.altitudeReference": "heights are above each robot's home",
    "Behaviour.geoidSeparation": "heights are above each robot's home",
    "Behaviour.positionError": "the geofence and rally points keep it",
    "Behaviour.surfaceHeight": "heights under water count from it",
    "Robot: multicopter": "ArduCopter; PX4 in the runtime, untested on a PX4",
    "Robot: plain robot": "ArduRover",
    "Robot: auv": "ArduSub",
    "Robot.typeName": "the kind of vehicle, its speeds and devices",
    "Robot.home": "zero of its heights; the vehicle must be near it",
    "Robot.travelMode": "speed, acceptance radius and avoidance",
    "Robot.payload": "the speeds of the capability for it",
    "Context.forbiddenAreas": "exclusion polygons of the vehicle's geofence",
    "Context.obstacles: of unlimited height": "exclusion polygons of the vehicle's geofence",
    "Context.obstacles: with a height": "routes keep clear of it; geofences know no heights",
    "Context.emergencyAreas": "rally points, and where to go from each move",
    "GeoCoordinate": "degrees, and metres above home",
    "RelativeCoordinate": "metres north, east and above home",
    "ObjectTarget": "found by a function of yours in objects.py",
    "GoTo": "position targets in GUIDED; runs of them as a mission in AUTO",
    "GoTo.speed": "DO_CHANGE_SPEED",
    "GoTo.speed absent": "DO_CHANGE_SPEED, by the travel mode",
    "GoTo.trajectory": "two straight legs",
    "TakeOff": "NAV_TAKEOFF in GUIDED",
    "Land": "mode LAND",
    "HoldPosition": "stays, timed by the controller",
    "HeadTo.heading": "turns on the spot; a gimbal: DO_SET_ROI_LOCATION",
    "GoTo.heading": "yaw of the position targets; on missions, and of a gimbal: DO_SET_ROI_LOCATION",
    "Heading.angle": "added to the yaw",
    "Heading.deviceId": "its mount.yaw or mavlink.gimbal counts; absent: the front",
    "Heading.target": "found by a function of yours in objects.py",
    "MoveTransition.waitFor": "waits for slots over the bus",
    "DeviceAction": "COMMAND_LONG, acknowledged",
    "DeviceAction: a value that is measured": "the next NAMED_VALUE_FLOAT of that name",
    "DeviceAction: a camera that tells each image": "COMMAND_LONG; silence is a fault",
    "DeviceAction.parameters": "go before the device's properties",
    "Feedback": "STATUSTEXT to ground stations, unacknowledged; in the status and the black box",
    "Feedback.payload": "in that text",
}

OF_MISSIONS: Mapping[str, str] = {
    "Behaviour.crs": "places are converted to WGS 84",
    "Behaviour.origin": "places in degrees with seven decimals",
    "Behaviour.altitudeReference": "height of the planned home above mean sea level",
    "Behaviour.geoidSeparation": "height of the planned home above mean sea level",
    "Behaviour.name": "is informative",
    "Behaviour.minimumSeparation": "is for the planner and the checks",
    "Behaviour.acceptedUnknowns": "is for the checks",
    "Behaviour.idleRobots": "are for the checks; they are not run",
    "Behaviour.reserve": "a mission knows no battery; the vehicle's own failsafe does",
    "Behaviour.positionError": "the geofence and rally points keep it",
    "Behaviour.surfaceHeight": "heights under water count from it",
    "Behaviour.robots": "files of their own",
    "Robot:": "items that its ArduPilot knows, or its PX4 (mavlink.autopilot)",
    "Robot.id": "name of the file",
    "Robot.typeName": "kind of vehicle, speeds and devices, as far as the format holds them",
    "Robot.home": "the planned home; heights are above it",
    "Robot.travelMode": "DO_CHANGE_SPEED",
    "Robot.payload": "DO_CHANGE_SPEED, by the capability for it",
    "Robot.slots": "nothing waits for them; waits are refused",
    "Context.forbiddenAreas": "exclusion polygons",
    "Context.obstacles: of unlimited height": "exclusion polygons",
    "Context.obstacles: with a height": "routes keep clear of it; geofences know no heights",
    "Context.emergencyAreas": "rally points",
    "GeoCoordinate": "degrees, and metres above home",
    "Target.name": "is informative",
    "Start, Stop": "begin and end of the mission; a vehicle that does not land stays armed",
    "GoTo": "NAV_WAYPOINT",
    "GoTo.distance": "a waypoint short of the position",
    "GoTo.speed": "DO_CHANGE_SPEED",
    "GoTo.trajectory": "two waypoints",
    "TakeOff": "NAV_TAKEOFF",
    "Land": "NAV_LAND; ends the sortie",
    "HoldPosition": "NAV_LOITER_TIME, ArduPilot: rounded up to seconds; refused for a copter on the ground",
    "Recharge": "by the operator: each sortie is a mission of its own",
    "HeadTo.heading": "CONDITION_YAW, of a PX4 NAV_WAYPOINT; a gimbal: DO_SET_ROI_LOCATION",
    "Move.name": "in the manifest",
    "Move.task": "in the manifest",
    "Move.rule": "in the manifest",
    "GoTo.heading": "DO_SET_ROI_LOCATION",
    "Heading.deviceId": "absent: the front",
    "MoveTransition.fluid": "NAV_WAYPOINT without a hold",
    "DeviceAction": "an item, then NAV_LOITER_TIME for its duration, ArduPilot: rounded up to seconds",
    "DeviceAction: a camera that tells each image": "an item; the camera's reports are not awaited",
    "DeviceAction.parameters": "go before the device's properties",
    "Feedback": "is not sent, and nothing waits for it; ground stations show the item that a vehicle is at",
    "Feedback.payload": "is not sent",
    "Move.preActions": "items before those of the movement",
    "Move.postActions": "items after those of the movement",
}

OF_LISTS: Mapping[str, str] = {
    **OF_MISSIONS,
    "Behaviour.positionError": "the geofence and rally points beside the mission keep it",
    "Context.forbiddenAreas": "exclusion polygons in a list of their own (.fence.waypoints)",
    "Context.obstacles: of unlimited height": "exclusion polygons in a list of their own (.fence.waypoints)",
    "Context.emergencyAreas": "rally points in a list of their own (.rally.waypoints)",
}

WIRINGS = (
    SampleWiring("a servo (mavlink.servo)", {"mavlink.servo": "9", "mavlink.servo.act": "1900"}),
    SampleWiring("a MAVLink command (mavlink.command.ACTION)", {"mavlink.command.act": "183 9 1900"}),
    SampleWiring("a value that is measured (mavlink.value)", {"mavlink.value": "CO2"}),
    SampleWiring("a camera (mavlink.camera)", {"mavlink.camera": "0"}),
    SampleWiring(
        "a camera that the autopilot triggers", {"mavlink.camera": "0", "mavlink.camera.command": "digicam"}
    ),
    SampleWiring("a camera that tells each image", {"mavlink.camera": "0", "mavlink.camera.confirms": "yes"}),
    SampleWiring("a relay (mavlink.relay)", {"mavlink.relay": "0", "mavlink.relay.act": "on"}),
    SampleWiring("a gripper (mavlink.gripper)", {"mavlink.gripper": "1", "mavlink.gripper.act": "release"}),
    SampleWiring("a video (mavlink.video)", {"mavlink.video": "0", "mavlink.video.act": "start"}),
    SampleWiring(
        "a trigger by distance (mavlink.trigger)", {"mavlink.trigger": "5", "mavlink.trigger.act": "start"}
    ),
    SampleWiring("a winch (mavlink.winch)", {"mavlink.winch": "1", "mavlink.winch.act": "length 5"}),
    SampleWiring(
        "a gimbal (mavlink.gimbal.ACTION)", {"mavlink.gimbal": "1", "mavlink.gimbal.act": "-90 0"}, turns=True
    ),
)
"""How devices on MAVLink may be wired."""
