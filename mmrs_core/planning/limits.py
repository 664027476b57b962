"""How much is planned, and up to where more than once; constraints need not import the planner for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mmrs_core.scene import Scene

MOST = 200_000
"""Actions at most that one area may take: more are taken for a mistake, and take too long to plan."""

_FEW_PAIRS = 100


def is_small(scene: Scene) -> bool:
    """Return whether a mission is planned so soon that it is worth planning it in other ways as well."""
    return len(scene.tasks) * len(scene.robots) <= _FEW_PAIRS
