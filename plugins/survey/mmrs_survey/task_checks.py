"""Constraints on the figures of survey tasks, and on devices: what tasks ask for, what cameras state."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from mmrs_core.analysis.constraints.capabilities import undoable
from mmrs_core.analysis.constraints.ranges import at_least_zero, every, of_kind, positive
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import child, children, number, text, texts
from mmrs_core.languages.element import Element, container_of, is_kind, label_of, metaclass_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.planning.devices import figure
from mmrs_survey import names
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


IN_RANGES = every(
    of_kind(
        names.PHOTO_TASK, positive("footprintWidth", "footprintLength", "groundResolution", "speed", "blur")
    ),
    of_kind(names.PHOTO_GRID_TASK, positive("gridResolution")),
    of_kind(names.PATH_PHOTO_TASK, positive("photoDistance")),
    of_kind(names.PERIMETER_TASK, positive("layers")),
    of_kind(names.ORBIT_TASK, positive("radius", "turns")),
    of_kind(names.OBSERVE_TASK, positive("duration")),
    of_kind(names.MEASURE_TASK, positive("spacing")),
    of_kind(names.ROAD_TASK, at_least_zero("width", "turnaroundDistance")),
    of_kind(names.OBSERVE_TASK, at_least_zero("distance")),
    of_kind(names.MEASURE_TASK, at_least_zero("depth")),
    of_kind(names.APPROACH_TASK, at_least_zero("distance", "tolerance")),
)


def relay_bound(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield what a mission asks of the tasks of relays that these, which last as others need, cannot keep."""
    relays = [task for task in children(mission, "tasks") if is_kind(task, *names.RELAY_TASK)]
    for dependency in children(mission, "taskDependencies") if relays else ():
        for task in relays:
            if task in (child(dependency, "from"), child(dependency, "to")):
                yield Finding(dependency, f"task '{label_of(task)}' is a relay, it cannot have dependencies")
    for task in relays:
        if (number(task, "robotsWanted") or 1) > 1:
            yield Finding(task, f"task '{label_of(task)}' is a relay, but wants several robots")
        if number(task, "earliestStart"):
            yield Finding(task, f"task '{label_of(task)}' is a relay, but has an earliest start")


def twice_high(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield measurements with an altitude and a depth."""
    if number(task, "altitude") is not None and number(task, "depth") is not None:
        yield Finding(task, f"task '{label_of(task)}' has both an altitude and a depth")


def nowhere_to_measure(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield measurements without points or an area with a spacing."""
    points, shell = children(task, "points"), children(task, "shell")
    if not points and not shell:
        yield Finding(task, f"task '{label_of(task)}' has neither points nor a shell")
    elif shell and len(shell) < 3:
        yield Finding(task, f"shell of task '{label_of(task)}' has {len(shell)} points, 3 are needed")
    elif shell and number(task, "spacing") is None:
        yield Finding(task, f"spacing of task '{label_of(task)}' is missing, its shell needs one")


def where_to_measure_twice(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield measurements with points and an area."""
    if children(task, "points") and children(task, "shell"):
        yield Finding(task, f"task '{label_of(task)}' has both points and a shell")


def object_anywhere(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield approaches without a tolerance, unless the mission accepts what follows from that."""
    accepted = texts(models.mission, "acceptedUnknowns") if models.mission is not None else ()
    if number(task, "tolerance") is None and "clearance" not in accepted:
        where = text(task, "object")
        yield Finding(task, f"tolerance of task '{label_of(task)}' is missing: '{where}' may be anywhere")


def looks_at_itself(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield observations from the very point that is looked at."""
    if number(task, "altitude") is None and not number(task, "distance"):
        yield Finding(task, f"task '{label_of(task)}' is observed from the point itself")
