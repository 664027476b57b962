"""The names of the metaclasses that this plug-in brings."""

from __future__ import annotations

MULTICOPTER = "urn:mmrs:multicopter:1.0"
DRONE = (MULTICOPTER, "Drone")
DRONE_SIZE = (MULTICOPTER, "DroneSize")
TAKE_OFF = (MULTICOPTER, "TakeOff")
LAND = (MULTICOPTER, "Land")
GO_TO = (MULTICOPTER, "GoTo")
