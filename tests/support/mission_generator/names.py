"""Namespaces of the languages that random missions are written in."""

MISSION, CONTEXT = "urn:mmrs:mission:1.0", "urn:mmrs:context:1.0"
ROBOT, DRONE, SURVEY = "urn:mmrs:robot:1.0", "urn:mmrs:multicopter:1.0", "urn:mmrs:survey:1.0"
