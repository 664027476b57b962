"""What a migration has to tell: every value that it did not carry over just as it was."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from mmrs_core.diagnostics import Place


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
