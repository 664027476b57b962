"""Constraints on the robots of a project: that some camera can do what tasks on panels ask for."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import children, text
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.planning.devices import figure
from mmrs_solar.camera import OPTICS_KEYS, RECORDING_KEYS
from mmrs_solar.names import IRRADIANCE, THERMAL_ROW_TASK


def undone(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks whose device or actions no robot type has."""
    actions = _actions(task)
    if models.robots and all(actions) and not _cameras(task, models):
        device = text(task, "deviceId")
        where = f"device '{device}'" if device else "device"
        asked = " and ".join(f"'{action}'" for action in actions)
        yield Finding(task, f"task '{label_of(task)}' asks for {asked}, no robot type has a {where} for that")


def undescribed(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks that no camera can do because none states its optics."""
    keys = (*OPTICS_KEYS, *RECORDING_KEYS) if is_kind(task, *THERMAL_ROW_TASK) else OPTICS_KEYS
    missing = [_missing(camera, keys) for camera in _cameras(task, models)]
    if missing and all(missing):
        fewest = min(missing, key=len)
        yield Finding(task, f"task '{label_of(task)}' needs a camera that states {', '.join(fewest)}")


def unrecorded(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks whose least irradiance no camera records."""
    cameras = _cameras(task, models)
    action = _actions(task)[0]
    if cameras and not any(_takes(camera, action) for camera in cameras):
        yield Finding(
            task,
            f"task '{label_of(task)}' needs a camera whose '{action}' takes the parameter '{IRRADIANCE}'",
        )


def _actions(task: Element) -> tuple[str, ...]:
    names = ("startAction", "stopAction") if is_kind(task, *THERMAL_ROW_TASK) else ("actionName",)
    return tuple(text(task, name) for name in names)


def _cameras(task: Element, models: ModelSet) -> list[Element]:
    """Return the devices of all robot types that a task may mean and that support all its actions."""
    device_id, asked = text(task, "deviceId"), set(_actions(task))
    return [
        device
        for robot_type in models.robots.values()
        for device in children(robot_type, "devices")
        if device_id in ("", text(device, "id"))
        and asked <= {label_of(action) for action in children(device, "supportedActions")}
    ]


def _missing(device: Element, keys: tuple[str, ...]) -> list[str]:
    stated = {text(each, "name"): text(each, "value") for each in children(device, "properties")}
    return [key for key in keys if figure(stated, key) is None]


def _takes(device: Element, action: str) -> bool:
    return any(
        text(parameter, "key") == IRRADIANCE
        for each in children(device, "supportedActions")
        if label_of(each) == action
        for parameter in children(each, "parameters")
    )
