"""Quick fixes of the core, and what applies those of all plug-ins."""

from __future__ import annotations

from mmrs_core.analysis.fixes import figures, meanings, spelling
from mmrs_core.contributions.fixes import Fix

FIXES: tuple[Fix, ...] = tuple(
    sorted((*spelling.FIXES, *meanings.FIXES, *figures.FIXES), key=lambda each: each.code)
)
"""The fixes of the core, by code."""
