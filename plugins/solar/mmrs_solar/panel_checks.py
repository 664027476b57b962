"""Constraints on panel groups, on tasks on their panels, on the figures of both, and on robots for them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from math import atan2, cos, degrees, dist, radians

from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.planning.devices import figure
from mmrs_core.scene.attributes import finite
from mmrs_solar.camera import HIGHEST_KEY, LOWEST_KEY, OPTICS_KEYS, PITCH_KEYS, RECORDING_KEYS
from mmrs_solar.names import IRRADIANCE, PANEL_GROUP, THERMAL_ROW_TASK

SQUARE = 2.0
"""Degrees by which azimuth and rows may be out of square, as surveyed points are."""


def out_of_square(group: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield panel groups whose first row has no length, or is not square to where its panels face."""
    positions = sketch_of(models).ground.positions
    ends = [positions[each] for each in children(group, "points") if each in positions]
    azimuth = number(group, "azimuth")
    if len(ends) != 2 or azimuth is None:
        return
    (east, north, _), (farther_east, farther_north, _) = ends
    if dist((east, north), (farther_east, farther_north)) < 1e-3:
        yield Finding(group, f"points of panel group '{label_of(group)}' are one point")
        return
    bearing = degrees(atan2(farther_east - east, farther_north - north)) % 360.0
    off = abs((azimuth - bearing) % 180.0 - 90.0)
    if off > SQUARE:
        squares = " or ".join(
            f"{angle:.1f}" for angle in sorted(((bearing + 90) % 360, (bearing - 90) % 360))
        )
        yield Finding(
            group,
            f"azimuth of panel group '{label_of(group)}' is {azimuth:g} degrees, {off:.1f} out of square to "
            "its row",
            f"panels of that row face {squares} degrees",
        )


def rows_overlap(group: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield panel groups of several rows whose pitch is missing, or less than a row takes."""
    rows, pitch = number(group, "rows") or 0.0, number(group, "pitch")
    width, tilt = number(group, "rowWidth") or 0.0, number(group, "tilt") or 0.0
    taken = width * cos(radians(tilt))
    if rows > 1 and pitch is None:
        yield Finding(group, f"pitch of panel group '{label_of(group)}' is missing, it has {rows:g} rows")
    elif rows > 1 and pitch is not None and pitch < taken:
        yield Finding(
            group, f"pitch of panel group '{label_of(group)}' is {pitch:g} m, a row takes {taken:.2f} m"
        )


def name_shared(context: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield panel groups without a name of their own."""
    groups = [each for each in children(context, "elements") if is_kind(each, *PANEL_GROUP)]
    counted = Counter(label_of(each) for each in groups)
    for group in groups:
        name = label_of(group)
        if not name:
            yield Finding(group, "panel group has no name that tasks can refer to")
        elif counted[name] > 1:
            yield Finding(group, f"panel group '{name}' is one of {counted[name]} of that name")


def row_outside(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks along rows that the group does not have."""
    group = child(task, "group")
    rows = number(group, "rows") if group is not None else None
    first, last = number(task, "firstRow") or 0.0, number(task, "lastRow")
    if rows is None or group is None:
        return
    if not 1 <= first <= (rows if last is None else last) <= rows:
        asked = f"{first:g} to {rows if last is None else last:g}"
        yield Finding(
            task, f"task '{label_of(task)}' asks for rows {asked}, '{label_of(group)}' has 1 to {rows:g}"
        )


def panel_outside(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield suspected panels that the group does not have."""
    group = child(task, "group")
    for panel in children(task, "panels") if group is not None else ():
        for name, whole in (("row", "rows"), ("column", "columns"), ("tier", "tiers")):
            asked, there = number(panel, name), number(group, whole) if group is not None else None
            if asked is not None and there is not None and not 1 <= asked <= there:
                yield Finding(
                    panel,
                    f"{name} {asked:g} is suspected by task '{label_of(task)}', panel group "
                    f"'{label_of(group) if group is not None else ''}' has 1 to {there:g}",
                )


def too_dark(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks that ask for more sunlight than the environment has."""
    place = child(models.context, "environment") if models.context is not None else None
    sunlight = number(place, "irradiance") if place is not None else None
    least = number(task, IRRADIANCE)
    if sunlight is not None and least is not None and sunlight < least:
        yield Finding(
            task, f"task '{label_of(task)}' asks for {least:g} W/m², the irradiance is {sunlight:g} W/m²"
        )


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
    figures = {key: finite(text(each, "value")) for key, each in found.items()}
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
