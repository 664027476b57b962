"""Loops over columns of numbers: compiled where numba is installed (extra `fast`), the same in any case."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

_njit: Callable[..., Any] | None
try:
    _njit = import_module("numba").njit
except ImportError:
    _njit = None

Loop = TypeVar("Loop", bound=Callable[..., object])


def compiled(loop: Loop) -> Loop:
    """Return a loop, compiled when it is first called and kept on disk, or as it is."""
    made: Loop = _njit(cache=True)(loop) if _njit else loop
    return made


def column(values: NDArray[Any]) -> Any:
    """Return values as loops read and write them fastest: an array, or a list where they are not compiled."""
    return np.ascontiguousarray(values) if _njit else values.tolist()
