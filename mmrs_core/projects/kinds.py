"""What features can become: types of tasks and context elements, areas and homes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_core.contributions.symbols import MapSymbol, symbol_of
from mmrs_core.drawings.drawing import Geometry
from mmrs_core.errors import UsageError
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.uris import CONTEXT as CONTEXT
from mmrs_core.languages.uris import MISSION as MISSION

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.languages.metaclass import Feature

_BEGIN = "initialPosition"


@dataclass(frozen=True, slots=True)
class Kind:
    """Something that a feature can become.

    Attributes:
        name: as options and reports have it, such as ``obstacle`` or ``PhotoGridTask``.
        feature: of the mission or context, in which its elements are; empty for homes and for nothing.
        metaclass: of its elements; None for homes and for nothing.
        shapes: what holds its coordinates, by the geometry that it takes; empty where it is what it refers
            to that has a shape.
        symbol: with the values that it begins with.
    """

    name: str
    feature: str
    metaclass: Metaclass | None
    shapes: Mapping[Geometry, Feature]
    symbol: MapSymbol | None = None

    @property
    def surrounds(self) -> bool:
        """Return whether points and lines become areas around them."""
        return self.feature in ("forbiddenAreas", "emergencyAreas", "obstacles")

    @property
    def is_usual_for(self) -> str:
        """Return what usually becomes this, such as a shape; the types below it do not inherit that."""
        own = (
            self.symbol is not None
            and self.metaclass is not None
            and self.symbol.metaclass == self.metaclass.key
        )
        return self.symbol.usual_for if own and self.symbol is not None else ""


class ImportKinds:
    """All kinds, by name; the core's own have small letters, the types of plug-ins their names."""

    def __init__(self, contributions: Contributions) -> None:
        self._symbols = contributions.map_symbols
        languages = contributions.languages
        area, obstacle = languages.metaclass(CONTEXT, "Area"), languages.metaclass(CONTEXT, "Obstacle")
        whole = dict.fromkeys(Geometry, area.feature("shell"))
        self._own = {
            "forbidden": Kind("forbidden area", "forbiddenAreas", area, whole),
            "emergency": Kind("emergency area", "emergencyAreas", area, whole),
            "obstacle": Kind("obstacle", "obstacles", obstacle, whole),
            "home": Kind("home", "", None, {Geometry.POINT: area.feature("shell")}),
            "ignore": Kind("", "", None, whole),
        }
        self._types: dict[str, list[Kind]] = {}
        for package in languages.packages:
            for metaclass in package.metaclasses:
                if (kind := self._kind(metaclass)) is not None:
                    self._types.setdefault(metaclass.name, []).append(kind)
                    self._types.setdefault(f"{package.prefix}.{metaclass.name}", []).append(kind)

    def own(self, name: str) -> Kind:
        """Return one of the core's own kinds."""
        return self._own[name]

    def named(self, name: str) -> Kind:
        """Return the kind of that name.

        Raises:
            UsageError: if there is none, or two types of different languages have the name.
        """
        found = [self._own[name]] if name in self._own else self._types.get(name, [])
        if len(found) == 1:
            return found[0]
        if found:
            prefixed = (key for key, kinds in self._types.items() if "." in key and kinds[0] in found)
            raise UsageError(f"{name}: several types have this name; write {' or '.join(sorted(prefixed))}")
        guess = nearest(name, (*self._own, *self._types))
        words = guess or f"there are {', '.join((*self._own, 'task', *self._short_names()))}"
        raise UsageError(
            f"{name}: neither a type of tasks or context elements nor one of the usual words; {words}"
        )

    def stated(self, name: str) -> Kind | None:
        """Return the type that a drawing states; None if it is not installed, or two are."""
        found = self._types.get(name, [])
        return found[0] if len(found) == 1 else None

    def tasks(self) -> tuple[Kind, ...]:
        """Return the types of tasks with shapes, by name."""
        found = (kind for name in self._short_names() for kind in self._types[name])
        return tuple(kind for kind in found if kind.feature == "tasks" and kind.shapes)

    def usual(self, geometry: Geometry, *, waypoint: bool = False, structure: bool = False) -> Kind | str:
        """Return what features of a geometry usually become, or why that is not known."""
        wanted = "waypoint" if waypoint and geometry is Geometry.POINT else geometry.value
        wanted = "structure" if structure else wanted
        kinds = [
            kind for name in self._short_names() for kind in self._types[name] if kind.is_usual_for == wanted
        ]
        if not kinds and wanted == "waypoint":
            return self.usual(geometry)
        if len(kinds) == 1:
            return kinds[0]
        if kinds:
            return f"it could become {' or '.join(sorted(kind.name for kind in kinds))}"
        return f"no plug-in has a usual task for {wanted}s"

    def _short_names(self) -> Iterator[str]:
        return (name for name in sorted(self._types) if "." not in name)

    def _kind(self, metaclass: Metaclass) -> Kind | None:
        if metaclass.abstract or metaclass.is_kind(MISSION, "ControlTask"):
            return None
        if metaclass.is_kind(MISSION, "Task"):
            feature = "tasks"
        elif metaclass.is_kind(CONTEXT, "ContextElement"):
            feature = "elements"
        elif metaclass.key == (CONTEXT, "Corridor"):
            feature = "corridors"
        else:
            return None
        shapes = _shapes(metaclass.features)
        if not shapes and not (feature == "tasks" and any(map(refers, metaclass.features))):
            return None
        return Kind(metaclass.name, feature, metaclass, shapes, symbol_of(metaclass.ancestry, self._symbols))


def refers(feature: Feature) -> bool:
    """Return whether a feature leads to elements elsewhere."""
    return feature.is_reference and not feature.containment and not feature.is_container


def _shapes(features: Sequence[Feature]) -> dict[Geometry, Feature]:
    """Return what holds the coordinates of elements, by the geometry that it takes.

    An area is in a list called shell, a line in another list, a point alone, or in a list that may have one.
    """
    found: dict[Geometry, Feature] = {}
    for feature in features:
        kind = feature.type
        if not feature.containment or feature.name == _BEGIN or not isinstance(kind, Metaclass):
            continue
        if not kind.is_kind(MISSION, "Coordinate"):
            continue
        if not feature.many:
            found[Geometry.POINT] = feature
        elif feature.name == "shell":
            found[Geometry.AREA] = feature
        else:
            found.setdefault(Geometry.LINE, feature)
            if feature.lower <= 1 and not any(each.name == _BEGIN for each in features):
                found.setdefault(Geometry.POINT, feature)
    return found
