"""Words of behaviour files: variables, values and names that mean nothing else to the helm."""

from __future__ import annotations

from collections.abc import Sequence

from mmrs_core.generation.escaping import file_stems

DEPLOY, STEP, DONE = "DEPLOY", "MMRS_STEP", "MMRS_DONE"
MESSAGE = "NODE_MESSAGE_LOCAL"


def words_of(names: Sequence[str], before: str) -> dict[str, str]:
    """Return a word for each name: letters, digits and underscores, never a number, equal for none."""
    return {name: f"{before}{stem}" for name, stem in file_stems(names, hyphens=False).items()}


def variables_of(names: Sequence[str], before: str) -> dict[str, str]:
    """Return a variable for each name, in capital letters."""
    return {name: word.upper() for name, word in words_of(names, before).items()}


def text(value: object) -> str:
    """Return a value as files hold it: a number with three decimals at most, words as they are.

    Raises:
        ValueError: the helm would read something else.

    >>> text(2.5), text(-0.0), text("s_a")
    ('2.5', '0', 's_a')
    """
    if isinstance(value, float):
        return f"{round(value, 3) + 0.0:.3f}".rstrip("0").rstrip(".")
    if isinstance(value, int):
        return str(value)
    if not isinstance(value, str) or not value.isascii() or not value.isprintable():
        raise ValueError(f"{value!r} is not a value of a behaviour file")
    if "//" in value or set("{}") & set(value):
        raise ValueError(f"{value!r} is not a value of a behaviour file")
    return value
