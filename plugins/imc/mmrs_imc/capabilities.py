"""How elements of behaviours are expressed in plans of IMC, for the table of capabilities."""

from __future__ import annotations

from collections.abc import Mapping

CAPABILITIES: Mapping[str, str] = {
    "Behaviour.crs": "places are converted to WGS 84",
    "Behaviour.origin": "latitude and longitude in radians",
    "Behaviour.name": "in the description of the plan",
    "Behaviour.surfaceHeight": "depths count from it",
    "Behaviour.robots": "a plan each",
    "Robot: a sub": "depths below the surface",
    "Robot: a rover": "a vehicle at the surface",
    "Robot.id": "identifier of the plan, and name of the file",
    "Robot.home": "where it holds before it goes anywhere",
    "Robot.travelMode": "speed in metres per second",
    "Robot.payload": "speed, by the capability for it",
    "Context": "routes keep clear of it; plans know no areas",
    "GeoCoordinate": "latitude, longitude and depth",
    "GoTo": "Goto",
    "GoTo.distance": "a Goto short of the position",
    "GoTo.speed": "speed in metres per second",
    "HoldPosition": "StationKeeping; at the surface PopUp; rounded up to seconds",
    "Move.name": "identifier of the manoeuvre",
    "Move.task": "in the manifest",
    "Move.rule": "in the manifest",
    "MoveTransition.fluid": "manoeuvres follow each other in any case",
    "MoveTransition.to": "PlanTransition",
}
