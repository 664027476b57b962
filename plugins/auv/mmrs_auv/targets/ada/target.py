"""The target ada: a decision centre for each underwater vehicle, on its CAN bus.

Each robot has a folder with a GNAT project; what all share lies beside them, in ``common``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_auv.names import VEHICLES
from mmrs_auv.targets.ada import literals, tables
from mmrs_auv.targets.ada.bus import catalogue, depth_step_of
from mmrs_auv.targets.ada.missions import Mission
from mmrs_auv.targets.ada.policies import declared
from mmrs_auv.targets.ada.refusals import is_diver, refusals
from mmrs_auv.targets.capabilities import OF_VEHICLES
from mmrs_auv.targets.places import templates_of
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import context_of

CAPABILITIES: Mapping[str, str] = {
    **OF_VEHICLES,
    "Behaviour.crs": "places are metres from the mission's origin",
    "Behaviour.origin": "places are metres from it",
    "Behaviour.altitudeReference": "depths count from the surface",
    "Behaviour.geoidSeparation": "depths count from the surface",
    "Behaviour.minimumSeparation": "is for the planner and the checks",
    "Behaviour.acceptedUnknowns": "is for the checks",
    "Behaviour.idleRobots": "are for the checks; they are not run",
    "Behaviour.positionError": "is for the planner and the checks",
    "Behaviour.name": "in comments",
    "Behaviour.reserve": "a battery with no more left is low",
    "Behaviour.robots": "a project each",
    "Robot.id": "name of the folder, and in the log",
    "Robot.home": "places count from the mission's origin; it begins where the vehicle is",
    "Robot.payload": "speed, by the capability for it",
    "Robot.slots": "kept by the program, or by the gateway of the bus between robots",
    "ObjectTarget": "located where cameras report it, otherwise taken to be at its expected position",
    "Context.forbiddenAreas": "routes keep clear of them; nothing else does",
    "Context.obstacles": "routes keep clear of them; nothing else does",
    "Context.emergencyAreas": "no path leads there: policies that ask for one are refused",
    "Target.name": "is informative",
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
    "PEER_LOST": "the robots that could end a wait are gone, or the gateway, which is never tolerated",
}

TEMPLATES = templates_of("ada")
NO_VEHICLE = "no robot is an underwater vehicle"
OWN = ("decision_centre.gpr", "mission.ads")


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield the sources in ``common`` and those of each underwater vehicle.

    Raises:
        UnsupportedError: no robot is one.
    """
    robots = [robot for robot in input.program.robots if is_diver(robot, input)]
    if not robots:
        raise UnsupportedError(NO_VEHICLE, (NO_VEHICLE,))
    for source in sorted(TEMPLATES.glob("*.ad[bs]")):
        if source.name not in OWN:
            yield FileSpec(f"common/{source.name}", source.name, source=source)
    yield FileSpec("common/catalogue.ads", "catalogue.ads.jinja", catalogue())
    yield FileSpec("common/tables.ads", "tables.ads.jinja", tables.view())
    stems = file_stems([robot.id for robot in robots])
    yield FileSpec("README.md", "README.md.jinja", {"robots": list(stems.items()), "tables": tables.view()})
    for robot in robots:
        context = context_of(robot, input, VEHICLES)
        mission = Mission(context, input.program, declared(robot, input), depth_step_of(robot, input))
        folder = f"robot-{stems[robot.id]}"
        for name in OWN:
            yield FileSpec(f"{folder}/{name}", name, source=TEMPLATES / name)
        yield FileSpec(f"{folder}/mission.adb", "mission.adb.jinja", {"robot": mission.view()})
        conditions = mission.conditions()
        yield FileSpec(
            f"{folder}/conditions.adb",
            "conditions.adb.jinja",
            conditions,
            once=True,
            asks=tuple(f"say when '{condition}' holds" for condition in mission.undecided()),
        )


ADA = Target(
    name="ada",
    description="decision centres in Ada for underwater vehicles, on their CAN buses: a GNAT project each",
    templates=TEMPLATES,
    files=files,
    refusals=refusals,
    filters={"ada": literals.value, "ada_string": literals.string},
    capabilities=CAPABILITIES,
    tried_with="sub",
)
