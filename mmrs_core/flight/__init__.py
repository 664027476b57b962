"""The runtime of generated controllers: readable, standalone, on top of pymavlink.

Read ``program.py`` first: the words that programs are written in. ``pilot.py`` carries a program
out, ``ardupilot.py`` says it in MAVLink. ``main.py`` runs all robots, ``session.py`` one of them
from the opening of its link to its end, and ``options.py`` is the command line.
"""

from .desk import Condition
from .main import main
from .objects import Locator, where_expected
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
    Turn,
)
from .vehicle import State

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
    "Turn",
    "main",
    "where_expected",
]
