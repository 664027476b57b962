"""A robot of a behaviour as a real program of the flight runtime, not as text of one.

Generated controllers hold the same program as source text; both are made from the same view.
"""

from __future__ import annotations

from typing import cast

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.escaping import Call
from mmrs_mavlink import program as words
from mmrs_mavlink.plugin.program import robot_view


def robot_of(robot: RobotProgram, input: TargetInput) -> words.Robot:
    """Return the program that a controller of that robot would carry out.

    Raises:
        UnsupportedError: degrees are needed, and the behaviour has none.
    """
    view = robot_view(robot, input)
    steps = tuple(step.call for step in view.steps)
    return cast(words.Robot, built(Call("Robot", (), (*view.head, ("steps", steps)))))


def built(value: object) -> object:
    """Return a value with every call in it made.

    >>> built((Call("Hold", (3.0,)), "as it is"))
    (Hold(seconds=3.0), 'as it is')
    """
    if isinstance(value, Call):
        word = getattr(words, value.function)
        return word(*map(built, value.positional), **{name: built(each) for name, each in value.named})
    return tuple(map(built, value)) if isinstance(value, tuple | list) else value
