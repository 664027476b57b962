"""What a robot is driven with: its vehicle, the link to it, its black box, and whom to tell."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.user_functions import Locator
from mmrs_runtime.engine.connecting import Live
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.vehicle import Position

from ..program import Place
from ..vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    from ..linked import RadioLink


class Guard:
    """What every wait of a vehicle calls; it raises what is to end the wait."""

    def __init__(self) -> None:
        """Raise nothing until `check` is set."""
        self.check: Callable[[], None] = lambda: None

    def __call__(self) -> None:
        """Raise what is to end the wait."""
        self.check()


@dataclass(frozen=True, slots=True)
class Precautions:
    """What keeps a vehicle on the ground before its first take-off; otherwise it is only reported.

    Attributes:
        devices: whether a device that cannot do what the program asks of it does.
        battery: whether a battery that does not suffice for the first sortie does.
        tried: devices whose actions are carried out on the ground to see whether they work.
    """

    devices: bool = True
    battery: bool = True
    tried: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Equipment:
    """What a robot's driver works with.

    Attributes:
        guard: that the vehicle calls in its waits.
        radio: None where the vehicle is reached otherwise, or there is none.
        position: of a place: east, north, up.
        live: of the run; where it holds steps, the vehicle may be in the air.
        joules: capacity of its batteries; None where unknown.
        locators: find objects, by description.
        box: None where no logs are kept.
        home_tolerance: metres that a vehicle may be from where it is to stand.
        fence: whether forbidden areas are uploaded.
        precautions: before it takes off.
        dry: whether there is no vehicle.
        start: to be called once the robot gets ready, for injected faults.
        let_go: to be called before the link is closed.
    """

    vehicle: Vehicle
    guard: Guard
    clock: Clock
    position: Callable[[Place], Position]
    live: Live
    radio: RadioLink | None = None
    joules: float | None = None
    locators: Mapping[str, Locator] = field(default_factory=dict)
    box: BlackBox | None = None
    home_tolerance: float = 20.0
    fence: bool = True
    precautions: Precautions = Precautions()
    dry: bool = False
    start: Callable[[], None] = lambda: None
    let_go: Callable[[], None] = lambda: None
