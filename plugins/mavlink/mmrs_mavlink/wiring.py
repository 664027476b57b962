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
    """

    command: int
    params: tuple[float, ...]
    seconds: float | None = None
    more: tuple[tuple[int, tuple[float, ...]], ...] = ()
    confirmed: bool = False


@dataclass(frozen=True, slots=True)
class Sampled:
    """A value that the vehicle publishes by name, and the seconds that measuring takes; None as above."""

    value: str
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Unwired:
    """Why there is no way to have a device do something."""

    reason: str


Wiring: TypeAlias = Wired | Sampled | Unwired


@dataclass(frozen=True, slots=True)
class DeviceWiring:
    """How the actions of devices with a property are carried out.

    Attributes:
        property: of a device, such as ``mavlink.camera``; it says that this wiring is meant. What
            ``<property>.<action>`` says is about that action alone, and goes before other wirings.
        description: one line for people: what an action does then.
        wire: what an action of a device becomes; None: that action is none of this wiring's.
    """

    property: str
    description: str
    wire: Callable[[Action, Device], Wiring | None]


Wirings: TypeAlias = Mapping[str, DeviceWiring]
"""Wirings by their property."""
