"""Constraints on the figures of panel groups, of tasks on them, and of cameras."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_solar.camera import HIGHEST_KEY, LOWEST_KEY, PITCH_KEYS, RECORDING_KEYS
from mmrs_solar.names import IRRADIANCE

PIXELS_PER_CELL = 5.0
"""Pixels across a cell that an inspection needs at least (IEC TS 62446-3)."""
LEAST_IRRADIANCE = 600.0
"""Watts per square metre in the plane of the panels (IEC TS 62446-3)."""
RECOMMENDED = {"speed": 2.0, "frontOverlap": 0.8, "sideOverlap": 0.6}
"""Largest speed, smallest overlaps that inspectors go by."""

OVERLAPS = ("frontOverlap", "sideOverlap")


def coarse(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks whose pixels are too large for the cells of their group."""
    group, pixel = child(task, "group"), number(task, "pixelSize")
    cell = number(group, "cellSize") if group is not None else None
    if cell is not None and pixel is not None and pixel > cell / PIXELS_PER_CELL:
        yield Finding(
            task,
            f"pixelSize of task '{label_of(task)}' is {pixel:g} m, cells of {cell:g} m are seen with "
            f"{cell / pixel:.1f} pixels",
            f"at most {cell / PIXELS_PER_CELL:.4f} m makes {PIXELS_PER_CELL:g} pixels of a cell",
        )


def dim(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks that are content with less sunlight than an inspection needs."""
    least = number(task, IRRADIANCE)
    if least is not None and 0.0 <= least < LEAST_IRRADIANCE:
        yield Finding(task, f"{IRRADIANCE} of task '{label_of(task)}' is {least:g} W/m²")


def hasty(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks that go faster, or overlap less, than inspectors do."""
    for name, bound in RECOMMENDED.items():
        found = number(task, name)
        if found is not None and (found > bound if name == "speed" else 0.0 <= found < bound):
            yield Finding(task, f"{name} of task '{label_of(task)}' is {found:g}, {bound:g} is recommended")


def camera_unreadable(device: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield times and angles of cameras that are none."""
    found = {text(each, "name"): each for each in children(device, "properties")}
    figures = {key: _figure(text(each, "value")) for key, each in found.items()}
    named = text(device, "id")
    for key, each in found.items():
        figure = figures[key]
        time = key not in RECORDING_KEYS or (figure is not None and figure > 0.0)
        angle = key not in PITCH_KEYS or (figure is not None and abs(figure) <= 90.0)
        if not (time and angle):
            yield Finding(each, f"property '{key}' of device '{named}' is '{text(each, 'value')}'")
    lowest, highest = figures.get(LOWEST_KEY), figures.get(HIGHEST_KEY)
    if lowest is not None and highest is not None and lowest > highest:
        yield Finding(device, f"{LOWEST_KEY} of device '{named}' is above its {HIGHEST_KEY}")


def _figure(value: str) -> float | None:
    try:
        found = float(value)
    except ValueError:
        return None
    return found if isfinite(found) else None
