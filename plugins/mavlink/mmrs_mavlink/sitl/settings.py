"""How a simulated vehicle is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from mmrs_runtime.sights import Sight

KINDS = ("copter", "sub", "rover")
ARDUPILOT, PX4 = "ardupilot", "px4"


@dataclass(frozen=True, slots=True)
class Settings:
    """How a vehicle is.

    Attributes:
        kind: ``copter``, ``sub`` or ``rover``.
        latitude, longitude: of its home, degrees. altitude: of its home above the sea, metres.
        firmware: ``ardupilot``, or ``px4`` for copters, which is written from PX4's documentation and
            was never compared with one.
        boot: seconds in which uploads are refused and modes forgotten.
        ready: seconds after which it has a position and may be armed.
        disarm_delay: seconds after which it disarms by itself on the ground.
        energy: seconds of hovering until the battery is empty. capacity: of it, milliampere-hours.
        recharge: seconds without motors running until it is full again; 0: it stays as it is until
            somebody changes it, as with an autopilot that counts what was used.
        tells_battery: whether it knows its battery at all.
        falls: whether its motors stop in the air when the battery is empty.
        wind: metres per second, and degrees where it comes from.
        gusts: standard deviation of the air about the wind, metres per second on each axis, and for how
            many seconds they last (correlation time); they carry copters only.
        seed: of the gusts; vehicles with different system ids meet different ones all the same.
        rate: of its telemetry until somebody asks for another, hertz.
        values: by name, what it publishes as NAMED_VALUE_FLOAT, given seconds.
        sights: what it may detect in its photos; from its home.
        refuse: commands that it does not know.
        silent: commands that it never answers.
        mavlink: version of MAVLink that its port speaks and never leaves, 1 or 2.
        key: 32 bytes to sign with and to expect signatures of; empty: no signatures.
        parameters: by name, those that are not as after a reset.
    """

    kind: str = "copter"
    latitude: float = 42.37
    longitude: float = 13.35
    system: int = 1
    altitude: float = 720.0
    firmware: str = ARDUPILOT
    boot: float = 1.0
    ready: float = 2.0
    disarm_delay: float = 10.0
    energy: float = 1200.0
    capacity: float = 5000.0
    recharge: float = 0.0
    tells_battery: bool = True
    falls: bool = True
    wind: tuple[float, float] = (0.0, 0.0)
    gusts: tuple[float, float] = (0.0, 5.0)
    seed: int = 0
    rate: float = 4.0
    values: Mapping[str, Callable[[float], float]] = field(default_factory=dict)
    sights: tuple[Sight, ...] = ()
    refuse: frozenset[int] = frozenset()
    silent: frozenset[int] = frozenset()
    mavlink: int = 2
    key: bytes = b""
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse what there is not.

        Raises:
            ValueError: there is no such vehicle.
        """
        if self.kind not in KINDS:
            raise ValueError(f"{self.kind}: no such kind; there are {', '.join(KINDS)}")
        if self.firmware not in (ARDUPILOT, PX4) or (self.firmware == PX4 and self.kind != "copter"):
            raise ValueError(f"{self.firmware}: no such firmware for a {self.kind}")
        if not (0.0 <= self.gusts[0] <= 20.0 and self.gusts[1] > 0.0):
            raise ValueError(f"{self.gusts[0]:g},{self.gusts[1]:g}: are no gusts; 0 to 20 m/s, some seconds")
        if self.mavlink not in (1, 2):
            raise ValueError(f"MAVLink {self.mavlink}: no such version; there are 1 and 2")
        if not 1 <= self.system <= 255:
            raise ValueError(f"{self.system}: is no MAVLink system; they are 1 to 255")
