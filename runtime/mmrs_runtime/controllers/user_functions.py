"""Functions of the user: conditions of choices, and locators of objects.

An object is found within what the behaviour was verified for.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import TypeAlias

from ..conditions import ANSWER_SECONDS, answers_at_once, is_standard, standard, undecided
from ..faults import FAILURES, OBJECT_NOT_FOUND, FaultError
from ..vehicle import Condition as Decided
from ..vehicle import VehicleState as Asked
from .geodesy import distance
from .state import State, in_words
from .vocabulary import Choose, GoTo, Look, Object, Place, Robot, Turn

Locator = Callable[[State, Place | None], Place]

LOOK_SECONDS = 0.05
"""Real seconds from one call of a guard to the next, while an object is looked for."""


def where_expected(state: State, expected: Place | None) -> Place:
    """Take an object to be at its expected position, without looking for it.

    Raises:
        LookupError: its expected position is unknown.
    """
    if expected is None:
        raise LookupError("its expected position is unknown")
    return expected


def not_looked_for(state: State, expected: Place | None) -> Place:
    """Find nothing: placeholder in objects.py for what finds an object.

    Raises:
        NotImplementedError: always; programs with objects that have this are not begun.
    """
    raise NotImplementedError("finding this object is not implemented yet")


class Finding:
    """An object that a function of the user looks for, in a thread of its own: it may take its time."""

    def __init__(self, target: Object, locators: Mapping[str, Locator], state: State) -> None:
        """Start the search for it."""
        self._target, self._until = target, time.monotonic() + ANSWER_SECONDS
        self._found: Place | BaseException | None = None
        self._done = threading.Event()
        name = f"locator of {target.description!r}"
        threading.Thread(target=self._look, args=(locators, state), name=name, daemon=True).start()

    def place(self, seconds: float = 0.0) -> Place | None:
        """Return where it is; None where the function has not answered within so many real seconds.

        Raises:
            FaultError: its locator does not find it, or not in time, or finds it farther from where it is
                expected than it may be: routes were checked for no other places.
        """
        description = self._target.description
        if not self._done.wait(seconds):
            if time.monotonic() < self._until:
                return None
            words = f"its locator has not answered for {ANSWER_SECONDS:g} s"
            raise FaultError(OBJECT_NOT_FOUND, f"object {description!r}: {words}")
        if isinstance(self._found, BaseException):
            raise FaultError(OBJECT_NOT_FOUND, f"object {description!r}: {self._found!r}") from self._found
        assert self._found is not None
        if self._target.expected is not None and self._target.tolerance is not None:
            away = distance(self._target.expected, self._found)
            if away > self._target.tolerance:
                words = f"{away:.1f} m from where it should be"
                raise FaultError(OBJECT_NOT_FOUND, f"object {description!r}: {words}")
        return self._found

    def _look(self, locators: Mapping[str, Locator], state: State) -> None:
        try:
            locator = locators[self._target.description]
            self._found = _somewhere(locator(state, self._target.expected), state.place)
        except FAILURES as error:
            self._found = error
        self._done.set()


def place_of(
    target: Place | Object,
    locators: Mapping[str, Locator],
    state: State,
    guard: Callable[[], None] = lambda: None,
) -> Place:
    """Return where a target is; `guard` is called while it is looked for, and may raise.

    Raises:
        FaultError: as of `Finding.place`.
    """
    if not isinstance(target, Object):
        return target
    finding = Finding(target, locators, state)
    while (found := finding.place(LOOK_SECONDS)) is None:
        guard()
    return found


def _somewhere(found: Place, here: Place) -> Place:
    """Return the position that a function of the user has found.

    Raises:
        ValueError: it is not a position, not in the frame of the robot's program, or not finite.
    """
    if not isfinite(distance(here, found)):
        raise ValueError(f"{found} is nowhere")
    return found


def look_at(
    look: Look | None, locators: Mapping[str, Locator], state: State, guard: Callable[[], None] = lambda: None
) -> Look | None:
    """Return a look whose target is a place; the rest as of `place_of`."""
    return None if look is None else replace(look, at=place_of(look.at, locators, state, guard))


Condition: TypeAlias = Callable[[State], "bool | None"]
"""Whether a condition holds, by what a robot knows; None while that cannot be said yet."""


@dataclass(frozen=True, slots=True)
class UserFunctions:
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
        known = ", ".join(map(repr, sorted(asked))) or "none"
        unasked = sorted(set(self.conditions) - asked)
        return [
            f"conditions.py: condition {name!r}: no Choice uses it; conditions in use: {known}"
            for name in unasked
        ]

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
