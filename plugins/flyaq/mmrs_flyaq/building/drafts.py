"""Elements that are being built, with the nodes that they are made of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TypeVar

from mmrs_core.languages.element import Element
from mmrs_flyaq.rules.mapping import Rule, Use
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
