"""The robot types that a migrated model may name, and what their devices can do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from shlex import quote

from mmrs_core.behaviour.travel import SHARE_OF_LARGEST_SPEED
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import Element


@dataclass(frozen=True, slots=True)
class Speeds:
    """Speeds of a robot, in metres per second.

    Attributes:
        slowest, fastest: that its type has.
        usual: by its travel mode.
        acceleration: the largest, in metres per second squared; None where unknown.
    """

    slowest: float
    fastest: float
    usual: float
    acceleration: float | None = None

    def around(self, radius: float) -> float:
        """Return the speed on a circle: the usual one, or the one that the largest acceleration allows."""
        return min(self.usual, self.fastest_around(radius))

    def fastest_around(self, radius: float) -> float:
        """Return the largest speed on a circle: the robot's, or the one that its acceleration allows."""
        if self.acceleration is None:
            return self.fastest
        return min(self.fastest, sqrt(max(0.0, self.acceleration) * radius))


class RobotTypes:
    """Robot types by name.

    Attributes:
        known: the types themselves.
        named: what names of the source stand for.
        beside: whether models are read where they are, beside the robot types, and none is written.
    """

    def __init__(
        self, known: Mapping[str, Element], named: Mapping[str, str], *, beside: bool = False
    ) -> None:
        self.known = dict(known)
        self.named = dict(named)
        self.beside = beside

    def resolved(self, name: str, otherwise: str) -> tuple[str, str]:
        """Return the name of a type, and what to report about it; empty if nothing.

        Args:
            otherwise: the type that stands in for one that is not known; empty: none does.
        """
        if name in self.named and name != self.named[name]:
            taken = self.named[name]
            reported = f"the robot type {name!r} is taken for {taken!r}"
            unknown = f"{reported}, and no such type is known: {self.how(taken)}"
            return taken, reported if taken in self.known else unknown
        if name in self.known:
            return name, ""
        unknown, option = f"no robot type {name!r} is known", f"--type {quote(f'{name}=NAME')}"
        option = f"'mmrs migrate {option}'" if self.beside else option
        if otherwise in self.known:
            return (otherwise, f"{unknown}; {otherwise!r} stands in for it: state its type by {option}")
        return name, f"{unknown}: {self.how(name)}, or state its type by {option}"

    def how(self, name: str) -> str:
        """Return how a robot type of a name becomes known."""
        if self.beside:
            return f"give the file that describes it by --robots, or as robots/{name}.xmi"
        return f"migrate the file that describes it, too, or write robots/{name}.xmi"

    def speeds(self, robot: bl.Robot) -> Speeds | None:
        """Return the speeds of a robot by its type and travel mode; None where they are not known."""
        robot_type = self.known.get(robot.typeName or "")
        capability = next(iter(children(robot_type, "movementCapabilities")), None)
        speed = child(capability, "speed") if capability is not None else None
        fastest = number(speed, "max") if speed is not None else None
        if capability is None or speed is None or fastest is None:
            return None
        share = SHARE_OF_LARGEST_SPEED.get(robot.travelMode or "", 1.0)
        slowest = number(speed, "min") or 0.0
        return Speeds(slowest, fastest, max(slowest, share * fastest), number(capability, "maxAcceleration"))

    def device_for(self, type_name: str, action: str) -> str:
        """Return the id of the only device of a type that supports an action, or an empty text."""
        robot_type = self.known.get(type_name)
        devices = children(robot_type, "devices") if robot_type is not None else ()
        found = [
            text(device, "id")
            for device in devices
            if any(text(each, "name") == action for each in children(device, "supportedActions"))
        ]
        return found[0] if len(found) == 1 else ""
