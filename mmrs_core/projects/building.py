"""Features as elements of a mission and its context."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Geometry, MapFeature, Role
from mmrs_core.grounding.features import child, children
from mmrs_core.languages.element import Element, descendants, is_kind, label_of, metaclass_of
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.naming import unreadable
from mmrs_core.projects.attributes import asked_values, drawn_values, missing, named_in, set_values
from mmrs_core.projects.choosing import Decision, quoted, shape_of
from mmrs_core.projects.kinds import MISSION, Kind, refers
from mmrs_core.projects.likeness import DrawnElements, differences
from mmrs_core.projects.placing import SHUT, Basis, Placing
from mmrs_core.projects.shapes import Floats, UnfitError

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry

LONGEST_NAME = 80


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


class Builder:
    """Makes elements, and puts them into a mission and its context."""

    def __init__(
        self, mission: Element, context: Element, registry: Registry, names: UniqueNames, basis: Basis
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
        self._basis = basis
        self._drawn = DrawnElements(mission, context)
        shut = [each for name in SHUT for each in children(context, name)]
        rings = [self._drawn.positions(each) for each in shut]
        closed = [np.array(ring, float) for ring in rings if len(ring) > 2 and (None, None) not in ring]
        self.placing = Placing(registry, basis, closed)

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
            found = self.placing.shape(feature, kind, attributes)
        except UnfitError as unfit:
            self.refuse_open(kind, feature.place, repr(feature.name[:LONGEST_NAME]), str(unfit), feature.name)
            return replace(told, reason=str(unfit))
        element, given, doubts = self._made(feature, decision, attributes)
        notes = [*decision.notes, *found.notes, *doubts]
        exported = feature.role is Role.TASK and feature.properties.get("type") == kind.name
        heights = self.placing.heights(element, kind, found, given, notes, usual=not exported)
        self.placing.place(element, kind, found, heights, notes)
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
        if kind.feature in SHUT:
            ways = f"--as {quoted(name)}=ignore leaves it out"
            self.faults[f"{place}: {kind.name} {what}: {reason}; {ways}"] = None

    def add_robot(self, robot: Element, position: tuple[float, float], feature: MapFeature | None) -> None:
        """Add a robot to the team; the home of the first one has the altitude of the origin."""
        team = child(self._roots["tasks"], "team")
        assert team is not None  # a mission that can be read, or a new one
        levels, up = self._basis.levels, 0.0
        if (
            feature is not None
            and feature.heights
            and (base := levels.above_origin(feature.reference)) is not None
        ):
            up = float(feature.heights[0][0]) + base
        home = self.placing.coordinate(*position, up)
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

    def _root(self, kind: Kind) -> Element:
        return self._roots.get(kind.feature, self._context)

    def _append(self, element: Element, kind: Kind, outer: Floats) -> str:
        """Add an element to its model; return its path there."""
        siblings = getattr(self._root(kind), kind.feature)
        siblings.append(element)
        path = f"/{kind.feature}[{len(siblings) - 1}]"
        if kind.feature == "tasks":
            self.tasks[path] = element
        if kind.feature in SHUT:
            self.placing.closed.append(outer)
        self.added.setdefault(kind.feature, []).append(element)
        return path


def _who(feature: MapFeature) -> str:
    return ": ".join(filter(None, (str(feature.place), repr(feature.name[:LONGEST_NAME]))))


def comment_of(feature: MapFeature) -> str:
    """Return where a feature stands, and its name, for a comment; its description if it stands in no file."""
    if not feature.place.file:
        return feature.description
    place = f"{Path(feature.place.file).name}, line {feature.place.line}" if feature.place.line else ""
    path = " / ".join((*feature.folders, feature.name)).strip(" /")
    return ": ".join(each for each in (place or Path(feature.place.file).name, path[:200]) if each)


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
