"""Modes of programs, by their names, and how a vehicle encodes one."""

from __future__ import annotations

from dataclasses import dataclass

GUIDED = "guided"
AUTO = "auto"
HOLD = "hold"
LAND = "land"
SURFACE = "surface"


@dataclass(frozen=True, slots=True)
class Mode:
    """A mode: its number in heartbeats, and the parameters of the command that requests it."""

    number: int
    params: tuple[float, ...]
