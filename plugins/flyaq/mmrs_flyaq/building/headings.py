"""Directions as headings: ours lead to a place, so one is made far away."""

from __future__ import annotations

from math import cos, radians, sin

from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import Element, metaclass_of, root_of
from mmrs_flyaq.building.converting import number_in
from mmrs_flyaq.building.drafts import Draft, placed
from mmrs_flyaq.findings import Category
from mmrs_flyaq.recording import Record
from mmrs_flyaq.rules.mapping import Use
from mmrs_flyaq.sources.nodes import SourceNode, Text


def towards(angle_degrees: float, metres: float) -> tuple[float, float]:
    """Return metres east and north, to the millimetre, of what lies that far away, clockwise from north.

    >>> towards(90.0, 5.0), towards(180.0, 5.0)
    ((5.0, 0.0), (0.0, -5.0))
    """
    angle = radians(angle_degrees)
    # adding zero turns a negative zero into one that reads like any other
    return round(metres * sin(angle), 3) + 0.0, round(metres * cos(angle), 3) + 0.0


def set_heading(
    node: SourceNode, feature: str, element: Element, use: Use, draft: Draft, record: Record
) -> None:
    """Give a move a heading for the angle that a feature holds; what hinders it is recorded."""
    assert use.bearing is not None  # asked before
    value, *further = node.values.get(feature) or [Text(draft.said(node, feature), node.line)]
    if further:
        record.value(Category.LOST, "is more than one angle, of which the first counts", node, feature)
    own = use.bearing.base == "self"
    owner = next(draft.around(node), None) if own else element
    robot = next((each for each in draft.around(node) if isinstance(each, bl.Robot)), None)
    base = element if own else robot.home if robot is not None else None
    behaviour = root_of(owner) if owner is not None else None
    target = metaclass_of(owner).by_name.get(use.to[0].last) if owner is not None else None
    if (
        not isinstance(value, Text)
        or owner is None
        or target is None
        or not isinstance(behaviour, bl.Behaviour)
    ):
        record.value(Category.LOST, "stands in no move of a behaviour", node, feature)
        return
    try:
        east, north = towards(number_in(value.text), use.bearing.distance)
    except ValueError as fault:
        record.value(Category.LOST, str(fault), node, feature, value)
        return
    reference = base if isinstance(base, bl.Coordinate) else None
    place = placed(bl.RelativeCoordinate(x=east, y=north, reference=reference), node)
    behaviour.targets.append(place)
    setattr(owner, target.attribute, bl.Heading(target=place))
    reason = use.changed or f"headings lead to a place: one {use.bearing.distance:g} m away in this direction"
    record.value(Category.CHANGED, reason, node, feature, value)
