"""Settings of a simulated vehicle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from mmrs_mavlink.profiles import PROFILES, VehicleProfile
from mmrs_runtime.sights import Sight

IMITATED = {
    (each.rehearsed_as, each.rehearsed_with): each
    for each in reversed(list(PROFILES.values()))
    if each.rehearsed_as
}
"""Profiles of the vehicles that are imitated, by kind and firmware."""

ARDUPILOT, PX4 = "ardupilot", "px4"


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of a simulated vehicle.

    Attributes:
        kind: ``copter``, ``sub`` or ``rover``.
        latitude, longitude: of its home, degrees. altitude: of its home above mean sea level, metres.
        firmware: ``ardupilot``, or ``px4`` for copters.
        boot: seconds after boot in which uploads are refused and mode changes are lost.
        ready: seconds after boot until it has a position and can be armed.
        energy: seconds armed until the battery is empty. capacity: of the battery, mAh; cells: of it.
        recharge: seconds disarmed until the battery is full; 0: never.
        tells_battery: whether it measures its battery.
        spins: whether a rover can turn on the spot.
        wind: metres per second, and degrees that it comes from.
        values: sensors by name, published as NAMED_VALUE_FLOAT: functions of the time in seconds.
        sights: objects that its photos can show, in metres from its home.
        refuse: commands answered with UNSUPPORTED. silent: commands that are never answered.
        ground: host and UDP port of a ground station; None: there is none.
        key: signing key, 32 bytes; empty: unsigned.
        parameters: those that differ from the defaults.
    """

    kind: str = "copter"
    latitude: float = 42.37
    longitude: float = 13.35
    system: int = 1
    altitude: float = 720.0
    firmware: str = ARDUPILOT
    boot: float = 1.0
    ready: float = 2.0
    energy: float = 1200.0
    capacity: float = 5000.0
    cells: int = 3
    recharge: float = 0.0
    tells_battery: bool = True
    spins: bool = False
    wind: tuple[float, float] = (0.0, 0.0)
    values: Mapping[str, Callable[[float], float]] = field(default_factory=dict)
    sights: tuple[Sight, ...] = ()
    refuse: frozenset[int] = frozenset()
    silent: frozenset[int] = frozenset()
    ground: tuple[str, int] | None = None
    key: bytes = b""
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if (self.kind, self.firmware) not in IMITATED:
            raise ValueError(f"{self.firmware}: not a firmware for a {self.kind}")

    @property
    def profile(self) -> VehicleProfile:
        """Return the profile of the vehicle that it imitates."""
        return IMITATED[self.kind, self.firmware]
