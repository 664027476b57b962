"""Constraints on models beyond their metamodels, and what runs them."""

from __future__ import annotations

from mmrs_core.analysis.constraints import (
    approaches,
    areas,
    branches,
    capabilities,
    clearances,
    coordinates,
    corridors,
    dependencies,
    distances,
    equipment,
    moves,
    names,
    ranges,
    robot_types,
    shapes,
)
from mmrs_core.analysis.constraints.checking import check_behaviour, check_constraints, check_planned
from mmrs_core.contributions.constraints import Constraint

__all__ = ["CONSTRAINTS", "check_behaviour", "check_constraints", "check_planned"]

_THEMES = (
    names,
    ranges,
    coordinates,
    distances,
    dependencies,
    branches,
    capabilities,
    shapes,
    clearances,
    areas,
    corridors,
    robot_types,
    moves,
    approaches,
    equipment,
)

CONSTRAINTS: tuple[Constraint, ...] = tuple(
    sorted((each for theme in _THEMES for each in theme.CONSTRAINTS), key=lambda each: each.code)
)
"""The constraints of the core, by code."""
