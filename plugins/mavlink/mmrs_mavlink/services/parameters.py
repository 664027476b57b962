"""Parameters of a vehicle: read, and written with what it says that they are afterwards."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import count

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link, Message

ROUNDS = 3
"""How often parameters are asked for that a vehicle may not have."""

MARKS = 16
"""How many numbers are used in turn for what is asked for last; every vehicle has more parameters."""

_marks = count()
"""Counts what was asked for last, in this process: an answer that comes late must answer nothing else."""

BY_NAME = -1
"""The number that stands for none, where a parameter is asked for by its name."""


def read(link: Link, names: Iterable[str]) -> dict[str, float]:
    """Return the values of parameters by name, without those that the vehicle does not tell.

    All are asked for at once, and behind them one by its number: vehicles answer in the order in which
    they are asked, so that nothing need be waited for once that one has come. A vehicle that answers
    none at all is not asked again.
    """
    wanted, found = list(names), dict[str, float]()
    with link.inbox("PARAM_VALUE") as inbox:
        for _ in link.attempts(ROUNDS):
            asked, number = link.clock.now(), next(_marks) % MARKS
            for name in (name for name in wanted if name not in found):
                _ask(link, name)
            _ask(link, "", number)

            def answered(last: int = number) -> bool:
                behind = False
                while inbox:
                    message = inbox.popleft()
                    found[message.param_id] = value_of(link, message)
                    behind = behind or (message.param_index == last and message.param_id not in wanted)
                return behind or all(name in found for name in wanted)

            link.wait(answered, link.patience)
            complete = all(name in found for name in wanted)
            if complete or not (found or link.silent_since(asked)):
                break
    return {name: found[name] for name in wanted if name in found}


def _ask(link: Link, name: str, number: int = BY_NAME) -> None:
    """Ask for a parameter by its name, or by its number."""
    link.send(mavlink.MAVLink_param_request_read_message(link.system, link.component, name.encode(), number))


def write(link: Link, name: str, value: float) -> bool:
    """Set a parameter; return whether the vehicle confirms the value.

    Args:
        link: to the vehicle.
        name: at most 16 letters.
        value: as people write it.
    """
    coded = link.profile.autopilot.encoded(name, value)
    with link.inbox("PARAM_VALUE") as inbox:
        for _ in link.attempts():
            link.send(mavlink.MAVLink_param_set_message(link.system, link.component, name.encode(), *coded))
            if link.wait(
                lambda: any(m.param_id == name and same(value_of(link, m), value) for m in tuple(inbox)),
                link.patience,
            ):
                return True
    return False


def value_of(link: Link, message: Message) -> float:
    """Return the value in a PARAM_VALUE, as people write it."""
    return link.profile.autopilot.decoded(message.param_value, message.param_type)


def same(a: float, b: float) -> bool:
    """Return whether two values are the same in single precision."""
    return abs(a - b) <= 1e-6 * max(1.0, abs(a), abs(b))
