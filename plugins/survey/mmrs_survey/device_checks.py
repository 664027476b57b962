"""Constraints on devices: that some robot has what a survey task asks for, and what cameras state."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from mmrs_core.analysis.constraints.capabilities import undoable
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import children, number, text
from mmrs_core.languages.element import Element, container_of, is_kind, label_of, metaclass_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.planning.devices import figure
from mmrs_survey.camera import CAMERA_KEYS
from mmrs_survey.names import PATH_PHOTO_TASK, SURVEY

SPACED = ("photoDistance", "footprintLength", "groundResolution")
"""What makes a task along a line take photos."""


def devices_for(models: ModelSet, action: str, device_id: str) -> list[Element]:
    """Return the devices of all robot types that support an action, or of those the one named.

    Args:
        device_id: empty: any device.
    """
    return [
        device
        for robot_type in models.robots.values()
        for device in children(robot_type, "devices")
        if device_id in ("", text(device, "id")) and _action(device, action) is not None
    ]


def device_unclear(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield survey tasks that name no device where every able robot type has several."""
    action = _action_asked(task)
    if not action or text(task, "deviceId"):
        return
    able = [list(group) for _, group in groupby(devices_for(models, action, ""), container_of)]
    if able and all(len(devices) > 1 for devices in able):
        names = " and ".join(f"'{text(device, 'id')}'" for device in able[0])
        yield Finding(task, f"deviceId of task '{label_of(task)}' is missing: {names} support '{action}'")


def action_undone(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield survey tasks whose device or action no robot type has, unless the team lacks it by name."""
    if not _is_survey(task) or not models.robots or undoable(task, models):
        return
    action, device_id = _action_asked(task), text(task, "deviceId")
    if action and not devices_for(models, action, device_id):
        where = f"device '{device_id}'" if device_id else "device"
        yield Finding(
            task, f"task '{label_of(task)}' asks for '{action}', no robot type has a {where} for that"
        )
    elif device_id and not action and not any(_carries(each, device_id) for each in models.robots.values()):
        yield Finding(task, f"task '{label_of(task)}' asks for device '{device_id}', no robot type has it")


def parameter_unknown(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield parameters that the action takes on no device."""
    action = text(task, "actionName")
    devices = devices_for(models, action, text(task, "deviceId"))
    known = {
        text(parameter, "key")
        for device in devices
        for parameter in children(_action(device, action), "parameters")
    }
    for pair in children(task, "parameters") if devices else ():
        key = text(pair, "key")
        if key not in known:
            takes = ", ".join(sorted(known)) or "none"
            yield Finding(pair, f"parameter '{key}' is not taken by action '{action}', which takes {takes}")


def camera_unreadable(device: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield properties of cameras that are not numbers above zero."""
    for each in children(device, "properties"):
        key, value = text(each, "name"), text(each, "value")
        if key in CAMERA_KEYS and figure({key: value}, key) is None:
            yield Finding(each, f"property '{key}' of device '{text(device, 'id')}' is '{value}'")


def _is_survey(task: Element) -> bool:
    return any(ns_uri == SURVEY for ns_uri, _ in metaclass_of(task).ancestry)


def _action_asked(task: Element) -> str:
    """Return the action that a survey task really does; empty for none."""
    if not _is_survey(task):
        return ""
    along_path = is_kind(task, *PATH_PHOTO_TASK)
    without_photos = along_path and all(number(task, name) is None for name in SPACED)
    return "" if without_photos else text(task, "actionName")


def _action(device: Element, action: str) -> Element | None:
    return next((each for each in children(device, "supportedActions") if label_of(each) == action), None)


def _carries(robot_type: Element, device_id: str) -> bool:
    return any(text(device, "id") == device_id for device in children(robot_type, "devices"))
