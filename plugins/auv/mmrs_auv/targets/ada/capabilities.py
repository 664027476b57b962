"""How elements of behaviours are expressed by the decision centre, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

CAPABILITIES: Mapping[str, str] = {
    "Behaviour.surfaceHeight": "depths count from it",
    "Behaviour.reserve": "it comes up when the battery has no more",
    "Behaviour.robots": "a project each",
    "Robot: a sub": "goals on its CAN bus",
    "Robot.id": "name of the folder, and in the log",
    "Robot.travelMode": "speed of its goals",
    "Robot.payload": "speed, by the capability for it",
    "Robot.slots": "kept by itself, or by the gateway of the bus between robots",
    "GeoCoordinate": "metres north, east and below the surface",
    "RelativeCoordinate": "metres north, east and below the surface",
    "ObjectTarget": "sought where cameras tell of it, else taken to be where it is expected",
    "GoTo": "a goal GO_TO, reached when Movement says so",
    "GoTo.distance": "a place short of the target, from where it is",
    "HoldPosition": "the last goal stays in force",
    "HeadTo": "a goal TURN",
    "Move.task": "a composed state",
    "Move.rule": "in the manifest",
    "MoveTransition.waitFor": "slots are asked for until all are active",
    "MoveTransition.policies": "it comes up when a wait takes too long, or nobody is left to end it",
    "Choice": "conditions.adb, which is yours",
    "Feedback": "printed",
    "UnicastNotify": "by the gateway, acknowledged",
    "MulticastNotify": "by the gateway, acknowledged",
    "BroadcastNotify": "by the gateway, acknowledged",
    "Notify.active": "the same with false",
}
