"""The options of the backends can and can-sim, as in ``--backend-option KEY=VALUE``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from auv_vessel.body.surroundings import Surroundings, from_json
from mmrs_auv.controllers.connected import Reach
from mmrs_core.contributions.backend_options import one_of, read_options, switch, whole
from mmrs_core.errors import UnreadableError


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
class Connecting(Reach):
    """How vehicles are reached; `channel` is that of robots for which ``--connect`` says none.

    Attributes:
        objects: ``expected`` takes objects to be where they are expected.
        detections: UDP port on which the detections of cameras are received; 0: none.
        inject: faults to inject.
    """

    objects: str = ""
    detections: int = 0
    inject: str = ""


def rehearsing(given: Mapping[str, str]) -> Rehearsing:
    """Return the options of the backend can-sim.

    Raises:
        UsageError: if there is no such option, or its value makes no sense.
    """
    return read_options(Rehearsing, "can-sim", given, _READERS)


def connecting(given: Mapping[str, str]) -> Connecting:
    """Return the options of the backend can.

    Raises:
        UsageError: if there is no such option, or its value makes no sense.
    """
    return read_options(Connecting, "can", given, _READERS)


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


def _surroundings(text: str) -> Surroundings:
    path = Path(text)
    try:
        return from_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror or error}") from error


_READERS: Mapping[str, Callable[[str], object]] = {
    "seed": whole,
    "noise": switch,
    "current": pair,
    "start": pair,
    "surroundings": _surroundings,
    "objects": one_of("expected", "seen", "cameras"),
    "interface": str,
    "channel": str,
    "bit-rate": whole,
    "clock": one_of("real", "bus"),
    "detections": whole,
    "inject": str,
}
