"""Counts of examples that differ from those of hypothesis' profiles."""

from hypothesis import settings

FAST_MOST = 50
"""More examples of one test take too long for the fast profile."""


def many(full: int, fast: int | None = None) -> int:
    """Return how many examples a test draws: `full` if thorough, else `fast`.

    By default, that is a tenth of the full count, at most `FAST_MOST`.
    """
    if settings.get_current_profile_name() == "thorough":
        return full
    return min(full // 10, FAST_MOST) if fast is None else fast
