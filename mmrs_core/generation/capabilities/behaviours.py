"""Probes of a behaviour as a whole, of its robots and their policies, and of the context."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.program import MoveTarget, Program, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.capabilities.probes import ALPHA, BETA, Probe, Samples, changed, with_move
from mmrs_core.scene import Area, AreaUse, Frame, Policy, Ring
from mmrs_runtime.policies import EVENTS, RESPONSES

LOCAL = Frame("EPSG:4326", None, None)
SQUARE: Ring = ((100.0, 0.0), (140.0, 0.0), (140.0, 40.0), (100.0, 40.0))
MEADOW: Ring = ((-40.0, 0.0), (-20.0, 0.0), (-20.0, 20.0), (-40.0, 20.0))


def of_behaviours(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each feature of Behaviour, and of its frame."""
    sample, base = samples.base, samples.base.plain
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
    second = sample.robot(BETA, sample.journey)
    for element, program in {
        "Behaviour.name": replace(base.program, name="another"),
        "Behaviour.minimumSeparation": replace(base.program, minimum_separation=5.0),
        "Behaviour.reserve": replace(base.program, reserve=0.4),
        "Behaviour.acceptedUnknowns": replace(base.program, accepted_unknowns=("energy",)),
        "Behaviour.idleRobots": replace(base.program, idle=(second,)),
    }.items():
        yield Probe("behaviour", element, replace(base, program=program), base)
    careful = replace(base.program, position_error=3.0)
    yield Probe("behaviour", "Behaviour.positionError", replace(fenced, program=careful), fenced)
    swum = (samples.swimming or sample).plain
    yield Probe("behaviour", "Behaviour.surfaceHeight", _with(swum, frame=replace(frame, surface=1.0)), swum)
    both = replace(base.program, robots=(*base.program.robots, second))
    yield Probe("behaviour", "Behaviour.robots", replace(base, program=both), base)


def of_robots(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each robot kind, and for each feature of Robot."""
    sample, base = samples.base, samples.base.plain
    for each in samples.every:
        yield Probe("robot", f"Robot: {each.name}", each.plain, sample.given())
    yield Probe("robot", "Robot.id", changed(base, lambda r: replace(r, id="gamma")), base)
    swum, ground = (samples.swimming or sample).plain, samples.ground.plain.types
    yield Probe("robot", "Robot.typeName", replace(swum, types=ground), swum)
    yield Probe(
        "robot", "Robot.typeName: a type that is not given", replace(_unhurried(base), types={}), base
    )
    yield Probe("robot", "Robot.home", changed(base, lambda r: replace(r, home=(5.0, 5.0, 1.0))), base)
    yield Probe("robot", "Robot.home absent", changed(base, lambda r: replace(r, home=None)), base)
    slow = _unhurried(base)
    for mode in ("SAFE", "AGGRESSIVE"):
        given = changed(slow, lambda r, mode=mode: replace(r, travel_mode=mode))  # type: ignore[misc]
        yield Probe("robot", f"Robot.travelMode {mode}", given, slow)
    yield Probe("robot", "Robot.payload", changed(slow, lambda r: replace(r, payload=0.8)), slow)
    yield Probe("robot", "Robot.slots", changed(base, lambda r: replace(r, slots=("go",))), base)


def of_places(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each sort of area, and of target."""
    base, here, there = samples.base.plain, samples.base.here, samples.base.there
    for element, area in {
        "Context.forbiddenAreas": Area("school", AreaUse.FORBIDDEN, SQUARE),
        "Context.obstacles: of unlimited height": Area("tower", AreaUse.OBSTACLE, SQUARE),
        "Context.obstacles: with a height": Area("shed", AreaUse.OBSTACLE, SQUARE, 0.0, 9.0),
        "Context.emergencyAreas": Area("meadow", AreaUse.EMERGENCY, MEADOW),
    }.items():
        yield Probe("place", element, replace(base, areas=(area,)), base)
    yield Probe("place", "GeoCoordinate", with_move(base, "a", target=MoveTarget(there)), base)
    local = _with(base, frame=LOCAL)
    moved = with_move(local, "a", target=MoveTarget(there))
    yield Probe("place", "RelativeCoordinate of an origin without degrees", moved, local)
    for element, target in {
        "Target.name": MoveTarget(here, name="gate"),
        "ObjectTarget.description": MoveTarget(None, "a buoy", None),
        "ObjectTarget.expectedAt": MoveTarget(there, "a buoy", None),
        "ObjectTarget.tolerance": MoveTarget(there, "a buoy", 2.0),
    }.items():
        yield Probe("place", element, with_move(base, "a", target=target), base)


def of_policies(samples: Samples) -> Iterator[Probe]:
    """Yield a probe for each event, response and robot kind, and for those of single waits."""
    for sample in samples.carried:
        base = replace(sample.plain, areas=(Area("meadow", AreaUse.EMERGENCY, MEADOW),))
        for event in EVENTS:
            for response in RESPONSES:
                policy = Policy(event, response)
                other = changed(base, lambda r, policy=policy: replace(r, policies=(policy,)))  # type: ignore[misc]
                yield Probe(f"policy ({sample.name})", f"{event}: {response}", other, base)
    base_sample = samples.base
    waiting = Transition(0, base_sample.after("a"), waits=("go",))
    patient = Policy("WAIT_TOO_LONG", "LAND", 9.0)
    inputs = [
        changed(
            base_sample.given(base_sample.robot(ALPHA, base_sample.journey, a=each)),
            lambda r: replace(r, slots=("go",)),
        )
        for each in (replace(waiting, policies=(patient,)), waiting)
    ]
    yield Probe("transition", "MoveTransition.policies", *inputs)


def _with(base: TargetInput, frame: Frame) -> TargetInput:
    program: Program = replace(base.program, frame=frame)
    return replace(base, program=program)


def _unhurried(base: TargetInput) -> TargetInput:
    """Return an input whose move has no speed of its own."""
    return with_move(base, "a", speed=None)
