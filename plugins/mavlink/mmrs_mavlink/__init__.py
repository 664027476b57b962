"""The runtime of generated controllers: readable, standalone, on top of pymavlink.

Read ``program.py`` first: the words that programs are written in. ``steps/`` carries programs out,
``vehicles/`` says it to vehicles, by ``services/`` and ``links/`` of MAVLink; ``injection/`` are faults
made on purpose. ``main.py`` runs all robots, ``session.py`` one of them from the opening of its link to
its end, and ``options.py`` is the command line. What needs no MAVLink is in the package mmrs_runtime: the
orders of people, what is written down, the slots of robots in many processes.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from mmrs_runtime.conditions import standard, undecided

from .program import (
    Choose,
    Geographic,
    GoTo,
    Hold,
    Land,
    Local,
    Look,
    Measure,
    NoEffect,
    Notify,
    Object,
    Operate,
    Place,
    Policy,
    Recharge,
    Report,
    Robot,
    Run,
    Skip,
    Start,
    Step,
    Stop,
    TakeOff,
    Then,
    Travel,
    Turn,
)

if TYPE_CHECKING:
    from .judgement import Condition
    from .main import main
    from .objects import Locator, not_looked_for, where_expected
    from .vehicles.vehicle import State

__all__ = [
    "Choose",
    "Condition",
    "Geographic",
    "GoTo",
    "Hold",
    "Land",
    "Local",
    "Locator",
    "Look",
    "Measure",
    "NoEffect",
    "Notify",
    "Object",
    "Operate",
    "Place",
    "Policy",
    "Recharge",
    "Report",
    "Robot",
    "Run",
    "Skip",
    "Start",
    "State",
    "Step",
    "Stop",
    "TakeOff",
    "Then",
    "Travel",
    "Turn",
    "main",
    "not_looked_for",
    "standard",
    "undecided",
    "where_expected",
]

_NEED_A_LINK = {
    "Condition": "judgement",
    "Locator": "objects",
    "State": "vehicles.vehicle",
    "main": "main",
    "not_looked_for": "objects",
    "where_expected": "objects",
}


def __getattr__(name: str) -> object:
    """Return what needs pymavlink when it is asked for: programs and the bus do without."""
    if name not in _NEED_A_LINK:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f".{_NEED_A_LINK[name]}", __name__), name)
    globals()[name] = found
    return found
