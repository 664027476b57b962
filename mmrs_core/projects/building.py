"""Features as elements of a mission and its context."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Geometry, HeightReference, MapFeature, Role
from mmrs_core.grounding.features import child, children
from mmrs_core.languages.element import Element, descendants, is_kind, label_of, metaclass_of
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.naming import unreadable
from mmrs_core.projects.attributes import asked_values, decided, drawn_values, missing, named_in, set_values
from mmrs_core.projects.choosing import Decision, quoted, shape_of
from mmrs_core.projects.heights import Levels
from mmrs_core.projects.kinds import MISSION, Kind, refers
from mmrs_core.projects.likeness import DrawnElements, differences
from mmrs_core.projects.shapes import DECIMALS, DrawnShape, Floats, UnfitError, around, begin_of, shape

if TYPE_CHECKING:
    from pyproj import Transformer

    from mmrs_core.languages.registry import Registry

LONGEST_NAME = 80
_SHUT = ("forbiddenAreas", "obstacles")

RALLY_RADIUS = 10.0
"""Metres around a point that is to be an emergency area, of which clearances leave something."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one feature, or of something in a file that is none.

    Attributes:
        name: as drawn.
        became: such as ``obstacle``; empty: it was left out.
        called: name of the element.
        by: what decided.
        reason: why it was left out.
        path: of the element in its model.
        folders: that the feature is in, outermost first.
    """

    name: str
    place: Place
    shape: str
    became: str = ""
    called: str = ""
    by: str = ""
    reason: str = ""
    notes: tuple[str, ...] = ()
    path: str = ""
    folders: tuple[str, ...] = ()


class UniqueNames:
    """UniqueNames of elements, each used once."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = {name.casefold() for name in taken}

    def unique(self, name: str, otherwise: str) -> str:
        """Return a name that people can read, and no element has yet; numbered where it has to be."""
        clean = " ".join("".join(" " if unreadable(f"x{each}") else each for each in name).split())[
            :LONGEST_NAME
        ]
        wanted = clean if clean and not unreadable(clean) else otherwise
        found, number = wanted, 1
        while found.casefold() in self._taken:
            number += 1
            found = f"{wanted} {number}"
        self._taken.add(found.casefold())
        return found


@dataclass(frozen=True, slots=True)
class Basis:
    """What all elements of an import share.

    Attributes:
        levels: what heights count from.
        altitude: height above the origin of tasks that are drawn without one, metres.
        flies: whether a robot of the team does; otherwise such tasks are on the ground.
        tolerance: of simplified borders, metres.
        home: latitude and longitude of the first robot's home; None without robots.
        crs: of the coordinates of the mission, and of the context.
    """

    levels: Levels
    altitude: float
    flies: bool
    tolerance: float | None
    home: Floats | None
    crs: Mapping[str, str]


class Builder:
    """Makes elements, and puts them into a mission and its context."""

    def __init__(
        self, mission: Element, context: Element, registry: Registry, names: UniqueNames, around: Basis
    ) -> None:
        self.faults: dict[str, None] = {}
        self.comments: dict[Element, str] = {}
        self.added: dict[str, list[Element]] = {}
        self.tasks: dict[str, Element] = {}
        self._called: dict[str, str] = {}
        self._roots = {"tasks": mission}
        self._context = context
        self._registry = registry
        self._names = names
        self._around = around
        self._drawn = DrawnElements(mission, context)
        shut = [each for name in _SHUT for each in children(context, name)]
        rings = [self._drawn.positions(each) for each in shut]
        self._closed = [np.array(ring, float) for ring in rings if len(ring) > 2 and (None, None) not in ring]

    def build(self, feature: MapFeature, decision: Decision) -> Outcome:
        """Add the element of a feature; return what became of it."""
        kind = decision.kind
        told = Outcome(
            feature.name,
            feature.place,
            shape_of(feature).value,
            by=decision.by,
            notes=decision.notes,
            folders=feature.folders,
        )
        if kind.metaclass is None:
            return replace(told, reason=decision.reason)
        if not kind.shapes:
            return self._refer(feature, decision, told)
        attributes = dict(decision.attributes)
        try:
            found = self._shape(feature, kind, attributes)
        except UnfitError as unfit:
            self.refuse_open(kind, feature.place, repr(feature.name[:LONGEST_NAME]), str(unfit), feature.name)
            return replace(told, reason=str(unfit))
        element, given, doubts = self._made(feature, decision, attributes)
        notes = [*decision.notes, *found.notes, *doubts]
        exported = feature.role is Role.TASK and feature.properties.get("type") == kind.name
        heights = self._heights(element, kind, found, given, notes, usual=not exported)
        self._place(element, kind, found, heights, notes)
        for other in self._drawn.alike(element, feature.name, area=found.geometry is Geometry.AREA):
            called = label_of(other) or "an element without a name"
            # one drawing may have a shape twice, for different tasks
            twice = other not in self.comments or called == feature.name
            if metaclass_of(other) is kind.metaclass and twice:
                reason = self._already(
                    feature, kind, element, _stated(element, given, heights=found.heights is not None), other
                )
                return replace(told, reason=reason)
            notes.append(f"drawn as {called} is, too")
        self._drawn.add(element)
        lacking = [*self._point_to(element, named_in(feature, kind, attributes), notes)]
        if feature.role is Role.TASK:
            notes, lacking = notes + lacking, []
        lacking += missing(element, kind)
        self.faults.update(dict.fromkeys(f"{_who(feature)}: {fault}" for fault in lacking))
        name, path = self._add(element, feature, kind, given, found.rings[0])
        return replace(told, became=kind.name, called=name, notes=tuple(notes), path=path)

    def _refer(self, feature: MapFeature, decision: Decision, outcome: Outcome) -> Outcome:
        """Add an element that has no shape, but leads to those that have; what is drawn is not used."""
        kind = decision.kind
        element, given, notes = self._made(feature, decision, decision.attributes)
        lacking = [*self._point_to(element, named_in(feature, kind, decision.attributes), notes)]
        lacking = lacking or [*missing(element, kind)]
        if lacking and feature.role is Role.TASK:
            return replace(outcome, reason=f"{'; '.join(lacking)}; write the task in the model")
        self.faults.update(dict.fromkeys(f"{_who(feature)}: {fault}" for fault in lacking))
        there = [each for each in children(self._root(kind), kind.feature) if each not in self.comments]
        for other in (each for each in there if metaclass_of(each) is kind.metaclass):
            called, different = label_of(other), self._unlike(element, other, given)
            if not different:
                also = "" if called == feature.name else f": {called}"
                return replace(outcome, reason=f"the same is there already{also}")
            if called == feature.name:
                words = f"a {kind.name} of this name is there already, with {', '.join(different)}"
                outcome = replace(outcome, reason=f"{words}; change it there")
        if outcome.reason:
            return outcome
        name, path = self._add(element, feature, kind, given, np.empty((0, 2)))
        return replace(
            outcome, became=kind.name, called=name, notes=(*decision.notes, *notes), path=path, shape=""
        )

    def _unlike(self, element: Element, other: Element, given: Mapping[str, object]) -> list[str]:
        """Return what another element without a shape has instead of what is stated of an element."""
        led = (at for at in metaclass_of(element).features if refers(at))
        elsewhere = [at.name for at in led if getattr(element, at.attribute) != getattr(other, at.attribute)]
        return [
            *(f"another {name}" for name in elsewhere),
            *differences(element, other, _stated(element, given)),
        ]

    def _made(
        self, feature: MapFeature, decision: Decision, attributes: Mapping[str, tuple[str, ...]]
    ) -> tuple[Element, dict[str, object], list[str]]:
        """Return a new element, the values that are drawn or asked for, and what there is to note on them."""
        kind = decision.kind
        assert kind.metaclass is not None  # homes and what is left out are made otherwise
        element = self._registry.create(*kind.metaclass.key)
        given, notes = drawn_values(feature, kind, kind.metaclass, self._registry)
        asked, faults = asked_values(attributes, kind.metaclass)
        self.faults.update(dict.fromkeys(f"{decision.by}: {fault}" for fault in faults))
        given |= asked
        set_values(element, kind, given)
        return element, given, notes

    def _point_to(
        self, element: Element, named: Mapping[str, Sequence[str]], notes: list[str]
    ) -> Iterator[str]:
        """Let references lead to what has such a name, else to the only one there is; yield what fails."""
        for at in (each for each in metaclass_of(element).features if refers(each)):
            assert isinstance(at.type, Metaclass)  # references lead to elements
            roots = (*self._roots.values(), self._context)
            there = [each for root in roots for each in descendants(root) if is_kind(each, *at.type.key)]
            names = [self._called.get(name, name) for name in named.get(at.name, ())]
            found = [[each for each in there if label_of(each) == name] for name in names]
            wrong = next((k for k, each in enumerate(found) if len(each) != 1), None)
            if wrong is not None:
                known = ", ".join(dict.fromkeys(map(label_of, there)))
                many = "several have" if found[wrong] else f"there is {known or 'none'}, and none has"
                yield f"{at.name}: {many} the name {names[wrong]!r}"
            elif found:
                setattr(element, at.attribute, [each for (each,) in found] if at.many else found[-1][0])
            elif at.required and len(there) == 1:
                setattr(element, at.attribute, there if at.many else there[0])
                notes.append(f"{at.name} is {label_of(there[0])}, the only one")

    def _add(
        self, element: Element, feature: MapFeature, kind: Kind, given: Mapping[str, object], outer: Floats
    ) -> tuple[str, str]:
        """Add an element to its model; return its name and its path there."""
        wanted = given.get("name")
        label = kind.symbol.label if kind.symbol is not None else kind.name
        name = self._names.unique(wanted if isinstance(wanted, str) else feature.name, label)
        element.name = name  # type: ignore[attr-defined]  # tasks and what is in a context have one
        self._called[feature.name] = name
        self.comments[element] = comment_of(feature)
        return name, self._append(element, kind, outer)

    def _already(
        self, feature: MapFeature, kind: Kind, element: Element, stated: Mapping[str, object], other: Element
    ) -> str:
        """Return that an element is there already, and what differs; a fault if the drawn one is higher."""
        called = label_of(other) or "an element without a name"
        different = differences(element, other, stated)
        if not different:
            return f"the same is there already{'' if called == feature.name else f': {called}'}"
        reason = f"its shape is there already: {called}, with {', '.join(different)}; change it there"
        top, drawn = getattr(other, "maxHeight", None), stated.get("maxHeight")
        if isinstance(top, float) and isinstance(drawn, float) and drawn > top:
            self.refuse_open(kind, feature.place, repr(feature.name[:LONGEST_NAME]), reason, feature.name)
        return reason

    def refuse_open(self, kind: Kind, place: Place, what: str, reason: str, name: str) -> None:
        """Note the fault of something to keep clear of that robots would enter, since it is left out."""
        if kind.feature in _SHUT:
            ways = f"--as {quoted(name)}=ignore leaves it out"
            self.faults[f"{place}: {kind.name} {what}: {reason}; {ways}"] = None

    def add_robot(self, robot: Element, position: tuple[float, float], feature: MapFeature | None) -> None:
        """Add a robot to the team; the home of the first one has the altitude of the origin."""
        team = child(self._roots["tasks"], "team")
        assert team is not None  # a mission that can be read, or a new one
        levels, up = self._around.levels, 0.0
        if (
            feature is not None
            and feature.heights
            and (base := levels.above_origin(feature.reference)) is not None
        ):
            up = float(feature.heights[0][0]) + base
        home = self.coordinate(*position, up)
        if not up and levels.reference != "ORIGIN":
            home.altitude = levels.origin  # type: ignore[attr-defined]  # a coordinate of the Earth
        robot.home = home  # type: ignore[attr-defined]  # a robot
        team.robots.append(robot)  # type: ignore[attr-defined]  # a team
        self.added.setdefault("robots", []).append(robot)
        if feature is not None:
            self.comments[robot] = comment_of(feature)

    def add_order(self, before: Element, after: Element) -> None:
        """Let a task begin after another has ended."""
        dependency = self._registry.create(MISSION, "TaskDependency", from_=before, to=after)
        self._roots["tasks"].taskDependencies.append(dependency)  # type: ignore[attr-defined]  # a mission
        self.added.setdefault("taskDependencies", []).append(dependency)

    def coordinate(self, latitude: float, longitude: float, up: float = 0.0, of: str = "tasks") -> Element:
        """Return a coordinate in the crs of the mission, or of the context."""
        latitude, longitude = in_crs(latitude, longitude, self._around.crs[of])
        altitude = self._around.levels.altitude(up) if up else None
        return self._registry.create(
            MISSION,
            "GeoCoordinate",
            latitude=round(latitude, DECIMALS),
            longitude=round(longitude, DECIMALS),
            altitude=altitude,
        )

    def _root(self, kind: Kind) -> Element:
        return self._roots.get(kind.feature, self._context)

    def _append(self, element: Element, kind: Kind, outer: Floats) -> str:
        """Add an element to its model; return its path there."""
        siblings = getattr(self._root(kind), kind.feature)
        siblings.append(element)
        path = f"/{kind.feature}[{len(siblings) - 1}]"
        if kind.feature == "tasks":
            self.tasks[path] = element
        if kind.feature in _SHUT:
            self._closed.append(outer)
        self.added.setdefault(kind.feature, []).append(element)
        return path

    def _shape(self, feature: MapFeature, kind: Kind, attributes: dict[str, tuple[str, ...]]) -> DrawnShape:
        """Return the positions of the element; the attributes lose the radius around points and lines."""
        drawn = shape_of(feature)
        if not kind.surrounds or feature.geometry is Geometry.AREA:
            found = shape(
                feature,
                drawn if drawn in kind.shapes else feature.geometry,
                self._around.tolerance,
                covering=kind.feature in _SHUT,
            )
            if kind.surrounds and len(found.rings) > 1:
                if kind.feature == "emergencyAreas":
                    raise UnfitError("an emergency area cannot have holes: draw it without them")
                notes = (*found.notes, f"a {kind.name} has no holes: these are closed, too")
                return DrawnShape(found.geometry, found.rings[:1], found.heights, found.reference, notes)
            return found
        shape(feature, feature.geometry, None)  # is it on the Earth?
        texts = attributes.pop("radius", ()) or (str(feature.radius or feature.properties.get("radius", "")),)
        emergency = kind.feature == "emergencyAreas"
        if not texts[-1] and not emergency:
            word = "obstacle" if kind.name == "obstacle" else "forbidden"
            advice = f"--as {quoted(feature.name)}={word}:radius=METRES"
            raise UnfitError(f"a {feature.geometry.value} has no extent; {advice} gives it one")
        try:
            radius = float(texts[-1]) if texts[-1] else RALLY_RADIUS
        except ValueError:
            raise UnfitError(f"radius {texts[-1][:20]}: not a number of metres") from None
        ring = around(feature, radius, covering=not emergency)
        top = feature.heights[0].max().repeat(len(ring)) if feature.heights else None
        return DrawnShape(Geometry.AREA, (ring,), top, feature.reference, (f"{radius:g} m around it",))

    def _heights(
        self,
        element: Element,
        kind: Kind,
        found: DrawnShape,
        given: Mapping[str, object],
        notes: list[str],
        *,
        usual: bool,
    ) -> Floats | None:
        """Set the height of an element; return the heights of its coordinates, if they have any.

        Args:
            usual: whether it has the usual height where it has none.
        """
        ups = self._settled(found, notes)
        usual = usual or (ups is None and found.heights is not None and bool(found.heights.any()))
        if kind.feature == "obstacles":
            if ups is not None and "maxHeight" not in given:
                element.maxHeight = round(float(ups.max()), 3)  # type: ignore[attr-defined]  # obstacles have one
            if getattr(element, "maxHeight", None) is None:
                notes.append("without a height, it is closed at every height")
            return None
        if kind.feature != "tasks":
            if ups is not None and kind.surrounds:
                notes.append(
                    "it is closed at every height"
                    if kind.name == "forbidden area"
                    else "its height is left out"
                )
            return None if kind.surrounds else ups
        name = kind.symbol.height if kind.symbol is not None else ""
        height = self._around.altitude if self._around.flies and usual else 0.0
        settled = name in decided(kind, given) or (ups is None and not usual)
        optional = not name or settled or not metaclass_of(element).feature(name).required
        has_own = found.geometry is not Geometry.AREA
        writable = self._around.levels.altitude(height) is not None
        if has_own and ups is not None and optional and writable:
            return ups
        if name and not settled and getattr(element, name) is None:
            setattr(element, name, round(float(ups.max()), 3) if ups is not None else height)
        elif not name and has_own and (height or ups is not None):
            if writable:
                return np.full(len(found.rings[0]), height)
            notes.append("its height is left out: that of the origin is not known")
        return None

    def _settled(self, found: DrawnShape, notes: list[str]) -> Floats | None:
        """Return heights above the origin; None where there are none, or they are all on the ground."""
        if found.heights is None:
            return None
        base = self._around.levels.above_origin(found.reference)
        if base is None:
            if found.heights.any():
                words = f"heights above {found.reference.value} are left out"
                notes.append(f"{words}: that of the origin is not known")
            return None
        ups = found.heights + base
        on_ground = found.reference in (HeightReference.GROUND, HeightReference.HOME) and not ups.any()
        return None if on_ground or not np.isfinite(ups).all() else ups

    def _place(
        self, element: Element, kind: Kind, found: DrawnShape, ups: Floats | None, notes: list[str]
    ) -> None:
        metaclass = metaclass_of(element)
        at = kind.shapes[found.geometry]
        of = "tasks" if kind.feature == "tasks" else "context"
        outer = found.rings[0]
        made = [
            self.coordinate(float(latitude), float(longitude), 0.0 if ups is None else float(ups[number]), of)
            for number, (latitude, longitude) in enumerate(outer)
        ]
        if at.many and at.most > 0 and len(made) > at.most:
            notes.append(f"{kind.name} takes {at.most} positions, so only the first and the last are used")
            made = [made[0], made[-1]]
        setattr(element, at.attribute, made if at.many else made[0])
        if "initialPosition" in metaclass.by_name:
            first = begin_of(outer, self._around.home, self._closed) if found.geometry is Geometry.AREA else 0
            up = 0.0 if ups is None else float(ups[first])
            element.initialPosition = self.coordinate(float(outer[first][0]), float(outer[first][1]), up, of)  # type: ignore[attr-defined]
        if len(found.rings) > 1 and "holes" in metaclass.by_name:
            holes = metaclass.by_name["holes"]
            assert isinstance(holes.type, Metaclass)  # rings
            for ring in found.rings[1:]:
                points = [self.coordinate(float(each[0]), float(each[1]), 0.0, of) for each in ring]
                getattr(element, holes.attribute).append(
                    self._registry.create(*holes.type.key, points=points)
                )
        elif len(found.rings) > 1:
            notes.append(f"{kind.name} has no holes: these are left out")


def _who(feature: MapFeature) -> str:
    return ": ".join(filter(None, (str(feature.place), repr(feature.name[:LONGEST_NAME]))))


def comment_of(feature: MapFeature) -> str:
    """Return where a feature stands, and its name, for a comment; its description if it stands in no file."""
    if not feature.place.file:
        return feature.description
    place = f"{Path(feature.place.file).name}, line {feature.place.line}" if feature.place.line else ""
    path = " / ".join((*feature.folders, feature.name)).strip(" /")
    return ": ".join(each for each in (place or Path(feature.place.file).name, path[:200]) if each)


def in_crs(latitude: float, longitude: float, crs: str) -> tuple[float, float]:
    """Return a position of WGS84 in another crs."""
    if crs.casefold() in ("epsg:4326", "wgs84"):
        return latitude, longitude
    east, north = _transformer(crs).transform(longitude, latitude)
    return float(north), float(east)


@cache
def _transformer(crs: str) -> Transformer:
    from pyproj import Transformer

    return Transformer.from_crs("EPSG:4326", crs, always_xy=True)


def _stated(element: Element, given: Mapping[str, object], *, heights: bool = False) -> dict[str, object]:
    """Return the attributes of a new element that its drawing or the user states."""
    metaclass = metaclass_of(element)
    names = {
        name
        for name, value in given.items()
        if value is not None and name != "name" and not metaclass.feature(name).is_reference
    }
    if heights:
        names |= {"maxHeight", "altitude"} & metaclass.by_name.keys()
    stated = {metaclass.feature(name).attribute: None for name in sorted(names)}
    values = {name: getattr(element, name) for name in stated}
    return {name: value for name, value in values.items() if value is not None}
