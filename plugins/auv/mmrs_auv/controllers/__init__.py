"""Controllers of vehicles on CAN buses: the words of their programs, and what runs these."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_auv.controllers.vocabulary import Operate
from mmrs_runtime.conditions import standard, undecided
from mmrs_runtime.controllers.state import State
from mmrs_runtime.controllers.user_functions import Locator, not_looked_for, where_expected
from mmrs_runtime.controllers.vocabulary import (
    Choose,
    Geographic,
    GoTo,
    Hold,
    Land,
    Local,
    Look,
    NoEffect,
    Notify,
    Object,
    Place,
    Policy,
    Recharge,
    Report,
    Robot,
    Skip,
    Start,
    Step,
    Stop,
    Then,
    Turn,
)

if TYPE_CHECKING:
    from mmrs_auv.controllers.driver import main
    from mmrs_runtime.controllers.user_functions import Condition

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
    "NoEffect",
    "Notify",
    "Object",
    "Operate",
    "Place",
    "Policy",
    "Recharge",
    "Report",
    "Robot",
    "Skip",
    "Start",
    "State",
    "Step",
    "Stop",
    "Then",
    "Turn",
    "main",
    "not_looked_for",
    "standard",
    "undecided",
    "where_expected",
]


def __getattr__(name: str) -> object:
    """Return what runs programs when it is asked for: to read one, its words are enough."""
    if name == "main":
        from mmrs_auv.controllers.driver import main

        return main
    if name == "Condition":
        from mmrs_runtime.controllers.user_functions import Condition

        return Condition
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
