"""Reads the options of backends, as in ``--backend-option KEY=VALUE``, into dataclasses."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from math import inf
from typing import Any, TypeVar

from mmrs_core.errors import UsageError

Options = TypeVar("Options")


def read_options(
    kind: type[Options], backend: str, given: Mapping[str, str], readers: Mapping[str, Callable[[str], Any]]
) -> Options:
    """Return the options of one robot; those that are not given have their defaults.

    Args:
        kind: a dataclass; options are called like its fields, with hyphens instead of underscores.
        backend: its name.
        given: texts by option.
        readers: return the value of an option's text, or raise ValueError; options without one are numbers
            of at least 0.

    Raises:
        UsageError: there is no such option, or its value makes no sense.
    """
    known = {each.name.replace("_", "-"): each.name for each in fields(kind)}  # type: ignore[arg-type]
    values: dict[str, object] = {}
    for key, text in given.items():
        if key not in known:
            names = ", ".join(sorted(known))
            raise UsageError(f"option '{key}': backend '{backend}' has none of that name; it has {names}")
        try:
            values[known[key]] = readers.get(key, number)(text)
        except ValueError as error:
            raise UsageError(f"option '{key}': {error}") from error
    return kind(**values)


def number(text: str) -> float:
    """Return a finite number of at least 0; otherwise raise ValueError."""
    try:
        found = float(text)
    except ValueError:
        found = inf
    if not 0.0 <= found < inf:
        raise ValueError(f"{text} is not a number from 0 on")
    return found


def positive(text: str) -> float:
    """Return a finite number above 0; otherwise raise ValueError."""
    if not (found := number(text)):
        raise ValueError(f"{text} is not a number above 0")
    return found


def whole(text: str) -> int:
    """Return a whole number of at least 0; otherwise raise ValueError."""
    if not text.isdecimal() or len(text) > 99:
        raise ValueError(f"{text} is not a whole number from 0 on")
    return int(text)


def count(text: str) -> int:
    """Return a whole number of at least 1; otherwise raise ValueError."""
    if not (found := whole(text)):
        raise ValueError(f"{text} is not a whole number from 1 on")
    return found


def switch(text: str) -> bool:
    """Return whether a text is ``yes``; raise ValueError where it is neither that nor ``no``."""
    return one_of("yes", "no")(text) == "yes"


def one_of(*words: str) -> Callable[[str], str]:
    """Return what returns a text that is one of some words, and raises ValueError for any other."""

    def read(text: str) -> str:
        if text not in words:
            raise ValueError(f"{text} is none of {', '.join(words)}")
        return text

    return read
