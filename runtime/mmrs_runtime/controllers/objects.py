"""Finding objects: by functions of the user, within what the behaviour was verified for."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from math import isfinite

from ..conditions import ANSWER_SECONDS
from ..faults import FAILURES, OBJECT_NOT_FOUND, Fault
from .places import distance
from .state import State
from .words import Look, Object, Place

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
            Fault: its locator does not find it, or not in time, or finds it farther from where it is
                expected than it may be: routes were checked for no other places.
        """
        description = self._target.description
        if not self._done.wait(seconds):
            if time.monotonic() < self._until:
                return None
            words = f"its locator has not answered for {ANSWER_SECONDS:g} s"
            raise Fault(OBJECT_NOT_FOUND, f"object {description!r}: {words}")
        if isinstance(self._found, BaseException):
            raise Fault(OBJECT_NOT_FOUND, f"object {description!r}: {self._found!r}") from self._found
        assert self._found is not None
        if self._target.expected is not None and self._target.tolerance is not None:
            away = distance(self._target.expected, self._found)
            if away > self._target.tolerance:
                words = f"{away:.1f} m from where it should be"
                raise Fault(OBJECT_NOT_FOUND, f"object {description!r}: {words}")
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
        Fault: as of `Finding.place`.
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
    look: Look | None,
    locators: Mapping[str, Locator],
    state: State,
    guard: Callable[[], None] = lambda: None,
) -> Look | None:
    """Return a look whose target is a place; the rest as of `place_of`."""
    return None if look is None else replace(look, at=place_of(look.at, locators, state, guard))
