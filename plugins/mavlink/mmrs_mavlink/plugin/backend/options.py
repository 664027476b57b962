"""The options of the backend mavlink, as in ``--backend-option KEY=VALUE``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from math import inf
from pathlib import Path

from mmrs_core.errors import UsageError
from mmrs_mavlink.options import SWITCHES


@dataclass(frozen=True, slots=True)
class LinkOptions:
    """How to communicate with vehicles.

    Attributes:
        patience: real seconds to wait for a vehicle's first message.
        acceptance: acceptance radius in metres; None: by the robot's travel mode.
        home_tolerance: metres that a vehicle may be from its home at first.
        tries: how often to send at most what is not answered.
        answer_seconds: how long to wait for an answer.
        item_seconds: how long to wait for an item of a mission that is read back.
        fence: whether forbidden areas are uploaded as a fence.
        device_check: whether a device that cannot do what is asked of it keeps a vehicle on the ground.
        battery_check: whether a battery that does not suffice for the first sortie does.
        try_devices: devices whose actions are carried out on the ground, before take-off, by their ids.
        objects: ``expected`` takes objects to be at their expected positions, without a search.
        signing_key: file of 32 bytes to sign with; empty: no signing.
        inject: faults to inject.
    """

    patience: float = 30.0
    acceptance: float | None = None
    home_tolerance: float = 20.0
    tries: int = 5
    answer_seconds: float = 1.5
    item_seconds: float = 0.25
    fence: bool = True
    device_check: bool = True
    battery_check: bool = True
    try_devices: frozenset[str] = frozenset()
    objects: str = ""
    signing_key: Path | None = None
    inject: str = ""


def link_options(given: Mapping[str, str]) -> LinkOptions:
    """Return the options by their keys, hyphens instead of underscores.

    Raises:
        UsageError: if there is no such option, or its value makes no sense.
    """
    known = {field.name.replace("_", "-"): field.name for field in fields(LinkOptions)}
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise UsageError(
            f"option '{unknown[0]}': backend 'mavlink' has none of that name; it has {', '.join(known)}"
        )
    values = {known[key]: _value(key, text) for key, text in given.items()}
    return LinkOptions(**values)  # type: ignore[arg-type]


def _value(key: str, text: str) -> object:
    try:
        return _READ.get(key, _positive)(text)
    except ValueError as error:
        raise UsageError(f"option '{key}': {error}") from error


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.0 < number < inf:
        raise ValueError(f"'{text}' is not a positive number")
    return number


def _count(text: str) -> int:
    if not text.isdecimal() or len(text) > 9 or int(text) < 1:
        raise ValueError(f"'{text}' is not a number from 1 on")
    return int(text)


def _switch(text: str) -> bool:
    if text not in SWITCHES:
        raise ValueError(f"{text} is neither yes nor no")
    return SWITCHES[text]


def _names(text: str) -> frozenset[str]:
    return frozenset(filter(None, text.split(",")))


def _objects(text: str) -> str:
    if text != "expected":
        raise ValueError(f"{text}: objects can only be taken to be where they are 'expected'")
    return text


_READ: Mapping[str, Callable[[str], object]] = {
    "tries": _count,
    "fence": _switch,
    "device-check": _switch,
    "battery-check": _switch,
    "try-devices": _names,
    "objects": _objects,
    "signing-key": Path,
    "inject": str,
}
