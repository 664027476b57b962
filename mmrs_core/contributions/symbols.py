"""How elements look on maps and pictures."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from mmrs_core.contributions.rules import most_specific
from mmrs_core.languages.uris import CONTEXT, MISSION

if TYPE_CHECKING:
    from mmrs_core.drawings.drawing import Property
    from mmrs_core.scene import Metaclasses, Name, Part, Ring

_COLOUR = re.compile("#[0-9a-fA-F]{6}")
_LONGEST_ICON = 2


@dataclass(frozen=True, slots=True)
class MapSymbol:
    """The look of elements of one metaclass.

    An element is drawn where its grounded attributes say: a mark at each coordinate, an outline through
    the coordinates called ``shell`` and a line through those called ``points``, each by the same names
    as in areas and tasks. What an element contains is drawn likewise.

    Attributes:
        metaclass: of the elements.
        label: common name of such an element.
        colour: as ``#rrggbb``; empty: that of the palette for symbols.
        icon: up to two characters that stand for it on a map.
        fields: attributes that an editor offers first and pictures show, by feature name.
        outlines: rings (east, north) in metres that an element's figures make beside its coordinates, such
            as a circle of its radius; none where a figure is missing. None: its coordinates are all.
        usual_for: the shape of which such a task is made where a drawing does not state its purpose, a
            waypoint of a mission, or a structure to go round.
        initial: values of a new element, by feature name.
        alternatives: sets of features of which one replaces the others; when one is given, the
            `initial` values of the others are not used.
        height: feature with the height of a task above the origin, in metres; empty: it has none.
        variants: further values with which `mmrs new` begins a task that its robots cannot do with `initial`
            alone; an empty text takes one of those away.
        device, action: features with a device and its action, of those that the robot has; empty: none.

    Raises:
        ValueError: if the colour is none, or the icon is too long.
    """

    metaclass: Name
    label: str
    colour: str
    icon: str
    fields: tuple[str, ...] = ()
    outlines: Callable[[Part], tuple[Ring, ...]] | None = None
    usual_for: Literal["", "point", "line", "area", "waypoint", "structure"] = ""
    initial: Mapping[str, Property] = field(default_factory=dict, hash=False)
    alternatives: tuple[frozenset[str], ...] = ()
    height: str = ""
    variants: tuple[Mapping[str, Property], ...] = field(default=(), hash=False)
    device: str = ""
    action: str = ""

    def __post_init__(self) -> None:
        """Refuse what no map can show."""
        if self.colour and not _COLOUR.fullmatch(self.colour):
            raise ValueError(f"{self.colour!r}: a map symbol's colour is written #rrggbb")
        if len(self.icon) > _LONGEST_ICON:
            raise ValueError(f"{self.icon!r}: a map symbol's icon has two characters at most")


def has_symbol(metaclasses: Metaclasses, symbols: Mapping[Name, MapSymbol]) -> bool:
    """Return whether a plug-in provides a symbol for one of the metaclasses."""
    return most_specific(metaclasses, symbols) is not None


def symbol_of(metaclasses: Metaclasses, symbols: Mapping[Name, MapSymbol]) -> MapSymbol:
    """Return the symbol of the most specific metaclass that has one, by default a neutral one.

    >>> symbol_of((("urn:solar:1.0", "PanelGroup"),), {}).label
    'panel group'
    """
    name = most_specific(metaclasses, symbols)
    if name is not None:
        return symbols[name]
    own = metaclasses[0] if metaclasses else ("", "")
    return MapSymbol(own, words_of(own[1]), "", "")


def words_of(name: str) -> str:
    """Return the words of a metaclass's or feature's name in small letters; abbreviations stay.

    >>> words_of("gridResolution"), words_of("GPSMast")
    ('grid resolution', 'GPS mast')
    """
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)
    return " ".join(word if word.isupper() and len(word) > 1 else word.lower() for word in parted.split())


def _band(corridor: Part) -> tuple[Ring, ...]:
    """Return what lies between the two sides of a corridor."""
    from mmrs_core.geometry.polygons import band
    from mmrs_core.scene.attributes import number, positions

    line = [(east, north) for east, north, _ in positions(corridor, "points")]
    width = number(corridor, "width") or 0.0
    return tuple(ring for rings in band(line, width) for ring in rings) if width > 0.0 else ()


CORE_SYMBOLS = (
    MapSymbol((MISSION, "Fork"), "fork", "", "⋔"),
    MapSymbol((MISSION, "Join"), "join", "", "⋈"),
    MapSymbol(
        (CONTEXT, "Corridor"),
        "corridor",
        "",
        "⇄",
        ("width", "minHeight", "maxHeight", "use", "robotTypes"),
        _band,
    ),
    MapSymbol((CONTEXT, "Relay"), "relay", "", "⌁", ("range",), initial={"range": 1000.0}),
)
