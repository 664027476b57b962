"""How elements of behaviours are expressed in behaviour files, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

CAPABILITIES: Mapping[str, str] = {
    "Behaviour.crs": "in a comment: the vehicle's mission has an origin of its own",
    "Behaviour.origin": "in a comment: the vehicle's mission must have the same",
    "Behaviour.origin absent: a local behaviour": "metres east and north of the origin",
    "Behaviour.surfaceHeight": "depths count from it",
    "Behaviour.robots": "a file each",
    "Robot: a sub": "BHV_ConstantDepth beside all that moves it",
    "Robot: a rover": "a vehicle at the surface",
    "Robot.id": "name of the file and of its community",
    "Robot.home": "where it begins",
    "Robot.travelMode": "speed and capture radius",
    "Robot.payload": "speed, by the capability for it",
    "Robot.slots": "variables, initially false",
    "Context": "routes keep clear of it; the helm knows no areas",
    "GeoCoordinate": "metres east and north of the origin, and depth",
    "RelativeCoordinate": "metres east and north of the origin, and depth",
    "Start, Stop": "MMRS_STEP at first, and MMRS_DONE at last",
    "GoTo": "BHV_Waypoint; sloping paths in pieces, within a metre of the straight line",
    "GoTo.distance": "a waypoint short of the position",
    "GoTo.speed": "speed",
    "HoldPosition": "BHV_StationKeep and BHV_Timer",
    "Move.name": "names of its behaviours",
    "Move.task": "in comments",
    "Move.rule": "in the manifest",
    "MoveTransition.waitFor": "conditions on the slots' variables",
    "MoveTransition.fluid": "a helm passes waypoints as its capture radius says",
    "Choice": "a variable of yours is true or false",
    "Feedback": "an endflag: MMRS_FEEDBACK",
    "UnicastNotify": "an endflag: NODE_MESSAGE_LOCAL (uFldMessageHandler), sent once, unacknowledged",
    "MulticastNotify": "endflags: NODE_MESSAGE_LOCAL (uFldMessageHandler), sent once, unacknowledged",
    "BroadcastNotify": "endflags: NODE_MESSAGE_LOCAL (uFldMessageHandler), sent once, unacknowledged",
    "Notify.active": "the same with false",
}
