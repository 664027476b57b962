"""Counts of examples that differ from those of hypothesis' profiles."""

from __future__ import annotations

from hypothesis import settings

FAST_MOST = 100
"""More examples of one test take too long for the fast profile."""


def many(full: int) -> int:
    """Return how many examples a test draws: `full` if thorough, else a tenth, at most `FAST_MOST`."""
    return full if settings.get_current_profile_name() == "thorough" else min(full // 10, FAST_MOST)
