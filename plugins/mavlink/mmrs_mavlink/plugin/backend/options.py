"""The options of the backend mavlink, as in ``--backend-option KEY=VALUE``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.contributions.backend_options import count, one_of, positive, read_options, switch


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
    """Return the options by their keys.

    Raises:
        UsageError: if there is no such option, or its value makes no sense.
    """
    return read_options(LinkOptions, "mavlink", given, _READERS)


_READERS: Mapping[str, Callable[[str], object]] = {
    **dict.fromkeys(("patience", "acceptance", "home-tolerance", "answer-seconds", "item-seconds"), positive),
    **dict.fromkeys(("fence", "device-check", "battery-check"), switch),
    "tries": count,
    "try-devices": lambda text: frozenset(filter(None, text.split(","))),
    "objects": one_of("expected"),
    "signing-key": Path,
    "inject": str,
}
