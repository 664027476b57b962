"""Sample robot types and device wirings, with which targets are tried."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mmrs_core.scene import Battery, Capability, Device, DeviceAction, Metaclasses, Part, RobotType, Value

DEVICE, ACTION = "device", "act"
"""The device of every sample robot type, and what it can do, in 2 seconds."""


@dataclass(frozen=True, slots=True)
class SampleWiring:
    """How a device may be wired, with which the device actions of a target are tried.

    Attributes:
        description: a few words, such as ``a servo (kites.servo)``.
        properties: of the device ``device``, whose action is ``act``.
        turns: whether the device turns on its own, so that headings are tried with it too.
    """

    description: str
    properties: Mapping[str, str]
    turns: bool = False


def sample_type(
    metaclasses: Metaclasses, *, movement: Part | None = None, attributes: Mapping[str, Value] | None = None
) -> RobotType:
    """Return a robot type with a device that is not wired, and capabilities for no payload and for 1 kg.

    Args:
        metaclasses: of the type, most specific first.
        movement: what plug-ins add to its movement capabilities.
        attributes: what plug-ins add to the type, by feature name.
    """
    part = movement or Part((), {})
    return RobotType(
        name="Kind",
        metaclasses=metaclasses,
        capability_metaclasses=part.metaclasses or (("urn:mmrs:robot:1.0", "MovementCapability"),),
        half_diagonal=0.5,
        max_payload=1.0,
        capabilities=(
            Capability(0.0, 1200.0, (0.5, 8.0), 2.5, 2.5, 2.0, 90.0, part),
            Capability(1.0, 900.0, (0.5, 4.0), 2.5, 2.5, 2.0, 90.0, part),
        ),
        batteries=(Battery(200_000.0, 3600.0),),
        devices={DEVICE: Device(DEVICE, {ACTION: DeviceAction(ACTION, 2.0)}, {})},
        part=Part((metaclasses[0],), attributes or {}),
    )
