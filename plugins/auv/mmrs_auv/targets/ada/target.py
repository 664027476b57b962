"""The target ada: a decision centre for each underwater vehicle, on its CAN bus.

Each robot has a folder with a GNAT project; what all share lies beside them, in ``common``.
"""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.names import VEHICLES
from mmrs_auv.targets.ada import literals, tables
from mmrs_auv.targets.ada.bus import catalogue, depth_step_of
from mmrs_auv.targets.ada.capabilities import CAPABILITIES
from mmrs_auv.targets.ada.missions import Mission
from mmrs_auv.targets.ada.policies import declared
from mmrs_auv.targets.ada.refusals import is_diver, refusals
from mmrs_auv.targets.places import templates_of
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import context_of

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
    tried_with="water",
)
