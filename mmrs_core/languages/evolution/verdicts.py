"""What a change of a metamodel means for the models of the older version."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Verdict(Enum):
    """Whether older models still load."""

    COMPATIBLE = "compatible"
    MEANING = "changed meaning"
    INCOMPATIBLE = "incompatible"


@dataclass(frozen=True, slots=True)
class Difference:
    """One change of a metamodel.

    Attributes:
        sort: added, removed or changed.
        what: the class, ``Class.feature`` or ``Enumeration.literal``.
        verdict: whether older models load as before.
        words: what is different.
        reason: why older models do not load, or mean something else; may be empty where they do.
    """

    sort: str
    what: str
    verdict: Verdict
    words: str
    reason: str = ""


def changed(what: str, words: str, verdict: Verdict = Verdict.COMPATIBLE, reason: str = "") -> Difference:
    """Return a change of something that both versions have."""
    return Difference("changed", what, verdict, words, reason)


def refused(what: str, words: str, reason: str) -> Difference:
    """Return a change by which older models do not load any more."""
    return Difference("changed", what, Verdict.INCOMPATIBLE, words, reason)
