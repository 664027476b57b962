"""How elements of behaviours are expressed by the decision centre, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_auv.targets.capabilities import OF_VEHICLES

CAPABILITIES: Mapping[str, str] = {
    **OF_VEHICLES,
    "Behaviour.crs": "places are metres from the mission's origin",
    "Behaviour.origin": "places are metres from it",
    "Behaviour.altitudeReference": "depths count from the surface",
    "Behaviour.geoidSeparation": "depths count from the surface",
    "Behaviour.minimumSeparation": "is for the planner and the checks",
    "Behaviour.acceptedUnknowns": "is for the checks",
    "Behaviour.positionError": "is for the planner and the checks",
    "Behaviour.name": "in comments",
    "Behaviour.reserve": "a battery with no more left is low",
    "Behaviour.robots": "a project each",
    "Robot.id": "name of the folder, and in the log",
    "Robot.home": "places count from the mission's origin; it begins where the vehicle is",
    "Robot.payload": "speed, by the capability for it",
    "Robot.slots": "kept by itself, or by the gateway of the bus between robots",
    "ObjectTarget": "sought where cameras tell of it, else taken to be where it is expected",
    "Context.forbiddenAreas": "routes keep clear of them; nothing else does",
    "Context.obstacles": "routes keep clear of them; nothing else does",
    "Context.emergencyAreas": "no way leads there: policies that ask for one are refused",
    "Target.name": "is for people",
    "Start, Stop": "beginning and end of the plan",
    "GoTo.distance": "a place short of the target, from where it is",
    "HoldPosition": "the last goal stays in force",
    "Recharge": "at the surface until the battery is full, and at least so long",
    "HeadTo": "a goal TURN",
    "Heading.target": "where it is expected, or where cameras see it",
    "Move.name": "in the log, and printed",
    "Move.preActions": "done before the movement",
    "Move.postActions": "done after the movement",
    "Move.task": "a composed state",
    "Move.rule": "in the manifest",
    "MoveTransition.waitFor": "slots are asked for until all are active",
    "MoveTransition.policies": "before those of the robot",
    "MoveTransition.to": "moves in any order",
    "MoveTransition.fluid": "it stops at every place",
    "Choice": "conditions.adb, which is yours",
    "Choice by a standard condition": "battery-below, detected, found; others in conditions.adb",
    "Feedback": "printed",
    "UnicastNotify": "by the gateway, acknowledged",
    "MulticastNotify": "by the gateway, acknowledged",
    "BroadcastNotify": "by the gateway, acknowledged",
    "Notify.active": "the same with false",
    "LINK_LOST": "the bus is silent, or gone; CONTINUE: for 10 s, since it is about radio",
    "PEER_LOST": "the robots that could end a wait are gone, or the gateway, which is never borne",
}
