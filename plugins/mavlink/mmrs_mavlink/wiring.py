"""How actions of devices reach vehicles that speak MAVLink."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Action
    from mmrs_core.scene import Device


@dataclass(frozen=True, slots=True)
class Wired:
    """A MAVLink command with its parameters, and the seconds that the action takes.

    Attributes:
        command: number of its MAV_CMD.
        params: at most seven finite numbers; those that are missing are 0.
        seconds: None: the duration that the device gives the action.
        more: further commands with their parameters, which follow the first one at once.
        confirmed: whether the vehicle promises to tell each image that it takes.
        trial: whether the action may be tried on the ground, before take-off.
    """

    command: int
    params: tuple[float, ...]
    seconds: float | None = None
    more: tuple[tuple[int, tuple[float, ...]], ...] = ()
    confirmed: bool = False
    trial: bool = False


@dataclass(frozen=True, slots=True)
class Sampled:
    """A value that the vehicle publishes by name, and the seconds that measuring takes; None as above."""

    value: str
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Unwired:
    """Why a device action is not possible."""

    reason: str


Wiring: TypeAlias = Wired | Sampled | Unwired


@dataclass(frozen=True, slots=True)
class DeviceWiring:
    """How the actions of devices with a property are carried out.

    Attributes:
        property: of a device, such as ``mavlink.camera``; it selects this wiring. The property
            ``<property>.<action>`` concerns that action alone, and takes precedence over other wirings.
        description: one line: what an action does then.
        wire: what an action of a device becomes; None: this wiring does not handle the action.
    """

    property: str
    description: str
    wire: Callable[[Action, Device], Wiring | None]


Wirings: TypeAlias = Mapping[str, DeviceWiring]
"""Wirings by their property."""
