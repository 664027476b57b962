"""The driver of vehicles that speak MAVLink, on top of pymavlink: a companion computer needs no more of MMRS.

Read ``program.py`` first: the words that programs are written in. ``driver.py`` makes a robot's vehicle for
the engine of mmrs_runtime; ``driving/`` carries its orders out in a thread of its own, by the rules of
``steps/``; ``vehicles/`` says them to autopilots, by ``services/`` and ``links/`` of MAVLink. What plugs into
the core is in ``plugin/``.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mmrs_runtime.conditions import standard, undecided
    from mmrs_runtime.controllers.state import State
    from mmrs_runtime.controllers.user_functions import Condition, Locator, not_looked_for, where_expected

    from .driver import main
    from .program import (
        Charge,
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

__all__ = [
    "Charge",
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

_IN = {
    "Condition": "mmrs_runtime.controllers.user_functions",
    "Locator": "mmrs_runtime.controllers.user_functions",
    "State": "mmrs_runtime.controllers.state",
    "main": "mmrs_mavlink.driver",
    "not_looked_for": "mmrs_runtime.controllers.user_functions",
    "standard": "mmrs_runtime.conditions",
    "undecided": "mmrs_runtime.conditions",
    "where_expected": "mmrs_runtime.controllers.user_functions",
}


def __getattr__(name: str) -> object:
    """Return what is asked for: to plan a mission, or to run it, a part is enough."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(_IN.get(name, "mmrs_mavlink.program")), name)
    globals()[name] = found
    return found
