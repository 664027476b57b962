"""What can only be done once every element of a model stands: references, and what hangs on them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mmrs_core.grounding.features import child, children
from mmrs_core.languages.element import (
    Element,
    container_of,
    containing_feature,
    label_of,
    metaclass_of,
    root_of,
)
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.circling import set_heading
from mmrs_flyaq.building.drafts import Draft, placed
from mmrs_flyaq.findings import Category, Record
from mmrs_flyaq.rules.mapping import Counterpart, Rule, Use
from mmrs_flyaq.rules.paths import FeaturePath, reach
from mmrs_flyaq.sources.nodes import Link, SourceNode, Text


class Linker:
    """Completes a draft."""

    def __init__(self, draft: Draft, registry: Registry, record: Record) -> None:
        self._draft = draft
        self._registry = registry
        self._record = record

    def complete(self) -> None:
        """Set all references, then what is made of them."""
        for node, feature, element, use in self._draft.later:
            if use.bearing is not None:
                set_heading(node, feature, element, use, self._draft, self._record)
                continue
            if any(not isinstance(value, Link) for value in node.values[feature]):
                self._record.value(Category.LOST, "holds more than references", node, feature)
            if use.counterpart is not None:
                self._counterparts(node, feature, element, use)
            else:
                self._refer(node, feature, element, use)
        for node, rule in self._draft.waits:
            self._wait(node, rule)

    # references

    def _refer(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        targets = self._targets(node, feature)
        if use.changed and targets:
            self._record.value(Category.CHANGED, use.changed, node, feature)
        self._set(node, feature, element, use.to, targets)

    def _set(
        self,
        node: SourceNode,
        feature: str,
        element: Element,
        paths: Iterable[FeaturePath],
        targets: list[Element],
    ) -> None:
        for path in paths:
            owner, target = reach(element, path)
            fitting = [each for each in targets if target.type.accepts(each)]
            if len(fitting) < len(targets):
                self._record.value(Category.LOST, f"leads to what {path} does not take", node, feature)
            if target.many:
                present = getattr(owner, target.attribute)
                present.extend(each for each in fitting if each not in present)
            elif fitting:
                setattr(owner, target.attribute, fitting[0])
            if len(fitting) > 1 and not target.many:
                self._record.value(Category.LOST, f"{path} refers to one only, the first", node, feature)

    def _targets(self, node: SourceNode, feature: str) -> list[Element]:
        return [found for link in node.links(feature) if (found := self._target(node, feature, link))]

    def _target(self, node: SourceNode, feature: str, link: Link) -> Element | None:
        if link.target is None:
            self._lost(node, feature, link, "leads to nothing in this file")
            return None
        target = self._draft.made.get(link.target)
        if target is None or root_of(target) not in self._draft.roots:
            self._lost(node, feature, link, f"leads to {link.target.called()}, which is not carried over")
            return None
        return target

    def _lost(self, node: SourceNode, feature: str, link: Link, reason: str) -> None:
        self._record.value(Category.LOST, reason, node, feature, Text(link.text, link.line))

    # the element of the same name, elsewhere

    def _counterparts(self, node: SourceNode, feature: str, element: Element, use: Use) -> None:
        other = use.counterpart
        assert other is not None  # asked before
        named = self._targets(node, feature)
        owners = self._targets(node, other.of) if other.of else self._owner(node, other.within)
        same = [
            found
            for each in named
            for owner in owners
            if (found := self._same_name(node, feature, each, owner, other)) is not None
        ]
        if use.changed and any(each not in named for each in same):
            self._record.value(Category.CHANGED, use.changed, node, feature)
        self._set(node, feature, element, use.to, same)

    def _owner(self, node: SourceNode, within: str) -> list[Element]:
        """Return the nearest element around a node that has a feature, as a list."""
        around = self._draft.around(node)
        return [each for each in around if within in metaclass_of(each).by_name][:1]

    def _same_name(
        self, node: SourceNode, feature: str, element: Element, owner: Element, other: Counterpart
    ) -> Element | None:
        name = label_of(element)
        kind = metaclass_of(owner).by_name.get(other.within)
        if kind is None or not kind.containment or not kind.type.accepts(element):
            reason = f"{type(owner).__name__} has no {type(element).__name__} of its own"
            self._record.value(Category.LOST, reason, node, feature)
            return None
        if container_of(element) is owner and containing_feature(element) is kind:
            return element
        found = next((each for each in children(owner, other.within) if label_of(each) == name), None)
        if found is None and other.make and "name" in metaclass_of(element).by_name:
            found = placed(self._registry.create(*metaclass_of(element).key, name=name), node)
            getattr(owner, kind.attribute).append(found)
            reason = f"{label_of(owner)!r} had no {type(found).__name__} of this name, so one is made for it"
            self._record.value(Category.DEFAULTED, reason, node, feature, Text(repr(name), node.line))
        elif found is None:
            reason = f"{label_of(owner)!r} has no {type(element).__name__} {name!r}"
            self._record.value(Category.LOST, reason, node, feature)
        return found

    # conditions of transitions

    def _wait(self, node: SourceNode, rule: Rule) -> None:
        wait = rule.wait
        assert wait is not None  # asked before
        slots = self._targets(node, wait.slot)
        move = self._draft.made.get(node.parent) if node.parent is not None else None
        robots = self._owner(node, wait.among)
        if not slots or not robots or move is None:
            self._record.element(Category.LOST, "waits for nothing that is carried over", node)
            return
        own = [
            found
            for slot in slots
            if (found := self._same_name(node, wait.slot, slot, robots[0], _own(slot))) is not None
        ]
        waiting = list(_transitions(robots[0], wait.among, wait.at.get(node.feature, ()), move))
        for transition in waiting:
            self._set(node, wait.slot, transition, (FeaturePath((), wait.add, wait.add),), own)
        if waiting:
            self._record.element(Category.CHANGED, rule.changed or f"becomes {wait.add} of transitions", node)
        else:
            self._record.element(Category.LOST, "no transition stands where it could wait", node)


def _own(element: Element) -> Counterpart:
    """Return how an element of the same name is looked for in the own owner, and made where it is missing."""
    feature = containing_feature(element)
    return Counterpart("", feature.name if feature is not None else "", make=True)


def _transitions(robot: Element, among: str, ends: tuple[str, ...], move: Element) -> Iterator[Element]:
    for transition in children(robot, among):
        known = [end for end in ends if end in metaclass_of(transition).by_name]
        if any(child(transition, end) is move for end in known):
            yield transition
