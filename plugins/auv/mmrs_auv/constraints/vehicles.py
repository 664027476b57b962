"""Constraints on thrusters, weight in water, and the depths that a team reaches."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mmrs_auv.kinds import ATMOSPHERE, GRAVITY, SEA_WATER
from mmrs_auv.names import AUV_MOVEMENT, FOLLOW_PIPELINE_TASK, IN_WATER_SIZE, THRUSTER, VEHICLE, YO_YO_TASK
from mmrs_core.analysis.constraints.ranges import positive
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.coordinates import Ground, heights_of_task
from mmrs_core.grounding.features import child, children, number, text, texts, value
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet


def too_deep(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks deeper than the limit of every robot; none where the limit of one is not known.

    Robots other than underwater vehicles reach no depth at all, so a team without any is silent:
    other constraints and the planner tell it what it lacks.
    """
    team = children(child(mission, "team"), "robots") if child(mission, "team") is not None else ()
    limits = [_limit(models.robots.get(text(member, "type")), models) for member in team]
    deepest = max((limit for limit in limits if limit is not None), default=inf)
    ground = sketch_of(models).ground
    for task in children(mission, "tasks"):
        depth = _deepest(task, ground)
        if depth > deepest + 1e-6:
            yield Finding(
                task, f"task '{label_of(task)}' is {depth:g} m deep, the team is rated for {deepest:.1f} m"
            )


def _deepest(task: Element, ground: Ground) -> float:
    """Return how deep a task leads, metres below the surface; -inf where that is not known."""
    lowest = number(task, "maxDepth") if is_kind(task, *YO_YO_TASK) else None
    if lowest is not None:
        return lowest
    heights = heights_of_task(task, ground)
    if is_kind(task, *FOLLOW_PIPELINE_TASK):
        pipeline, above = child(task, "pipeline"), number(task, "height") or 0.0
        points = children(pipeline, "points")
        heights = tuple(ground.positions[each][2] + above for each in points if each in ground.positions)
    return ground.frame.surface - min(heights, default=inf)


def _limit(robot_type: Element | None, models: ModelSet) -> float | None:
    """Return the rated depth of a type: None for other vehicles, inf where not known."""
    if robot_type is None:
        return inf
    movements = [
        each for each in children(robot_type, "movementCapabilities") if is_kind(each, *AUV_MOVEMENT)
    ]
    if not movements:
        return None
    rated = [
        min((number(each, "maxDepth") or inf for each in children(movement, "thrusters")), default=inf)
        for movement in movements
    ]
    return min(max(rated), _pressure_depth(robot_type, models))


def _pressure_depth(robot_type: Element, models: ModelSet) -> float:
    pressure = number(robot_type, "maxOperatingPressure")
    if pressure is None:
        return inf
    environment = child(models.context, "environment") if models.context is not None else None
    density = number(environment, "waterDensity") if environment is not None else None
    return (pressure - ATMOSPHERE) / ((density or SEA_WATER) * GRAVITY)


ROBOT_TYPE = ("urn:mmrs:robot:1.0", "Robot")
MISSION = ("urn:mmrs:mission:1.0", "Mission")


def _no_way_forward(movement: Element, models: ModelSet) -> Iterator[Finding]:
    if children(movement, "thrusters") and not _served(movement) & {"SURGE", "SWAY"}:
        yield Finding(movement, "freedomDegree: no thruster serves SURGE or SWAY, the vehicle goes nowhere")


def _degree_unserved(movement: Element, models: ModelSet) -> Iterator[Finding]:
    if not children(movement, "thrusters"):
        return
    served = _served(movement)
    if "YAW" not in served:
        yield Finding(movement, "freedomDegree: no thruster serves YAW, the vehicle cannot turn by thrust")
    if not served & {"HEAVE", "PITCH"}:
        yield Finding(
            movement, "freedomDegree: no thruster serves HEAVE or PITCH, the vehicle cannot dive by thrust"
        )


def _served(movement: Element) -> set[str]:
    return {
        degree for thruster in children(movement, "thrusters") for degree in texts(thruster, "freedomDegree")
    }


def _repeated_id(vehicle: Element, models: ModelSet) -> Iterator[Finding]:
    seen: set[str] = set()
    for thruster in children(vehicle, "thrusters"):
        name = label_of(thruster)
        if name and name in seen:
            yield Finding(thruster, f"thruster '{name}' has the identifier of another one")
        seen.add(name)


def _upside_down(thruster: Element, usual: str, peak: str, unit: str) -> Iterator[Finding]:
    low, high = number(thruster, usual), number(thruster, peak)
    if low is not None and high is not None and high < low:
        yield Finding(
            thruster,
            f"{peak} of thruster '{label_of(thruster)}' is {high:g} {unit}, below its {usual} {low:g}",
        )


def _thrust_upside_down(thruster: Element, models: ModelSet) -> Iterator[Finding]:
    return _upside_down(thruster, "operatingThrust", "maxThrust", "N")


def _power_upside_down(thruster: Element, models: ModelSet) -> Iterator[Finding]:
    return _upside_down(thruster, "operatingPower", "maxPower", "W")


def _repeated_degree(thruster: Element, models: ModelSet) -> Iterator[Finding]:
    degrees = texts(thruster, "freedomDegree")
    for degree in sorted({each for each in degrees if degrees.count(each) > 1}):
        yield Finding(thruster, f"freedomDegree of thruster '{label_of(thruster)}' lists {degree} twice")


def _plain_size(robot_type: Element, models: ModelSet) -> Iterator[Finding]:
    size = child(robot_type, "size")
    if _is_auv(robot_type) and size is not None and not is_kind(size, *IN_WATER_SIZE):
        yield Finding(size, f"size of '{label_of(robot_type)}' does not tell its weight in water")


def _heavier_in_water(size: Element, models: ModelSet) -> Iterator[Finding]:
    dry, wet = number(size, "weight"), number(size, "weightInWater")
    if dry is not None and wet is not None and wet > dry:
        yield Finding(size, f"weightInWater is {wet:g} kg, above the weight of {dry:g} kg")


def _too_weak_for_depth(robot_type: Element, models: ModelSet) -> Iterator[Finding]:
    size = child(robot_type, "size")
    wet = number(size, "weightInWater") if size is not None else None
    for movement in children(robot_type, "movementCapabilities"):
        thrust = sum(
            number(thruster, "operatingThrust") or 0.0
            for thruster in children(movement, "thrusters")
            if "HEAVE" in texts(thruster, "freedomDegree")
        )
        if wet is not None and 0.0 < thrust < abs(wet) * GRAVITY:
            yield Finding(
                movement,
                f"thrusters for HEAVE exert {thrust:g} N, "
                f"holding {wet:g} kg in water takes {abs(wet) * GRAVITY:.0f} N",
            )


def _no_pressure_meter(robot_type: Element, models: ModelSet) -> Iterator[Finding]:
    if _is_auv(robot_type) and value(robot_type, "pressuremeter") is not True:
        yield Finding(
            robot_type, f"pressuremeter of '{label_of(robot_type)}' is false: its depth is not measured"
        )


def _mixed_movements(robot_type: Element, models: ModelSet) -> Iterator[Finding]:
    plain = [
        each for each in children(robot_type, "movementCapabilities") if not is_kind(each, *AUV_MOVEMENT)
    ]
    if _is_auv(robot_type) and plain:
        yield Finding(
            plain[0], f"movement capability of '{label_of(robot_type)}' has no thrusters, others have"
        )


def _is_auv(robot_type: Element) -> bool:
    return any(is_kind(each, *AUV_MOVEMENT) for each in children(robot_type, "movementCapabilities"))


VEHICLE_CONSTRAINTS = (
    Constraint(
        "AUV001",
        "Some thruster moves the vehicle level",
        AUV_MOVEMENT,
        _no_way_forward,
        "add SURGE to the thrusters that push forward",
    ),
    Constraint(
        "AUV002",
        "Thrusters turn the vehicle and bring it up and down",
        AUV_MOVEMENT,
        _degree_unserved,
        "list every degree of freedom that a thruster serves, alone or with others",
        Severity.WARNING,
    ),
    Constraint(
        "AUV003",
        "The thrusters of a vehicle have different identifiers",
        VEHICLE,
        _repeated_id,
        "number the thrusters",
    ),
    Constraint(
        "AUV004",
        "Some robot of the team is rated for the depth of each task",
        MISSION,
        too_deep,
        "raise the task or add a robot that dives deeper",
    ),
    Constraint(
        "AUV005",
        "A thruster's peak thrust is at least its operating thrust",
        THRUSTER,
        _thrust_upside_down,
        "exchange the two figures",
    ),
    Constraint(
        "AUV006",
        "A thruster's peak power is at least its operating power",
        THRUSTER,
        _power_upside_down,
        "exchange the two figures",
    ),
    Constraint(
        "AUV007",
        "The size of an underwater vehicle is an InWaterSize",
        ROBOT_TYPE,
        _plain_size,
        'write xsi:type="auv:InWaterSize" and add weightInWater',
        Severity.WARNING,
    ),
    Constraint(
        "AUV008",
        "Nothing weighs more in water than in air",
        IN_WATER_SIZE,
        _heavier_in_water,
        "weightInWater is what is left of the weight when buoyancy is taken off; it may be negative",
    ),
    Constraint(
        "AUV009",
        "The figures of a thruster are above zero",
        THRUSTER,
        positive("maxDepth", "operatingThrust", "maxThrust", "operatingPower", "maxPower"),
        "correct the figure, or leave it out where it is optional",
    ),
    Constraint(
        "AUV010",
        "An underwater vehicle measures pressure",
        ROBOT_TYPE,
        _no_pressure_meter,
        'write pressuremeter="true" if it has one',
        Severity.WARNING,
    ),
    Constraint(
        "AUV011",
        "All movement capabilities of an underwater vehicle have thrusters",
        ROBOT_TYPE,
        _mixed_movements,
        'write xsi:type="auv:AUVMovement" for each of them',
    ),
    Constraint(
        "AUV012",
        "A thruster lists each degree of freedom once",
        THRUSTER,
        _repeated_degree,
        "delete the repeated entry",
        Severity.WARNING,
    ),
    Constraint(
        "AUV013",
        "The thrusters for HEAVE hold the vehicle's weight in water",
        ROBOT_TYPE,
        _too_weak_for_depth,
        "trim the vehicle to be nearly neutral, or correct the thrust",
        Severity.WARNING,
    ),
)
