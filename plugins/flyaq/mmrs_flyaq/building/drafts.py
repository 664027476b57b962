"""Elements that are being built, and how their values are converted and copied."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TypeVar

from mmrs_core.languages.element import Element, held, metaclass_of
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.rules.mapping import Constant, Rule, Use
from mmrs_flyaq.rules.paths import FeaturePath, Keep, reach
from mmrs_flyaq.rules.values import parsed
from mmrs_flyaq.sources.nodes import SourceNode

Made = TypeVar("Made", bound=Element)


def placed(element: Made, node: SourceNode) -> Made:
    """Return an element, which counts from now on as standing where the node does that it is made of."""
    element._mmrs_line = node.line
    return element


@dataclass(slots=True, eq=False)
class Draft:
    """What is built so far, and what has to wait.

    Attributes:
        roots: the elements at its top.
        made: what each node became.
        later: the uses that have to wait until every element stands: (node, feature, element, use).
        waits: the nodes that become conditions of transitions, with their rules.
        rings: the nodes that become way points around a circle, with their rules.
        assumed: the texts that stand for what the source does not say and no feature gets as it is.
    """

    roots: list[Element] = field(default_factory=list)
    made: dict[SourceNode, Element] = field(default_factory=dict)
    later: list[tuple[SourceNode, str, Element, Use]] = field(default_factory=list)
    waits: list[tuple[SourceNode, Rule]] = field(default_factory=list)
    rings: list[tuple[SourceNode, Rule]] = field(default_factory=list)
    assumed: dict[tuple[SourceNode, str], str] = field(default_factory=dict)

    def around(self, node: SourceNode) -> Iterator[Element]:
        """Yield the elements made of the nodes around a node, nearest first."""
        above = node.parent
        while above is not None:
            if above in self.made:
                yield self.made[above]
            above = above.parent

    def outermost(self, node: SourceNode, element: Element) -> Element:
        """Return the root that the element made of a node belongs to, or will."""
        return [element, *self.around(node)][-1]

    def said(self, node: SourceNode, feature: str) -> str:
        """Return the first text that a feature holds, or what stands for it; empty if nothing does."""
        return node.text(feature) or self.assumed.get((node, feature), "")


def put(element: Element, path: FeaturePath, value: Constant, keep: Keep | None = None) -> None:
    """Set the feature at the end of a path.

    Args:
        keep: gives a place to what is made on the way and only referred to.

    Raises:
        ValueError: if the value is not of the feature's type; the message begins with the value. If what
            stands on the way is of a class without that feature.
    """
    owner, feature = reach(element, path, keep)
    found = parsed(feature, value)
    if feature.many:
        getattr(owner, feature.attribute).append(found)
    else:
        setattr(owner, feature.attribute, found)


def scaled(text: str, factor: float) -> str:
    """Return a number times a factor, as text.

    Raises:
        ValueError: if the text is not a number.

    >>> scaled("45", 60), scaled("0.5", 1.0)
    ('2700.0', '0.5')
    """
    return text if factor == 1.0 else repr(number_in(text) * factor)


def number_in(text: str) -> float:
    """Return the number that a text is.

    Raises:
        ValueError: if it is none.
    """
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{text!r}: not a number") from None


def copied(element: Element, registry: Registry) -> Element:
    """Return an element that says the same as another, with copies of what that one contains."""
    found = registry.create(*metaclass_of(element).key)
    for feature in metaclass_of(element).features:
        if feature.is_container or not feature.stored:
            continue
        values = [_value(each, feature.containment, registry) for each in held(element, feature)]
        if feature.many:
            getattr(found, feature.attribute).extend(values)
        elif values:
            setattr(found, feature.attribute, values[0])
    return found


def _value(value: object, contained: bool, registry: Registry) -> object:
    return copied(value, registry) if contained and isinstance(value, Element) else value
