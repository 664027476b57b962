"""What a robot works with, beside its program and its vehicle."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from mmrs_runtime.bus import Beginning
from mmrs_runtime.clock import Clock
from mmrs_runtime.questions import Questions
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.records.log import Log

from .judgement import Condition
from .objects import Locator
from .program import Place
from .slots import Slots

Say = Callable[[str], None]
Meet = Callable[[Callable[[str], None]], Beginning]


@dataclass(frozen=True, slots=True)
class Desk:
    """What a robot works with.

    Attributes:
        conditions: by identifier; locators: by description of the object.
        stop: set when the robot is to stop.
        say: tells people what goes on.
        questions: that the robot's choices ask people.
        meet: returns when all robots begin, or None where they do not wait for each other.
        recognise: makes sure that the vehicle is the robot's, before it is told anything; is given
            whether its motors may run, and where it may stand.
        abandon: set when not even heartbeats are to go on.
        dry: whether there is no vehicle.
    """

    clock: Clock
    slots: Slots
    log: Log
    box: BlackBox
    conditions: Mapping[str, Condition]
    locators: Mapping[str, Locator]
    stop: threading.Event
    say: Say
    questions: Questions = field(default_factory=Questions)
    meet: Meet | None = None
    recognise: Callable[[bool, Sequence[Place]], None] = lambda under_way, starts: None
    abandon: threading.Event = field(default_factory=threading.Event)
    dry: bool = False
