"""Standard conditions of choices: their identifiers define what they ask.

``battery-below:0.3`` holds with less than that fraction of the battery left, ``wind-above:8`` in wind of
more metres per second, ``detected:NAME`` once the vehicle has reported that detection,
``found:NAME`` once that, or a robot that has notified this one since, has detected it, and
``answer:QUESTION`` if the operator answers yes. Where there is no figure to go by, or no answer yet,
they are undecided, and the robot waits.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Protocol, TypeAlias


class Facts(Protocol):
    """The input of standard conditions in all executions; None where unknown."""

    @property
    def charge(self) -> float | None:
        """Return the part of the battery that is left, 0 to 1."""
        ...

    @property
    def wind(self) -> float | None:
        """Return metres per second."""
        ...

    @property
    def detected(self) -> frozenset[str]:
        """Return the names of what the robot has detected so far."""
        ...

    @property
    def found(self) -> frozenset[str]:
        """Return the names of what it, or a robot that has notified it since, has detected."""
        ...

    @property
    def answers(self) -> Mapping[str, bool]:
        """Return what the operator has answered, by question, and no choice has used up."""
        ...


Standard: TypeAlias = Callable[[Facts], bool | None]
"""Whether a condition holds, by what a robot knows; None while that cannot be said yet."""

BATTERY, WIND, DETECTED, FOUND, ANSWER = "battery-below", "wind-above", "detected", "found", "answer"


def standard(identifier: str) -> Standard:
    """Return the standard condition that an identifier asks for.

    Raises:
        ValueError: it asks for none.
    """
    word, _, rest = identifier.partition(":")
    if not is_standard(identifier):
        raise ValueError(f"{identifier!r}: no standard condition; there are {', '.join(_MAKE)}")
    return _MAKE[word](rest)


def answers_at_once(condition: Callable[..., object]) -> bool:
    """Return whether a function is one that `standard` returns, and so never blocks."""
    return condition.__module__ == __name__


def is_standard(identifier: str) -> bool:
    """Return whether an identifier asks for a standard condition.

    >>> [name for name in ("wind-above:8", "wind-above:gale", "calm") if is_standard(name)]
    ['wind-above:8']
    """
    word, _, rest = identifier.partition(":")
    return word in _MAKE and bool(rest) and (word not in (BATTERY, WIND) or _is_number(rest))


ANSWER_SECONDS = 10.0
"""Real seconds that a function of the user has to decide a condition, or to locate an object."""


def truth(found: object) -> bool:
    """Return what a function of the user's has decided.

    Raises:
        TypeError: it is neither True nor False, nor equal to one of them.

    >>> truth(1), truth(0.0)
    (True, False)
    """
    if found in (True, False):
        return bool(found)
    raise TypeError(f"{found!r} is neither True nor False")


def undecided(known: Facts) -> bool | None:
    """Decide nothing: placeholder in conditions.py for what decides a choice.

    Raises:
        NotImplementedError: always; programs whose choices have this are not begun.
    """
    raise NotImplementedError("this condition is not implemented yet")


def awaiting(identifier: str) -> str:
    """Return what a robot does that cannot decide a condition yet, as printed.

    >>> awaiting("answer:continue?"), awaiting("wind-above:8")
    ("waits for an answer to 'continue?'", "waits until 'wind-above:8' is known")
    """
    question = question_of(identifier)
    return f"waits for an answer to {question!r}" if question else f"waits until {identifier!r} is known"


def question_of(identifier: str) -> str:
    """Return a condition's question to the operator; empty where it has none."""
    word, _, rest = identifier.partition(":")
    return rest if word == ANSWER else ""


def _battery(limit: str) -> Standard:
    return lambda known: None if known.charge is None else known.charge < float(limit)


def _wind(limit: str) -> Standard:
    return lambda known: None if known.wind is None else known.wind > float(limit)


def _detected(name: str) -> Standard:
    return lambda known: name in known.detected


def _found(name: str) -> Standard:
    return lambda known: name in known.found


def _answer(question: str) -> Standard:
    return lambda known: known.answers.get(question)


def _is_number(text: str) -> bool:
    try:
        return isfinite(float(text))
    except ValueError:
        return False


_MAKE: Mapping[str, Callable[[str], Standard]] = {
    BATTERY: _battery,
    WIND: _wind,
    DETECTED: _detected,
    FOUND: _found,
    ANSWER: _answer,
}
