"""What a path leads to in a model, or where it breaks and what would be there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from mmrs_core.languages.element import Element, Unknown, descendants, get, holds, path_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.query.conditions import known_features, meets
from mmrs_core.languages.query.path import Axis, Condition, PathStep, parse_path


class NothingFoundError(ValueError):
    """A good path that leads to nothing in this model."""


@dataclass(frozen=True, slots=True)
class Match:
    """What a path leads to.

    Attributes:
        value: an element, or the value of an attribute.
        owner: the element itself, or the one that has the value.
        tail: feature and place of a value within its owner; empty for an element.
        feature: that has the value; None for an element.
    """

    value: object
    owner: Element
    tail: str = ""
    feature: Feature | None = None

    @property
    def path(self) -> str:
        """Where it stands, as messages write it."""
        return f"{path_of(self.owner).rstrip('/')}/{self.tail}" if self.tail else path_of(self.owner)

    @property
    def key(self) -> tuple[int, str]:
        """What tells it from every other match."""
        return id(self.owner), self.tail


def find(roots: Sequence[Element], text: str) -> tuple[Match, ...]:
    """Return what a path leads to, in the order of the model.

    Raises:
        NothingFoundError: if nothing is there; says up to where something was.
        ValueError: if it is not a path, or follows a feature or names a class that there is not.
    """
    found = tuple(Match(root, root) for root in roots)
    for step in parse_path(text):
        found = tuple(_selected(step, _led(step, found, roots)))
        if not found:
            raise NothingFoundError(f"{step.text}: nothing there")
    return found


def _led(step: PathStep, found: Sequence[Match], roots: Sequence[Element]) -> list[tuple[Match, ...]]:
    """Return what a step leads to, a group for each place that it starts from."""
    if step.axis is Axis.ROOT:
        number = int(step.name)
        if number >= len(roots):
            raise NothingFoundError(f"{step.text}: the model has {_count(len(roots), 'root')}")
        return [(Match(roots[number], roots[number]),)]
    elements = [match.value for match in found if isinstance(match.value, Element)]
    if not elements:
        raise ValueError(f"{step.text}: nothing is below a value")
    if step.axis is Axis.BELOW:
        return [tuple(_below(step, elements, roots))]
    return _followed(step, elements)


def _followed(step: PathStep, elements: Sequence[Element]) -> list[tuple[Match, ...]]:
    known = known_features(elements)
    if step.name != "*" and step.name not in known:
        whose = type(elements[0]).__name__ if len({type(e) for e in elements}) == 1 else "any of them"
        hint = nearest(step.name, known)
        raise ValueError(f"{step.text}: no feature {step.name} of {whose}{hint and '; ' + hint}")
    return [tuple(_values(element, step.name)) for element in elements]


def _values(element: Element, name: str) -> Iterator[Match]:
    metaclass = type(element)._mmrs_metaclass
    for feature in metaclass.features if metaclass is not None else ():
        if name not in ("*", feature.name) or (name == "*" and not holds(element, feature)):
            continue
        value = get(element, feature.name)
        values = list(value) if feature.many and isinstance(value, list) else [value]
        for index, each in enumerate(values):
            if isinstance(each, Element):
                yield Match(each, each)
            elif each is not None:
                tail = f"{feature.name}{f'[{index}]' if feature.many else ''}"
                yield Match(each, element, tail, feature)


def _below(step: PathStep, elements: Sequence[Element], roots: Sequence[Element]) -> Iterator[Match]:
    everything = [element for root in roots for element in (root, *descendants(root))]
    prefix, _, name = step.name.rpartition(":")
    known = {kind.name for element in everything for kind in _kinds(element)}
    if name != "*" and name not in known:
        hint = nearest(name, known)
        message = f"{step.text}: no element of a class {name} in this model{hint and '; ' + hint}"
        raise NothingFoundError(message)
    inside: Iterable[Element] = (
        everything
        if set(map(id, roots)) <= set(map(id, elements))
        else (below for element in elements for below in descendants(element))
    )
    for element in {id(each): each for each in inside}.values():
        if name == "*" or any(_is_meant(kind, prefix, name) for kind in _kinds(element)):
            yield Match(element, element)


def _is_meant(kind: Metaclass, prefix: str, name: str) -> bool:
    languages = (kind.package.prefix, kind.package.name, kind.ns_uri) if kind.package else ()
    return kind.name == name and (not prefix or prefix in languages)


def _kinds(element: Element) -> Iterator[Metaclass]:
    """Yield the class of an element and all above it."""
    pending = [metaclass] if (metaclass := type(element)._mmrs_metaclass) is not None else []
    while pending:
        kind = pending.pop()
        yield kind
        pending.extend(kind.supertypes)


def _selected(step: PathStep, groups: Iterable[tuple[Match, ...]]) -> Iterator[Match]:
    kept = list(groups)
    for selector in step.selectors:
        kept = _at(step, selector, kept) if isinstance(selector, int) else _meeting(step, selector, kept)
    return iter({m.key: m for group in kept for m in group}.values())


def _at(step: PathStep, index: int, groups: list[tuple[Match, ...]]) -> list[tuple[Match, ...]]:
    long = [group for group in groups if -len(group) <= index < len(group)]
    if not long:
        most = max((len(group) for group in groups), default=0)
        there = f"there is {step.name}[0] to {step.name}[{most - 1}]" if most else f"{step.name} is empty"
        raise NothingFoundError(f"{step.text}: nothing there; {there}")
    return [(group[index],) for group in long]


def _meeting(
    step: PathStep, condition: Condition, groups: list[tuple[Match, ...]]
) -> list[tuple[Match, ...]]:
    elements = [match.value for group in groups for match in group if isinstance(match.value, Element)]
    if not elements and any(groups):
        raise ValueError(f"{step.text}: values have no features to ask for")
    try:
        meeting: Callable[[Element], bool] = meets(condition, elements)
        kept = [
            tuple(m for m in group if isinstance(m.value, Element) and meeting(m.value)) for group in groups
        ]
    except ValueError as fault:
        raise ValueError(f"{step.text}: {fault}") from None
    if elements and not any(kept):
        said = [
            str(get(e, condition.names[0]))
            for e in elements
            if len(condition.names) == 1 and _has(e, condition)
        ]
        hint = nearest(condition.value, said) if condition.sign == "=" else ""
        count = _count(len(elements), "element")
        raise NothingFoundError(f"{step.text}: none of {count} is so{hint and '; ' + hint}")
    return kept


def _has(element: Element, condition: Condition) -> bool:
    return not isinstance(element, Unknown) and condition.names[0] in known_features([element])


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
