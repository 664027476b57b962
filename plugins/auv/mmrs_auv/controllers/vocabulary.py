"""What programs of vehicles on CAN buses say beyond the vocabulary of all controllers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Operate:
    """Command a device, and wait until it has finished.

    Attributes:
        device: as in the vehicle's sheet. action: human-readable.
        number: of the action at the device. parameter: means what the device says.
        seconds: that it takes.
    """

    device: str
    action: str
    number: int
    parameter: float = 0.0
    seconds: float = 0.0
