"""Loops over columns of numbers: compiled where that is worth it and numba is installed (extra `fast`).

Results are the same as without it. Such loops stand in modules of their own, as plain functions that call
each other.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any


def can_compile() -> bool:
    """Return whether numba is installed; to ask does not import it."""
    return find_spec("numba") is not None


@cache
def compiled(module: ModuleType, *allocating: str) -> Any:
    """Return the functions of a module as attributes: compiled when they are first called, kept on disk.

    The module itself keeps its own ones. The first call in an environment takes some ten seconds, the
    import of numba half a second.

    Args:
        module: of plain functions.
        allocating: names of those that make lists or arrays, or parts of some. In the others references to
            arrays are not counted, which takes most of the time of many short calls.
    """
    njit: Any = import_module("numba").njit
    names = dict(vars(module))
    for name, loop in vars(module).items():
        if isinstance(loop, FunctionType) and loop.__module__ == module.__name__:
            names[name] = njit(cache=True, _nrt=name in allocating)(
                FunctionType(loop.__code__, names, name, loop.__defaults__)
            )
    return SimpleNamespace(**{name: names[name] for name in vars(module)})
