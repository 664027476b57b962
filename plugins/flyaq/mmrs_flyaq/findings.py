"""What a migration has to tell: every value that it did not carry over just as it was."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from mmrs_core.diagnostics import Place
from mmrs_flyaq.sources.nodes import Link, SourceNode, Text


class Category(Enum):
    """What happened to a value; in the order in which reports tell it."""

    LOST = "not carried over"
    DOUBTFUL = "doubtful"
    CHANGED = "changed in meaning"
    DEFAULTED = "defaulted"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing to tell.

    Attributes:
        category: what happened.
        reason: why, in words that are the same for all values it happened to.
        subject: the value or element, such as ``minVoltage 110.0 of Drone 'Heron'``.
        place: where it stands in the source.
    """

    category: Category
    reason: str
    subject: str
    place: Place


@dataclass(frozen=True, slots=True)
class Group:
    """What happened to several values for one reason."""

    category: Category
    reason: str
    findings: tuple[Finding, ...]


def grouped(findings: Iterable[Finding]) -> tuple[Group, ...]:
    """Return all findings by category and reason, each group where its first one was met."""
    groups: dict[tuple[Category, str], list[Finding]] = {}
    for finding in findings:
        groups.setdefault((finding.category, finding.reason), []).append(finding)
    order = list(Category)
    named = [Group(category, reason, tuple(found)) for (category, reason), found in groups.items()]
    return tuple(sorted(named, key=lambda group: order.index(group.category)))


class Record:
    """The findings of a migration, in the order in which they were met."""

    def __init__(self) -> None:
        self.findings: list[Finding] = []

    def value(
        self, category: Category, reason: str, node: SourceNode, feature: str, value: Text | None = None
    ) -> None:
        """Note what happens to a feature of an element, or to one of its values."""
        inner = node.nodes(feature) if value is None else ()
        plain = [each.text for each in node.values.get(feature, ()) if not isinstance(each, SourceNode)]
        said = value.text if value is not None else ", ".join(plain)
        for each in inner:
            self._add(category, reason, f"{feature} {_words(each)} of {node.called()}", each.place())
        if said or not inner:
            line = value.line if value is not None else _line(node, feature)
            self._add(
                category, reason, f"{feature}{said and ' ' + said} of {node.called()}", node.place(line)
            )

    def item(self, category: Category, reason: str, node: SourceNode) -> None:
        """Note what happens to one of the elements that a feature contains."""
        owner = node.parent
        around = f" of {owner.called()}" if owner is not None else ""
        self._add(category, reason, f"{node.feature} {_words(node)}{around}", node.place())

    def element(self, category: Category, reason: str, node: SourceNode) -> None:
        """Note what happens to a whole element; a lost one with its values."""
        content = _content(node) if category is Category.LOST else ""
        reported = content and f" ({content})"
        self._add(category, reason, f"{node.called()}{reported}", node.place())

    def _add(self, category: Category, reason: str, subject: str, place: Place) -> None:
        self.findings.append(Finding(category, reason, subject, place))


def _line(node: SourceNode, feature: str) -> int:
    return next((value.line for value in node.values.get(feature, ())), 0)


def _words(value: Text | Link | SourceNode) -> str:
    if not isinstance(value, SourceNode):
        return value.text
    content = _content(value)
    return f"{value.called()}{content and f' ({content})'}"


def _content(node: SourceNode) -> str:
    """Return all that an element holds, down to the last value."""
    parts = [
        f"{feature} {', '.join(_words(value) for value in values)}"
        for feature, values in node.values.items()
        if feature != "name" or len(values) > 1
    ]
    return "; ".join(parts)
