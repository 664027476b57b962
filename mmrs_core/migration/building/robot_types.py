"""The robot types that a migrated model may name, and what their devices can do."""

from __future__ import annotations

from collections.abc import Mapping
from shlex import quote

from mmrs_core.languages.element import Element
from mmrs_core.languages.grounding.values import children, text


class RobotTypes:
    """Robot types by name.

    Attributes:
        known: the types themselves.
        named: what names of the source stand for.
    """

    def __init__(self, known: Mapping[str, Element], named: Mapping[str, str]) -> None:
        self.known = dict(known)
        self.named = dict(named)

    def resolved(self, name: str, otherwise: str) -> tuple[str, str]:
        """Return the name of a type, and what has to be told about it: an empty text if nothing has.

        Args:
            otherwise: the type that stands in for one that is not known; empty: none does.
        """
        if name in self.named and name != self.named[name]:
            return self.named[name], f"the robot type {name!r} is taken for {self.named[name]!r}"
        if name in self.known:
            return name, ""
        unknown, option = f"no robot type {name!r} is known", quote(f"{name}=NAME")
        if otherwise in self.known:
            return (
                otherwise,
                f"{unknown}; {otherwise!r} stands in for it: say what it is by --type {option}",
            )
        return name, f"{unknown}: write robots/{name}.xmi, or say what it is by --type {option}"

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
