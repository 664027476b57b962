"""Where a local frame lies on the Earth: positions in metres become positions of a drawing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from mmrs_core.behaviour.earth import degrees_of, origin_above_ellipsoid, origin_above_sea, wgs84_of
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, LeftOut, MapFeature
from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.layers.layer import Layer
from mmrs_core.scene import Frame, Point, Position

Shape: TypeAlias = Sequence[Point] | Sequence[Position] | Floats
Drawn: TypeAlias = MapFeature | tuple[Layer, LeftOut]
_DECIMALS = 9
"""Decimals of degrees: a tenth of a millimetre."""


@dataclass(frozen=True, slots=True)
class Chart:
    """Where a frame lies on the Earth, and when its times begin.

    Attributes:
        frame: lies on the Earth.
        reference: what heights are measured from; HOME: the origin.
        zero: height of the origin, measured so, metres.
        start: time of day at which the time is 0, seconds since 1970-01-01 UTC; None where unknown.
    """

    frame: Frame
    reference: HeightReference
    zero: float = 0.0
    start: float | None = None

    def point(self, at: Point | Position, time: float | None = None) -> MapFeature:
        """Return a position as a feature; its time in seconds from the start."""
        return self._laid(Geometry.POINT, [np.array([at])], None if time is None else np.array([time]))

    def line(self, points: Shape, times: Floats | None = None) -> MapFeature:
        """Return a line, or the point that a single position is."""
        return self._laid(Geometry.LINE if len(points) > 1 else Geometry.POINT, [points], times)

    def area(self, rings: Sequence[Shape]) -> MapFeature:
        """Return an area of an outline and holes."""
        return self._laid(Geometry.AREA, rings)

    def words(self, at: Point) -> str:
        """Return the latitude and the longitude of a position."""
        ((latitude, longitude),) = degrees_of([at], self.frame)
        return f"{latitude:.7f}, {longitude:.7f}"

    def _laid(self, geometry: Geometry, rings: Sequence[Shape], times: Floats | None = None) -> MapFeature:
        laid = [np.asarray(ring, float) for ring in rings]
        degrees = wgs84_of(np.concatenate([ring[:, :2] for ring in laid]), self.frame).round(_DECIMALS)
        high = all(ring.shape[1] == 3 for ring in laid)
        return MapFeature(
            geometry,
            tuple(np.split(degrees, np.cumsum([len(ring) for ring in laid])[:-1])),
            heights=tuple((ring[:, 2] + self.zero).round(3) + 0.0 for ring in laid) if high else (),
            reference=self.reference if high else HeightReference.NONE,
            times=None if times is None else (times + (self.start or 0.0)).round(3),
            since_start=times is not None and self.start is None,
        )


def chart_of(frame: Frame, heights: Iterable[HeightReference], start: float | None = None) -> Chart:
    """Return the chart of a frame, with heights above the first reference that is known of its origin.

    Args:
        frame: lies on the Earth.
        heights: what they may be measured from, most wanted first. Where all are unknown, they are above the
            origin.
        start: time of day at which the time is 0, seconds since 1970-01-01 UTC; None where unknown.
    """
    known = {
        HeightReference.ELLIPSOID: origin_above_ellipsoid(frame),
        HeightReference.SEA_LEVEL: origin_above_sea(frame),
    }
    for reference in heights:
        if (zero := known.get(reference)) is not None:
            return Chart(frame, reference, zero, start)
    return Chart(frame, HeightReference.HOME, 0.0, start)


def drawing_of(drawn: Iterable[Drawn], only: Iterable[Layer] = ()) -> Drawing:
    """Return a drawing of what is drawn and of what has no position, layer by layer.

    Args:
        drawn: in any order of layers.
        only: layers that are wanted; none: all.
    """
    wanted = set(only) or set(Layer)
    features: list[MapFeature] = []
    left_out: list[LeftOut] = []
    for each in drawn:
        if not isinstance(each, MapFeature):
            left_out += [each[1]] if each[0] in wanted else []
        elif each.folders[0] in wanted:
            features.append(each)
    order = {layer: number for number, layer in enumerate(Layer)}
    return Drawing(tuple(sorted(features, key=lambda each: order[Layer(each.folders[0])])), tuple(left_out))


def lacking_for(frame: Frame, heights: Iterable[HeightReference]) -> str:
    """Return what a mission lacks for heights above one of these references; empty: nothing."""
    wanted = [each for each in heights if each in (HeightReference.ELLIPSOID, HeightReference.SEA_LEVEL)]
    if not wanted or chart_of(frame, wanted).reference is not HeightReference.HOME:
        return ""
    if frame.altitude is None or frame.altitude_reference == "ORIGIN":
        return "the altitude of its origin above mean sea level or the ellipsoid"
    return "its geoidSeparation"
