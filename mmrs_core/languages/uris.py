"""The core's languages, by nsURI."""

MISSION, CONTEXT = "urn:mmrs:mission:1.0", "urn:mmrs:context:1.0"
ROBOT, BEHAVIOUR = "urn:mmrs:robot:1.0", "urn:mmrs:behaviour:1.0"
