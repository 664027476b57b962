"""Points, lines and areas on the Earth, as map programs draw them, in no format of theirs."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.diagnostics import Place

Property: TypeAlias = str | float | int | bool

_UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
"""Controls of terminals, of lines and of the direction of writing, and what no encoding or XML can hold."""


def printable(text: str, kept: str = "") -> str:
    r"""Return a text with spaces for all controls but those kept, and without spaces around it.

    >>> printable("north\x1b[31m\n meadow ")
    'north [31m  meadow'
    """
    if text.isprintable():
        return text.strip()
    return _UNPRINTABLE.sub(lambda found: found[0] if found[0] in kept else " ", text).strip()


class Geometry(StrEnum):
    """The shape of a feature."""

    POINT = "point"
    LINE = "line"
    AREA = "area"


class HeightReference(StrEnum):
    """What the heights of a feature are measured from."""

    NONE = "no height"
    GROUND = "the ground"
    HOME = "the home position"
    SEA_LEVEL = "mean sea level"
    ELLIPSOID = "the ellipsoid"


class Role(StrEnum):
    """What a feature is for, as far as its format says so."""

    UNKNOWN = ""
    HOME = "home"
    RALLY_POINT = "rally point"
    CHOSEN_RALLY_POINT = "rally point chosen by a plan"
    EMERGENCY_AREA = "emergency area"
    INCLUSION = "inclusion fence"
    FORBIDDEN = "forbidden area"
    OBSTACLE = "obstacle"
    TASK = "task"
    SURVEY = "survey"
    CORRIDOR = "corridor"
    STRUCTURE = "structure scan"
    WAYPOINT = "waypoint"
    PATH = "planned path"
    TRACK = "track"
    PHOTO = "photo"
    ELEMENT = "context element"
    ACTION = "action"
    EVENT = "event"


@dataclass(frozen=True, slots=True, eq=False)
class MapFeature:
    """One point, line or area.

    Attributes:
        geometry: a multi-geometry is as many features as it has parts.
        rings: arrays (n, 2) of latitude and longitude in degrees, WGS84. A point has one with n = 1, a
            line one with n >= 2, an area its outer ring and then its holes; none repeats its first position.
        heights: arrays (n,) in metres, one for each ring; empty if `reference` is NONE.
        times: array (n,) of seconds since 1970-01-01 UTC, of the first ring; None where not given.
        since_start: whether `times` count from the start of a mission, whose time of day is unknown.
        radius: metres, of a circle around a point; None for all others.
        name: as in the file, without controls; may be empty, and need not be unique.
        description: may have several lines.
        folders: names of the folders or layers that it is in, outermost first.
        properties: further values, by key.
        colour: as ``#rrggbb``; empty: that of the program that shows it.
        place: file and line; the path is the feature's within the file.
    """

    geometry: Geometry
    rings: tuple[NDArray[np.float64], ...]
    heights: tuple[NDArray[np.float64], ...] = ()
    reference: HeightReference = HeightReference.NONE
    times: NDArray[np.float64] | None = None
    since_start: bool = False
    radius: float | None = None
    name: str = ""
    description: str = ""
    role: Role = Role.UNKNOWN
    folders: tuple[str, ...] = ()
    properties: Mapping[str, Property] = field(default_factory=dict)
    colour: str = ""
    place: Place = Place()

    def __post_init__(self) -> None:
        """Refuse shapes that no reader may return."""
        least = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}[self.geometry]
        if not self.rings or any(ring.ndim != 2 or ring.shape[1] != 2 for ring in self.rings):
            raise ValueError("rings are arrays of latitude and longitude")
        if any(len(ring) < least for ring in self.rings):
            raise ValueError(f"a ring of {self.geometry.value} has {least} positions or more")
        if self.geometry is not Geometry.AREA and len(self.rings) > 1:
            raise ValueError(f"a {self.geometry.value} has one ring")
        if self.heights and [h.shape for h in self.heights] != [(len(ring),) for ring in self.rings]:
            raise ValueError("every position has a height, or none has")
        if bool(self.heights) is (self.reference is HeightReference.NONE):
            raise ValueError("heights and what they are measured from are given together")
        if self.times is not None and self.times.shape != (len(self.rings[0]),):
            raise ValueError("every position of the first ring has a time, or none has")
        for name, text in (
            ("name", printable(self.name)),
            ("description", printable(self.description.replace("\r\n", "\n"), "\n\t")),
            ("folders", tuple(map(printable, self.folders))),
            ("properties", {printable(key): _plain(value) for key, value in self.properties.items()}),
        ):
            object.__setattr__(self, name, text)


def _plain(value: Property) -> Property:
    return printable(value.replace("\r\n", "\n"), "\n\t") if isinstance(value, str) else value


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Something in a file that no feature stands for.

    Attributes:
        what: such as ``ground overlay 'orchard'``.
        reason: why it was left out.
        lost: stands for a feature whose shape is none: its name, folders, role and properties; at no place.
    """

    what: str
    reason: str
    place: Place = Place()
    lost: MapFeature | None = None


@dataclass(frozen=True, slots=True)
class Drawing:
    """What a file holds.

    Attributes:
        features: in their order.
        left_out: everything that is none.
        title: of the whole; may be empty.
    """

    features: tuple[MapFeature, ...]
    left_out: tuple[LeftOut, ...] = ()
    title: str = ""
