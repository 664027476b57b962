"""A drawing while its file is read: positions are checked, and what is not a feature is noted."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import NoReturn, TypedDict

import numpy as np
from numpy.typing import NDArray

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import (
    Drawing,
    Geometry,
    HeightReference,
    LeftOut,
    MapFeature,
    Property,
    Role,
    printable,
)
from mmrs_core.errors import UnreadableError

LARGEST_FILE = 128 * 1024 * 1024
MOST_FEATURES = 200_000
HIGHEST = 1e5
"""Metres above or below zero that no vehicle goes beyond."""


class FeatureTraits(TypedDict, total=False):
    """What a feature has besides its shape, as in `MapFeature`."""

    name: str
    description: str
    role: Role
    folders: tuple[str, ...]
    properties: Mapping[str, Property]
    radius: float | None
    colour: str
    since_start: bool


@dataclass(frozen=True, slots=True)
class DrawnSubject:
    """What shapes are drawn for.

    Attributes:
        what: in messages, such as ``placemark 'orchard'``.
        reference: what heights are measured from, if their subject says so.
        times: of the positions of its first ring, if it has as many.
    """

    what: str
    place: Place
    traits: FeatureTraits
    reference: HeightReference | None = None
    times: NDArray[np.float64] | None = None


class Sheet:
    """Collects features of one file.

    Attributes:
        features: so far.
        left_out: so far.
    """

    def __init__(self, data: bytes, file: str, axes: str, *, lenient: bool = False) -> None:
        """Refuse what is too large, or empty.

        Args:
            axes: how the format orders coordinates, for messages.
            lenient: whether a feature that is not on the Earth is left out, and does not refuse the file.
        """
        self.file = file
        self._axes, self._lenient = axes, lenient
        self.features: list[MapFeature] = []
        self.left_out: list[LeftOut] = []
        if len(data) > LARGEST_FILE:
            self.refuse(f"larger than {LARGEST_FILE // (1024 * 1024)} MB; split it")
        if not data.strip(b"\xef\xbb\xbf \t\r\n"):
            self.refuse("empty")

    def refuse(self, reason: str, line: int = 0) -> NoReturn:
        """Raise the error for a fault of the file."""
        raise UnreadableError.of("", reason, self.file, line)

    def leave_out(self, what: str, reason: str, line: int = 0, subject: DrawnSubject | None = None) -> None:
        """Note something that no feature stands for; `subject`: of a feature whose shape is none."""
        lost = None
        if subject is not None:
            lost = MapFeature(Geometry.POINT, (np.zeros((1, 2)),), place=subject.place, **subject.traits)
        self.left_out.append(LeftOut(printable(what), printable(reason), Place(self.file, line), lost))

    def drawing(self, title: str = "") -> Drawing:
        """Return what was collected."""
        return Drawing(tuple(self.features), tuple(self.left_out), printable(title))

    def positions(self, values: object, what: str, line: int = 0) -> NDArray[np.float64]:
        """Return positions (n, 2), or (n, 3) if all have a height, from a sequence of sequences.

        Further values are left out, and so are heights that only some positions have.

        Raises:
            UnreadableError: if anything is not a number, or a position has fewer than two.
        """
        try:
            array = np.array(values)
        except (ValueError, OverflowError):
            return self._ragged(values, what, line)
        if array.ndim != 2 or array.shape[1] < 2 or array.dtype.kind not in "fiu":
            return self._ragged(values, what, line)
        if array.shape[1] > 3:
            self.leave_out(f"further values of {what}", "a position has at most three", line)
        return array[:, :3].astype(np.float64)

    def _ragged(self, values: object, what: str, line: int) -> NDArray[np.float64]:
        rows = values if isinstance(values, Sequence) and not isinstance(values, str) else ()
        for number, row in enumerate(rows, start=1):
            if not isinstance(row, Sequence) or isinstance(row, str):
                self.refuse(f"{what}: position {number} is not a position", line)
            if len(row) < 2:
                self.refuse(f"{what}: position {number} has fewer than two coordinates", line)
            for value in row[:3]:
                if not isinstance(value, int | float) or isinstance(value, bool):
                    text = json.dumps(value)[:40]
                    self.refuse(f"{what}: {text} of position {number} is not a number", line)
                if isinstance(value, int) and abs(value) > 10**9:
                    self.refuse(f"{what}: {str(value)[:40]} of position {number} is too large", line)
        if not rows:
            self.refuse(f"{what}: no positions", line)
        if len({min(len(row), 3) for row in rows}) > 1:
            self.leave_out(f"heights of {what}", "some positions have none", line)
            rows = [row[:2] for row in rows]
        return np.array([row[:3] for row in rows], dtype=np.float64)

    def add(
        self,
        geometry: Geometry,
        rings: Sequence[NDArray[np.float64]],
        subject: DrawnSubject,
        usual: HeightReference = HeightReference.NONE,
    ) -> None:
        """Add a feature, or note why its shape is none.

        Args:
            rings: arrays (n, 2) or (n, 3) of latitude, longitude and height; closed or not.
            usual: what heights are measured from where their subject does not say.
        """
        what, line = subject.what, subject.place.line
        for ring in rings:
            if fault := self._fault_of(ring):
                if not self._lenient:
                    self.refuse(f"{what}: {fault}", line)
                self.leave_out(what, fault, line, subject)
                return
        rings = [_around(ring) for ring in rings]
        least = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}[geometry]
        times = (
            subject.times
            if rings and subject.times is not None and len(subject.times) == len(rings[0])
            else None
        )
        if geometry is Geometry.AREA:
            rings = [_opened(ring) for ring in rings]
        whole = [ring for ring in rings if _has_distinct(ring, least)]
        if not rings or not _has_distinct(rings[0], least):
            reason = f"fewer than {least} different positions" if least > 1 else "no position"
            self.leave_out(f"{geometry.value} of {what}", reason, line, subject)
            return
        if len(whole) < len(rings):
            count = len(rings) - len(whole)
            self.leave_out(f"holes of {what}: {count}", "fewer than 3 different positions", line)
        if len(self.features) == MOST_FEATURES:
            self.refuse(f"more than {MOST_FEATURES} features; split it", line)
        reference = subject.reference or usual
        widths = {ring.shape[1] for ring in whole}
        high = widths == {3} and reference is not HeightReference.NONE
        if len(widths) > 1:
            self.leave_out(f"heights of {what}", "some positions have none", line)
        feature = MapFeature(
            geometry,
            tuple(np.ascontiguousarray(ring[:, :2]) for ring in whole),
            tuple(ring[:, 2].copy() for ring in whole) if high else (),
            reference if high else HeightReference.NONE,
            times=None if times is None else times[: len(whole[0])],
            place=subject.place,
            **subject.traits,
        )
        self.features.append(feature)

    def _fault_of(self, ring: NDArray[np.float64]) -> str:
        """Return why a ring is not on the Earth; empty if it is."""
        finite = np.isfinite(ring).all(axis=1)
        if not finite.all():
            return f"a coordinate of position {int(np.argmin(finite)) + 1} is not a finite number"
        latitudes, longitudes = np.abs(ring[:, 0]), np.abs(ring[:, 1])
        beyond = (latitudes > 90.0) | (longitudes > 360.0)
        if beyond.any():
            at = int(np.argmax(beyond))
            swapped = bool((latitudes <= 180.0).all() and (longitudes <= 90.0).all())
            why = f"are the axes swapped? {self._axes}" if swapped else "give degrees in WGS 84, not metres"
            position = f"latitude {ring[at, 0]:g}, longitude {ring[at, 1]:g}"
            return f"position {at + 1} ({position}) is not on the Earth; {why}"
        if ring.shape[1] == 3 and (np.abs(ring[:, 2]) > HIGHEST).any():
            return f"a height of more than {HIGHEST / 1000:g} km"
        return ""


def _around(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a ring with longitudes between -180 and 180 degrees."""
    far = np.abs(ring[:, 1]) > 180.0
    if far.any():
        ring = ring.copy()
        ring[far, 1] = (ring[far, 1] + 180.0) % 360.0 - 180.0
    return ring


def property_of(value: object) -> Property:
    """Return a value of a file as a property; what is composed, or infinite, as the text of its JSON."""
    if isinstance(value, str | bool | int) or (isinstance(value, float) and isfinite(value)):
        return value
    return json.dumps(value, ensure_ascii=False)


def _opened(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a ring without the repeats of its first position at its end."""
    end = len(ring)
    while end > 1 and (ring[end - 1, :2] == ring[0, :2]).all():
        end -= 1
    return ring[:end]


def _has_distinct(ring: NDArray[np.float64], least: int) -> bool:
    if least == 1:
        return len(ring) > 0
    return any(len(np.unique(ring[:end, :2], axis=0)) >= least for end in (64, len(ring)))
