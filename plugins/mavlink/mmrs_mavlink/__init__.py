"""The driver of vehicles that speak MAVLink, on top of pymavlink: a companion computer needs no more of MMRS.

Read ``program.py`` first: the words that programs are written in. ``driver.py`` makes a robot's vehicle for
the engine of mmrs_runtime; ``driving/`` carries its orders out in a thread of its own, by the rules of
``steps/``; ``vehicles/`` says them to autopilots, by ``services/`` and ``links/`` of MAVLink. What plugs into
the core is in ``plugin/``.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import program
    from .driver import main
    from .program import *  # noqa: F403

    __all__ = ["main"]
    __all__ += program.__all__


def __getattr__(name: str) -> object:
    """Return a word of programs, or what runs them: to plan a mission, or to run it, a part is enough."""
    if name.startswith("_"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module("mmrs_mavlink.driver" if name == "main" else "mmrs_mavlink.program"), name)
    globals()[name] = found
    return found
