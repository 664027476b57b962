"""Device actions as parameters of entities: how payloads of LSTS vehicles are switched in plans.

A device says the label of its entity by the property ``imc.entity``, and by ``imc.set.ACTION`` what an
action sets: parameters and values as in ``Active=true;Range=50``.
"""

from __future__ import annotations

from mmrs_core.behaviour.program import Action
from mmrs_core.scene import RobotType
from mmrs_imc.messages import Message

ENTITY, SETS = "imc.entity", "imc.set."


def set_by(action: Action, type: RobotType | None) -> Message | str:
    """Return the message that an action of a device is, or why there is none."""
    device = type.devices.get(action.device) if type is not None else None
    if device is None:
        return f"device '{action.device}' is not described"
    entity, said = device.properties.get(ENTITY, ""), device.properties.get(SETS + action.name, "")
    if not entity or not said:
        return f"device '{action.device}' has no {ENTITY} and {SETS}{action.name}"
    pairs = [each.partition("=") for each in said.split(";")]
    entity = entity.strip()
    reported = [entity, *(text for name, _, value in pairs for text in (name, value))]
    if not all(equals and name.strip() for name, equals, _ in pairs) or not all(map(str.isascii, reported)):
        return f"{SETS}{action.name} of device '{action.device}' is '{said}', not Name=value;Name=value"
    params = tuple(
        Message("EntityParameter", {"name": name.strip(), "value": value.strip()}) for name, _, value in pairs
    )
    return Message("SetEntityParameters", {"name": entity, "params": params})
