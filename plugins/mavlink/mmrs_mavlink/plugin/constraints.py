"""Constraints on devices that are wired to an autopilot."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import children, text
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet

OUTPUTS = ("mavlink.servo", "mavlink.relay", "mavlink.gripper", "mavlink.winch", "mavlink.value")
"""Properties of devices that name an output of the autopilot, or a value that it publishes."""


def _shared_output(robot: Element, models: ModelSet) -> Iterator[Finding]:
    holders: dict[tuple[str, str], Element] = {}
    for device in children(robot, "devices"):
        for each in children(device, "properties"):
            key, value = text(each, "name"), text(each, "value").strip()
            first = holders.setdefault((key, value), device)
            if key in OUTPUTS and first is not device:
                words = f"its {key} is {value}, which {_called(first)} has already"
                yield Finding(device, f"{_called(device)}: {words}")


def _called(device: Element) -> str:
    return f"device '{text(device, 'id')}'"


CONSTRAINTS = (
    Constraint(
        "RL030",
        "Each output of an autopilot, and each value that it publishes, belongs to one device",
        ("urn:mmrs:robot:1.0", "Robot"),
        _shared_output,
        "give each device its own, or describe what they are together as one device",
        Severity.WARNING,
    ),
)
