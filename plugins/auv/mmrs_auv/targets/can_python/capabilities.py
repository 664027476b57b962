"""How elements of behaviours are expressed by controllers on CAN buses, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_auv.targets.capabilities import OF_VEHICLES

CAPABILITIES: Mapping[str, str] = {
    **OF_VEHICLES,
    "Robot.home": "the vehicle's zero",
    "Robot.payload": "the vehicle's mass; speed, by the capability for it",
    "ObjectTarget": "found by what cameras tell (--detections), or by a function of yours in objects.py",
    "HoldPosition": "the last goal stays in force, timed by the controller",
    "HeadTo.heading": "a goal TURN",
    "Heading.target": "where it is expected, or found by a function of yours in objects.py",
    "MoveTransition.waitFor": "waits for slots, over the bus between robots",
    "Feedback": "printed, and in the black box",
    "LINK_LOST": "the bus is silent; a vehicle whose controller is silent holds, then comes up",
    "PEER_LOST": "the robots that could end a wait are gone",
}
