"""Texts that must be given, and are given empty: the metamodels take these for names as good as any."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, MISSION, ROBOT, finding
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.grounding.features import text
from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element, Unknown, descendants, is_set, metaclass_of
from mmrs_core.languages.metaclass import Feature
from mmrs_core.languages.modelset import ModelSet

MAY_BE_EMPTY = ("conditionIdentifier", "description", "value")
"""Features that nobody refers to, or that have a constraint of their own."""


def _empty(root: Element, models: ModelSet) -> Iterator[Finding]:
    for element in (root, *descendants(root)):
        for feature in () if isinstance(element, Unknown) else metaclass_of(element).features:
            if _names(feature) and is_set(element, feature.name) and not text(element, feature.name).strip():
                yield finding(element, f"{feature.name} is empty, but others go by it")


def _names(feature: Feature) -> bool:
    """Return whether a feature is a text that every element of the class has, and needs."""
    kind = feature.type
    one = feature.required and not feature.many
    return one and isinstance(kind, DataType) and kind.python is str and feature.name not in MAY_BE_EMPTY


_GIVE = "write a name or identifier with something to see"

CONSTRAINTS = (
    Constraint("MML013", "No required name of a mission is empty.", (MISSION, "Mission"), _empty, _GIVE),
    Constraint("RL028", "No required name of a robot type is empty.", (ROBOT, "Robot"), _empty, _GIVE),
    Constraint("BL051", "No required name of a behaviour is empty.", (BEHAVIOUR, "Behaviour"), _empty, _GIVE),
)
