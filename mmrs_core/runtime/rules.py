"""What a robot goes by beside its program."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from mmrs_core.contributions.execution import Condition
from mmrs_core.scene import Policy


@dataclass(frozen=True, slots=True)
class Rules:
    """What a robot goes by beside its program.

    Attributes:
        conditions: by identifier.
        policies: of its type and kind, which go after the program's.
        suspends: whether a low battery only breaks the program off, to go on with a full one.
        reserve: part of the energy with which a program is not gone on with.
        live: whether robots are real ones: steps then tell only which fault it is, black boxes the reason.
        say: tells people what goes on.
    """

    conditions: Mapping[str, Condition]
    policies: tuple[Policy, ...]
    suspends: bool
    reserve: float = 0.0
    live: bool = False
    say: Callable[[str], None] = lambda words: None
