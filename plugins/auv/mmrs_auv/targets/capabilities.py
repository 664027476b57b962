"""How elements of behaviours are expressed by what drives a vehicle on its CAN bus, whatever the language."""

from __future__ import annotations

from collections.abc import Mapping

OF_VEHICLES: Mapping[str, str] = {
    "Behaviour.surfaceHeight": "depths count from it",
    "Robot: auv": "goals on its CAN bus",
    "Robot.travelMode": "speed of its goals",
    "GeoCoordinate": "metres north, east and below the surface",
    "RelativeCoordinate": "metres north, east and below the surface",
    "GoTo": "a goal GO_TO, reached when Movement says so",
    "Heading.angle": "added to the heading",
    "Heading.deviceId": "its mount.yaw counts; absent: the front",
    "GoTo.heading": "heading of the goal",
    "DeviceAction": "DeviceCommand, repeated until its status comes",
    "BATTERY_LOW": "less than the reserve is left",
    "WAIT_TOO_LONG": "a wait for other robots, or for an answer",
    "DEVICE_SILENT": "a device does not say that it is done",
    "POSITION_LOST": "depth, heading or place are not known well enough",
    "OBSTACLE": "sonar sees something nearer than --clearance",
    "FENCE_BREACHED": "there is no fence, so that it never happens",
    "VEHICLE_RESTARTED": "no vehicle on a CAN bus tells it, so that it never happens",
    "LOG_FAILED": "a step that cannot be written",
    "GROUND_LOST": "no ground station is received under water, so it never happens",
    "MOTOR_FAILED": "no thruster on a CAN bus tells it, so that it never happens",
}
