"""What a robot's program says under a name: ways that several moves share, and commands of MAVLink."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from mmrs_core.generation.escaping import Call, Name
from mmrs_mavlink.plugin.program import RobotView

NameOf = Callable[[int], str]


def command_name(number: int) -> str:
    """Return the name of a MAVLink command, such as ``MAV_CMD_DO_SET_SERVO``; empty where it has none."""
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    commands: Mapping[int, Any] = mavlink.enums["MAV_CMD"]
    return "" if number == mavlink.MAV_CMD_ENUM_END or number not in commands else str(commands[number].name)


def with_names(view: RobotView, name_of: NameOf = lambda number: "") -> RobotView:
    """Return a robot whose shared escapes and commands are said by names, which it lists with their values.

    Args:
        view: of the robot.
        name_of: returns the name of a command's number; empty where it has none.
    """
    names: dict[str, object] = {}
    steps = tuple(replace(step, call=_commanded(step.call, name_of, names)) for step in view.steps)
    names = dict(sorted(names.items()))
    uses = Counter(way for _, way in dict(view.head).get("escapes", ()))  # type: ignore[attr-defined]
    shared = [way for way, count in uses.items() if count > 1]
    ways = {way: f"ESCAPE_{number}" for number, way in enumerate(shared, start=1)}
    names |= {name: way for way, name in ways.items()}

    def said(name: str, value: Any) -> object:
        if name != "escapes":
            return value
        return tuple((move, Name(ways[way]) if way in ways else way) for move, way in value)

    head = tuple((name, said(name, value)) for name, value in view.head)
    return replace(view, head=head, steps=steps, names=tuple(names.items()))


def _commanded(value: Any, name_of: NameOf, names: dict[str, object]) -> Any:
    """Return a value with names for the commands in it, which are noted with their numbers."""

    def named(number: int) -> object:
        if not (name := name_of(number)):
            return number
        names[name] = number
        return Name(name)

    if isinstance(value, tuple):
        return tuple(_commanded(each, name_of, names) for each in value)
    if not isinstance(value, Call):
        return value
    positional = _commanded(value.positional, name_of, names)
    further = {name: _commanded(each, name_of, names) for name, each in value.named}
    if value.function == "Operate":
        device, action, command, *rest = positional
        positional = (device, action, named(command), *rest)
        if "more" in further:
            further["more"] = tuple((named(number), parameters) for number, parameters in further["more"])
    return Call(value.function, positional, tuple(further.items()))
