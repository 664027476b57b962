"""What a robot is driven with: its vehicle, the link to it, its black box, and whom to tell."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from mmrs_core.behaviour.program import Action
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.radios import Radios
from mmrs_mavlink.objects import Locator
from mmrs_mavlink.plugin.backend.whereabouts import Ground
from mmrs_mavlink.program import Action as VehicleAction
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.records.blackbox import BlackBox


@dataclass(frozen=True, slots=True)
class Equipment:
    """What a robot is driven with.

    Attributes:
        joules: that its batteries hold when full; None where nobody says.
        locators: what finds objects, by description.
        box: None where no logs are kept.
        resumed: whether the vehicle may be in the air at first.
        passed, begun: what it had done by then.
        system: of the vehicle when the run began; 0: nobody knows.
        action: an action of the behaviour as one of the vehicle's program.
        start: to be called once the robot gets ready, for faults that are made on purpose.
        let_go: to be called before the link is closed.
    """

    url: str
    link: Link
    vehicle: MavlinkVehicle
    radios: Radios
    clock: Clock
    ground: Ground
    joules: float | None
    locators: Mapping[str, Locator]
    box: BlackBox | None
    resumed: bool
    passed: tuple[str, ...]
    begun: str
    system: int
    say: Callable[[str], None]
    wake: Callable[[], None]
    action: Callable[[Action], VehicleAction]
    start: Callable[[], None]
    let_go: Callable[[], None]
