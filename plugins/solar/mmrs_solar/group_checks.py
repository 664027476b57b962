"""Constraints on how panel groups lie, and on which of their panels tasks ask for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from math import atan2, cos, degrees, dist, radians

from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import child, children, number
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_solar.names import IRRADIANCE, PANEL_GROUP

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
