"""Constraints on photo grids: what one photo covers, and by how much photos overlap."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import children, number, text
from mmrs_core.languages.element import Element, is_set, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_survey.camera import FOCAL_KEY, IMAGE_KEYS, SENSOR_KEYS
from mmrs_survey.device_checks import devices_for

FOOTPRINT = ("footprintWidth", "footprintLength")
SEEN = (*FOOTPRINT, "groundResolution")
OVERLAPS = ("frontOverlap", "sideOverlap")
COARSE = 0.5
"""Metres per pixel, as photos of satellites have; from it on the unit is suspect."""


def seen_twice(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield photo grids with both a grid resolution and what one photo covers."""
    given = _given(task, SEEN)
    if number(task, "gridResolution") is not None and given:
        yield Finding(task, f"task '{label_of(task)}' has both gridResolution and {' and '.join(given)}")


def nothing_seen(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield photo grids for which neither the task nor any camera defines the distance between photos."""
    if _given(task, ("gridResolution", *SEEN)):
        return
    devices = devices_for(models, text(task, "actionName"), text(task, "deviceId"))
    if not any(_keys(device) >= {*SENSOR_KEYS, FOCAL_KEY} for device in devices):
        yield Finding(task, f"task '{label_of(task)}' does not define the distance between photos")


def half_footprint(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield footprints with a width only or a length only."""
    given = _given(task, FOOTPRINT)
    if len(given) == 1:
        (missing,) = set(FOOTPRINT) - set(given)
        yield Finding(task, f"{missing} of task '{label_of(task)}' is missing, {given[0]} is given")


def footprint_twice(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield photo grids with both a footprint and a ground resolution."""
    given = _given(task, FOOTPRINT)
    if given and number(task, "groundResolution") is not None:
        yield Finding(task, f"task '{label_of(task)}' has both groundResolution and {' and '.join(given)}")


def overlap_unused(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield overlaps beside a grid resolution."""
    given = [name for name in OVERLAPS if is_set(task, name)]
    if number(task, "gridResolution") is not None and given:
        yield Finding(
            task, f"{' and '.join(given)} of task '{label_of(task)}' has no use with a gridResolution"
        )


def resolution_unfounded(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield ground resolutions that no camera's image size turns into a footprint."""
    if number(task, "groundResolution") is None:
        return
    devices = devices_for(models, text(task, "actionName"), text(task, "deviceId"))
    if devices and not any(_keys(device) >= set(IMAGE_KEYS) for device in devices):
        yield Finding(
            task, f"groundResolution of task '{label_of(task)}' goes with no camera of known image size"
        )


def resolution_coarse(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield ground resolutions as coarse as those of satellites."""
    resolution = number(task, "groundResolution")
    if resolution is not None and resolution >= COARSE:
        yield Finding(
            task,
            f"groundResolution of task '{label_of(task)}' is {resolution:g} m per pixel, as from space",
        )


def _given(task: Element, names: tuple[str, ...]) -> list[str]:
    return [name for name in names if number(task, name) is not None]


def _keys(device: Element) -> set[str]:
    return {text(each, "name") for each in children(device, "properties")}
