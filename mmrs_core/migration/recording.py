"""Notes what happens to values while a model is built."""

from __future__ import annotations

from mmrs_core.migration.findings import Category, Finding
from mmrs_core.migration.sources.nodes import Link, SourceNode, Text


class Record:
    """The findings of a migration, in the order in which they were met."""

    def __init__(self) -> None:
        self.findings: list[Finding] = []

    def value(
        self, category: Category, reason: str, node: SourceNode, feature: str, value: Text | None = None
    ) -> None:
        """Note what happens to a feature of an element, or to one value of it."""
        said = (
            value.text
            if value is not None
            else ", ".join(_words(each) for each in node.values.get(feature, ()))
        )
        subject = f"{feature}{said and ' ' + said} of {node.called()}"
        line = value.line if value is not None else _line(node, feature)
        self.findings.append(Finding(category, reason, subject, node.place(line)))

    def element(self, category: Category, reason: str, node: SourceNode) -> None:
        """Note what happens to a whole element; its values are told with it where it is lost."""
        content = _content(node) if category is Category.LOST else ""
        told = content and f" ({content})"
        self.findings.append(Finding(category, reason, f"{node.called()}{told}", node.place()))


def _line(node: SourceNode, feature: str) -> int:
    return next((value.line for value in node.values.get(feature, ())), 0)


def _words(value: Text | Link | SourceNode) -> str:
    if not isinstance(value, SourceNode):
        return value.text
    content = _content(value, 1)
    return f"{value.called()}{content and f' ({content})'}"


def _content(node: SourceNode, depth: int = 0) -> str:
    """Return what an element holds; of the elements in it only what they are called, further down."""
    parts = [
        f"{feature} {', '.join(_words(value) if depth == 0 else _name(value) for value in values)}"
        for feature, values in node.values.items()
        if feature != "name"
    ]
    return "; ".join(parts)


def _name(value: Text | Link | SourceNode) -> str:
    return value.called() if isinstance(value, SourceNode) else value.text
