"""What generated controllers are written in, and run by, whatever drives their vehicles.

`vocabulary` is that of programs, `driver` is what a driver of vehicles supplies, and `running` runs them from
the command line of `options`. Conditions and locators of the user are `user_functions`. What programs of all
vehicles import stands here, but for their `Robot`, to which drivers may add.
"""

from ..conditions import standard, undecided
from .state import State
from .user_functions import Condition, Locator, not_looked_for, where_expected
from .vocabulary import (
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
    Skip,
    Start,
    Step,
    Stop,
    Then,
    Turn,
)

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
    "Place",
    "Policy",
    "Recharge",
    "Report",
    "Skip",
    "Start",
    "State",
    "Step",
    "Stop",
    "Then",
    "Turn",
    "not_looked_for",
    "standard",
    "undecided",
    "where_expected",
]
