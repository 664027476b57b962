"""How elements of behaviours are expressed by controllers on CAN buses, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.mavlink.capabilities import OF_THE_RUNTIME

CAPABILITIES: Mapping[str, str] = {
    **OF_THE_RUNTIME,
    "Behaviour.surfaceHeight": "depths count from it",
    "Robot: a sub": "goals on its CAN bus",
    "Robot.home": "the vehicle's zero",
    "Robot.travelMode": "speed of its goals",
    "Robot.payload": "the vehicle's mass; speed, by the capability for it",
    "GeoCoordinate": "metres north, east and below the surface",
    "RelativeCoordinate": "metres north, east and below the surface",
    "ObjectTarget": "found by what cameras tell (--detections), or by a function of yours in objects.py",
    "GoTo": "a goal GO_TO, reached when Movement says so",
    "HoldPosition": "the last goal stays in force, timed by the controller",
    "HeadTo.heading": "a goal TURN",
    "GoTo.heading": "heading of the goal",
    "Heading.angle": "added to the heading",
    "Heading.deviceId": "its mount.yaw counts; absent: the front",
    "Heading.target": "where it is expected, or found by a function of yours in objects.py",
    "MoveTransition.waitFor": "waits for slots, over the bus between robots",
    "DeviceAction": "DeviceCommand, repeated until its status comes",
    "Feedback": "printed, and in the black box",
    "LINK_LOST": "the bus is silent; a vehicle whose controller is silent holds, then comes up",
    "PEER_LOST": "the robots that could end a wait are gone",
    "BATTERY_LOW": "less than the reserve is left",
    "WAIT_TOO_LONG": "a wait for other robots, or for an answer",
    "DEVICE_SILENT": "a device does not say that it is done",
    "POSITION_LOST": "depth, heading or place are not known well enough",
    "OBSTACLE": "sonar sees something nearer than --clearance",
    "FENCE_BREACHED": "there is no fence, so that it never happens",
    "VEHICLE_RESTARTED": "no vehicle on a CAN bus tells it, so that it never happens",
    "LOG_FAILED": "a step that cannot be written",
    "GROUND_LOST": "no ground station is heard under water, so that it never happens",
}
