"""What only the user can say: when conditions hold, and where objects are."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from ..conditions import answers_at_once, is_standard, standard, undecided
from ..vehicle import Condition as Decided
from ..vehicle import VehicleState as Asked
from .objects import Locator, not_looked_for
from .state import State, in_words
from .words import Choose, GoTo, Object, Robot, Turn

Condition: TypeAlias = Callable[[State], "bool | None"]
"""Whether a condition holds, by what a robot knows; None while that cannot be said yet."""


@dataclass(frozen=True, slots=True)
class Judgement:
    """The user's functions: conditions by identifier, locators by description of the object.

    Attributes:
        seen: by robot, objects that its vehicle finds.
    """

    conditions: Mapping[str, Condition]
    locators: Mapping[str, Locator]
    seen: Mapping[str, Collection[str]] = field(default_factory=dict)

    def faults(self, robots: Sequence[Robot]) -> list[str]:
        """Return what is missing for these robots."""
        objects = {found for r in robots for found in _sought(r) if found not in self.seen.get(r.id, ())}
        return [
            *(fault for name in sorted(conditions_of(robots)) if (fault := self._undecided(name))),
            *self._unasked(robots),
            *(fault for name in sorted(objects) if (fault := self._not_found(name))),
        ]

    def decides(self, robots: Sequence[Robot]) -> dict[str, Decided]:
        """Return what decides each choice of these robots: the user's function, or a standard condition."""
        return {name: self._decides(name) for name in conditions_of(robots)}

    def _decides(self, name: str) -> Decided:
        own = self.conditions.get(name)
        return _Asked(name, _never, instant=own is None or answers_at_once(own), asks=own or standard(name))

    def _unasked(self, robots: Sequence[Robot]) -> list[str]:
        """Return the user's functions that no robot needs; none while other robots run elsewhere."""
        if {name for robot in robots for name in robot.fleet} - {robot.id for robot in robots}:
            return []
        asked = conditions_of(robots)
        known = ", ".join(map(repr, sorted(asked))) or "none at all"
        unasked = sorted(set(self.conditions) - asked)
        return [f"conditions.py: no choice asks for {name!r}; asked for: {known}" for name in unasked]

    def _undecided(self, name: str) -> str:
        if self.conditions.get(name) is undecided:
            return f"conditions.py: condition {name!r} is not implemented yet"
        if name in self.conditions or is_standard(name):
            return ""
        return f"conditions.py decides nothing for {name!r}"

    def _not_found(self, name: str) -> str:
        if self.locators.get(name) is not_looked_for:
            return f"objects.py: finding {name!r} is not implemented yet"
        return "" if name in self.locators else f"objects.py finds nothing for {name!r}"


@dataclass(frozen=True, slots=True)
class _Asked(Decided):
    """A condition that is asked with the state that the vehicle tells."""

    asks: Condition = field(kw_only=True)

    def asked(self, state: Asked) -> object:
        return self.asks(replace(in_words(state), found=state.found, answers=state.answers))


def _never(state: Asked) -> bool:
    """Stand for what `_Asked` asks."""
    raise NotImplementedError


def _sought(robot: Robot) -> set[str]:
    return {found for step in robot.steps for found in objects_of(step.movement)}


def conditions_of(robots: Sequence[Robot]) -> set[str]:
    """Return the identifiers of the conditions that the choices of robots have."""
    return {step.then.condition for robot in robots for step in robot.steps if isinstance(step.then, Choose)}


def objects_of(movement: object) -> list[str]:
    """Return the descriptions of the objects that a movement leads to or points at."""
    look = movement.look if isinstance(movement, GoTo | Turn) else None
    targets = [look.at if look else None, movement.at if isinstance(movement, GoTo) else None]
    return [target.description for target in targets if isinstance(target, Object)]
