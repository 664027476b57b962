"""What the properties of a device, and the parameters of its actions, say."""

from __future__ import annotations

from mmrs_core.behaviour.program import Action
from mmrs_core.contributions.wiring import Unwired
from mmrs_core.scene import Device


def number_in(device: Device, key: str) -> float | None:
    """Return the whole number that a property holds; None if it holds none."""
    try:
        return float(int(device.properties[key]))
    except (KeyError, ValueError):
        return None


def unsaid(device: Device, key: str) -> Unwired:
    """Return that a property holds no whole number."""
    return Unwired(f"device {device.id!r}: {key} is no whole number")


def said(action: Action, device: Device, key: str, parameter: str) -> str:
    """Return what an action sets: by its parameter, the property ``<key>.<action>``, or its own name."""
    default = device.properties.get(f"{key}.{action.name}", action.name)
    return dict(action.parameters).get(parameter, default)
