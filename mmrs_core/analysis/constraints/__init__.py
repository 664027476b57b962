"""Constraints on models beyond their metamodels, and what runs them."""

from __future__ import annotations

from mmrs_core.analysis.constraints import (
    approaches,
    areas,
    blanks,
    branches,
    capabilities,
    coordinates,
    dependencies,
    distances,
    equipment,
    moves,
    names,
    places,
    ranges,
    robot_types,
    shapes,
    slots,
)
from mmrs_core.analysis.constraints.checking import check_behaviour, check_constraints, check_planned
from mmrs_core.contributions.constraints import Constraint

__all__ = ["CONSTRAINTS", "check_behaviour", "check_constraints", "check_planned"]

_THEMES = (
    names,
    blanks,
    ranges,
    coordinates,
    distances,
    dependencies,
    branches,
    capabilities,
    shapes,
    places,
    areas,
    robot_types,
    moves,
    slots,
    approaches,
    equipment,
)

CONSTRAINTS: tuple[Constraint, ...] = tuple(
    sorted((each for theme in _THEMES for each in theme.CONSTRAINTS), key=lambda each: each.code)
)
"""The constraints of the core, by code."""
