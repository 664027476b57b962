"""Probes of a behaviour as a whole, of its robots, and of the context."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import MoveTarget, Program
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.capabilities.probes import (
    BETA,
    FLIGHT,
    HERE,
    KINDS,
    THERE,
    Probe,
    changed,
    given,
    kind_of,
    plain,
    robot,
    with_move,
)
from mmrs_core.scene import Area, AreaUse, Frame, Ring

LOCAL = Frame("EPSG:4326", None, None)
SQUARE: Ring = ((100.0, 0.0), (140.0, 0.0), (140.0, 40.0), (100.0, 40.0))
MEADOW: Ring = ((-40.0, 0.0), (-20.0, 0.0), (-20.0, 20.0), (-40.0, 20.0))


def of_behaviours() -> Iterator[Probe]:
    """Yield a probe for each feature of Behaviour, and of its frame."""
    base = plain()
    frame = base.program.frame
    frames = {
        "Behaviour.crs": replace(frame, crs="EPSG:4265"),
        "Behaviour.origin": replace(frame, latitude=43.0),
        "Behaviour.origin absent: a local behaviour": LOCAL,
        "Behaviour.altitudeReference MSL": replace(frame, altitude=500.0),
        "Behaviour.altitudeReference ELLIPSOID": replace(frame, altitude_reference="ELLIPSOID"),
        "Behaviour.geoidSeparation": replace(frame, altitude_reference="ELLIPSOID", geoid_separation=47.5),
        "Behaviour.altitudeReference ORIGIN": replace(frame, altitude=None, altitude_reference="ORIGIN"),
    }
    for element, other in frames.items():
        yield Probe("behaviour", element, _with(base, frame=other), base)
    fenced = replace(base, areas=(Area("school", AreaUse.FORBIDDEN, SQUARE),))
    for element, program in {
        "Behaviour.name": replace(base.program, name="another"),
        "Behaviour.minimumSeparation": replace(base.program, minimum_separation=5.0),
        "Behaviour.reserve": replace(base.program, reserve=0.4),
        "Behaviour.acceptedUnknowns": replace(base.program, accepted_unknowns=("energy",)),
        "Behaviour.idleRobots": replace(base.program, idle=(robot(BETA, FLIGHT),)),
    }.items():
        yield Probe("behaviour", element, replace(base, program=program), base)
    careful = replace(base.program, position_error=3.0)
    yield Probe("behaviour", "Behaviour.positionError", replace(fenced, program=careful), fenced)
    sub = plain("sub")
    yield Probe("behaviour", "Behaviour.surfaceHeight", _with(sub, frame=replace(frame, surface=1.0)), sub)
    second = replace(base.program, robots=(*base.program.robots, robot(BETA, FLIGHT)))
    yield Probe("behaviour", "Behaviour.robots", replace(base, program=second), base)


def of_robots() -> Iterator[Probe]:
    """Yield a probe for each kind of vehicle, and for each feature of Robot."""
    base = plain()
    for vehicle in KINDS:
        yield Probe("robot", f"Robot: a {vehicle}", plain(vehicle), given())
    yield Probe("robot", "Robot.id", changed(base, lambda r: replace(r, id="gamma")), base)
    sub = plain("sub")
    yield Probe("robot", "Robot.typeName", replace(sub, types={"Kind": kind_of("rover")}), sub)
    yield Probe(
        "robot", "Robot.typeName: a type that is not given", replace(_unhurried(base), types={}), base
    )
    yield Probe("robot", "Robot.home", changed(base, lambda r: replace(r, home=(5.0, 5.0, 1.0))), base)
    yield Probe("robot", "Robot.home absent", changed(base, lambda r: replace(r, home=None)), base)
    slow = _unhurried(base)
    for mode in ("SAFE", "AGGRESSIVE"):
        other = changed(slow, lambda r, mode=mode: replace(r, travel_mode=mode))  # type: ignore[misc]
        yield Probe("robot", f"Robot.travelMode {mode}", other, slow)
    yield Probe("robot", "Robot.payload", changed(slow, lambda r: replace(r, payload=0.8)), slow)
    yield Probe("robot", "Robot.slots", changed(base, lambda r: replace(r, slots=("go",))), base)


def of_places() -> Iterator[Probe]:
    """Yield a probe for each sort of area, and of target."""
    base = plain()
    for element, area in {
        "Context.forbiddenAreas": Area("school", AreaUse.FORBIDDEN, SQUARE),
        "Context.obstacles: of unlimited height": Area("tower", AreaUse.OBSTACLE, SQUARE),
        "Context.obstacles: with a height": Area("shed", AreaUse.OBSTACLE, SQUARE, 0.0, 9.0),
        "Context.emergencyAreas": Area("meadow", AreaUse.EMERGENCY, MEADOW),
    }.items():
        yield Probe("place", element, replace(base, areas=(area,)), base)
    yield Probe("place", "GeoCoordinate", with_move(base, "a", target=MoveTarget(THERE)), base)
    local = _with(base, frame=LOCAL)
    moved = with_move(local, "a", target=MoveTarget(THERE))
    yield Probe("place", "RelativeCoordinate of an origin without degrees", moved, local)
    for element, target in {
        "Target.name": MoveTarget(HERE, name="gate"),
        "ObjectTarget.description": MoveTarget(None, "a buoy", None),
        "ObjectTarget.expectedAt": MoveTarget(THERE, "a buoy", None),
        "ObjectTarget.tolerance": MoveTarget(THERE, "a buoy", 2.0),
    }.items():
        yield Probe("place", element, with_move(base, "a", target=target), base)


def _with(base: TargetInput, frame: Frame) -> TargetInput:
    program: Program = replace(base.program, frame=frame)
    return replace(base, program=program)


def _unhurried(base: TargetInput) -> TargetInput:
    """Return an input whose move has no speed of its own."""
    return with_move(base, "a", speed=None)
