"""The options of the backends can and can-sim, as in ``--backend-option KEY=VALUE``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import TypeVar

from auv_vessel.api import FIRST_SIGN
from auv_vessel.body.surroundings import Surroundings, from_json
from mmrs_core.errors import UnreadableError, UnsupportedError

Options = TypeVar("Options")


@dataclass(frozen=True, slots=True)
class Rehearsing:
    """How vehicles are simulated.

    Attributes:
        seed: of instruments' noise and bias.
        noise: whether there is any.
        current: of the water, metres per second to the north and to the east; None: as the surroundings, or
            the context, say.
        bottom: depth of the bottom, metres; 0: a little below the deepest place of the program.
        surroundings: of the vehicles; they define how deep the bottom is, and whether there is
            noise. None: nothing but water.
        start: metres north and east of its home, as reported, at which the vehicle is put into the water.
        heading: of the vehicle at first, degrees.
        objects: ``expected`` takes objects to be where they are expected; ``seen`` looks for them as
            eyes that never err, ``cameras`` in pictures of the simulated water.
        clearance: metres ahead within which sonar must see nothing; 0: it may.
    """

    seed: int = 0
    noise: bool = True
    current: tuple[float, float] | None = None
    bottom: float = 0.0
    surroundings: Surroundings | None = None
    start: tuple[float, float] = (0.0, 0.0)
    heading: float = 0.0
    objects: str = ""
    clearance: float = 0.0


@dataclass(frozen=True, slots=True)
class Connecting:
    """How vehicles are reached.

    Attributes:
        interface: of python-can. channel: of it, where ``--connect`` says none.
        bit_rate: for adapters that need it; 0: default.
        patience: real seconds to wait for a vehicle's first sign.
        clock: ``real``, or ``bus``: as a simulated vehicle tells it; empty: by the speed-up of the run.
        objects: ``expected`` takes objects to be where they are expected.
        detections: UDP port on which the detections of cameras are received; 0: none.
        clearance: metres ahead within which sonar must see nothing; 0: it may.
        home_tolerance: metres that a vehicle may be from its home at first.
        inject: faults to inject.
    """

    interface: str = "socketcand"
    channel: str = ""
    bit_rate: int = 0
    patience: float = FIRST_SIGN
    clock: str = ""
    objects: str = ""
    detections: int = 0
    clearance: float = 0.0
    home_tolerance: float = field(default=20.0)
    inject: str = ""


def rehearsing(given: Mapping[str, str]) -> Rehearsing:
    """Return the options of the backend can-sim.

    Raises:
        UnsupportedError: if there is no such option, or its value makes no sense.
    """
    return _read(Rehearsing, "can-sim", given)


def connecting(given: Mapping[str, str]) -> Connecting:
    """Return the options of the backend can.

    Raises:
        UnsupportedError: if there is no such option, or its value makes no sense.
    """
    return _read(Connecting, "can", given)


def _read(options: Callable[..., Options], backend: str, given: Mapping[str, str]) -> Options:
    known = {name.replace("_", "-"): name for name in options.__dataclass_fields__}  # type: ignore[attr-defined]
    values: dict[str, object] = {}
    for key, text in given.items():
        if key not in known:
            names = ", ".join(sorted(known))
            raise UnsupportedError(
                f"option '{key}': backend '{backend}' has none of that name; it has {names}"
            )
        try:
            values[known[key]] = _VALUES.get(key, _number)(text)
        except ValueError as error:
            raise UnsupportedError(f"option '{key}': {error}") from error
    return options(**values)


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = float("nan")
    if not isfinite(number) or number < 0.0:
        raise ValueError(f"{text} is not a number from 0 on")
    return number


def _whole(text: str) -> int:
    if not text.isdecimal() or len(text) > 99:
        raise ValueError(f"{text} is not a whole number from 0 on")
    return int(text)


def pair(text: str) -> tuple[float, float]:
    """Return two numbers that a comma parts, north and east.

    Raises:
        ValueError: they are not.
    """
    try:
        north, east = (float(each) for each in text.split(","))
    except ValueError:
        raise ValueError(f"{text} is not NORTH,EAST") from None
    if not (isfinite(north) and isfinite(east)):
        raise ValueError(f"{text} is not NORTH,EAST")
    return north, east


def _switch(text: str) -> bool:
    if text not in ("yes", "no"):
        raise ValueError(f"{text} is neither yes nor no")
    return text == "yes"


def _one_of(*words: str) -> Callable[[str], str]:
    def read(text: str) -> str:
        if text not in words:
            raise ValueError(f"{text} is none of {', '.join(words)}")
        return text

    return read


def _surroundings(text: str) -> Surroundings:
    path = Path(text)
    try:
        return from_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror or error}") from error


_VALUES: Mapping[str, Callable[[str], object]] = {
    "seed": _whole,
    "noise": _switch,
    "current": pair,
    "start": pair,
    "surroundings": _surroundings,
    "objects": _one_of("expected", "seen", "cameras"),
    "interface": str,
    "channel": str,
    "bit-rate": _whole,
    "clock": _one_of("real", "bus"),
    "detections": _whole,
    "inject": str,
}
