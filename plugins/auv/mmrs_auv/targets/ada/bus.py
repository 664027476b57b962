"""Messages that the decision centre sends and receives, as its template sees them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from auv_vessel.refusals import MOST_DEPTH
from auv_vessel.wire.catalogue import (
    BEATS,
    COMMON,
    EMERGENCIES,
    MODES,
    PROGRESS,
    REASONS,
    Message,
    depth_step,
    layout_of,
)
from mmrs_auv.kinds import SEA_WATER, largest_depth
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import InfeasibleError

SPOKEN = ("GoalPlace", "GoalPose", "DeviceCommand", "DecisionEmergency", "DecisionBeat")
HEARD = (
    *(name for name in EMERGENCIES if name not in SPOKEN),
    *("Position", "Depth", "Pose", "Health", "Progress", "DeviceStatus"),
)

_KNOWN = {message.name: message for message in (*COMMON, *BEATS)}


def catalogue() -> Mapping[str, object]:
    """Return what the template of the catalogue sees."""
    messages = [_message(_KNOWN[name]) for name in (*SPOKEN, *HEARD)]
    return {"messages": messages, "emergencies": list(EMERGENCIES), "words": list(_words())}


def can_be_said(message: str, field: str, value: float) -> bool:
    """Return whether a field of a message holds a value."""
    part = layout_of(_KNOWN[message]).slots[field].field
    return part.low <= value <= part.high


def depth_step_of(robot: RobotProgram, input: TargetInput) -> float:
    """Return metres of depth in a step on a robot's bus; 0: its type does not define its depth."""
    type, density = input.types.get(robot.type_name), input.environment.get("waterDensity", SEA_WATER)
    try:
        deepest = largest_depth(type, robot.payload, density) if type is not None else None
    except InfeasibleError:
        return 0.0
    return 0.0 if deepest is None else depth_step(min(deepest, MOST_DEPTH))


def _message(message: Message) -> Mapping[str, object]:
    layout = layout_of(message)
    fields = [
        {
            "name": slot.field.name,
            "start": slot.start,
            "bits": slot.field.bits,
            "signed": slot.field.signed,
            "scale": slot.field.scale,
            "low": slot.low,
            "high": slot.high,
            "least": float(slot.low) if slot.field.names else slot.field.low,
            "most": float(slot.high) if slot.field.names else slot.field.high,
        }
        for slot in layout.slots.values()
    ]
    return {
        "name": message.name,
        "id": message.id,
        "length": layout.length,
        "guarded": message.guarded,
        "fields": fields,
    }


def _words() -> Iterator[tuple[str, int]]:
    groups = {"MODE": MODES, "PROGRESS": PROGRESS, "REASON": REASONS, "STATE": ("STARTS", "RUNS")}
    for group, names in groups.items():
        yield from ((f"{group}_{name}", number) for number, name in enumerate(names))
