"""Whether the motors of a vehicle may be off: not where it was in the air or below, and has not come home."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.faults import MOTORS_OFF, VEHICLE_RESTARTED, FaultError
from mmrs_runtime.policies import HOLD

from ..profiles import VehicleProfile, modes

if TYPE_CHECKING:
    from ..vehicles.mavlink_vehicle import MavlinkVehicle

TOUCHING = 1.0
"""Metres from the height of home within which a vehicle may stop its motors any moment."""

COMES_DOWN_IN = frozenset({modes.LAND, modes.SURFACE, "return", "smart return"})
"""Modes at whose end the motors stop."""


class Motors:
    """Keeps whether a vehicle is in flight, or below the surface, and the mode in which it was armed last.

    A PX4 shows another one as soon as it has disarmed.
    """

    def __init__(self, vehicle: MavlinkVehicle, profile: VehicleProfile) -> None:
        """Look at a vehicle of a class."""
        self._vehicle, self._profile = vehicle, profile
        self._flown = False
        self._ran_in = ""

    def renew(self) -> None:
        """Forget what was: the vehicle is on the ground."""
        self._flown = False

    def check(self, *, moving: bool) -> None:
        """Check that a vehicle that was in the air, or below, disarms only to land or surface.

        If it does so elsewhere, it has crashed, or was disarmed by someone: it must not be
        armed again.

        Args:
            moving: whether the robot is in motion.

        Raises:
            FaultError: it has disarmed elsewhere.
        """
        tells, state = self._vehicle.telemetry, self._vehicle.state()
        below = self._profile.dives and state.place.height < -TOUCHING
        if tells.armed():
            self._ran_in = state.mode
        comes_down = not COMES_DOWN_IN.isdisjoint((self._ran_in, state.mode))
        if self._profile.drives or not moving or comes_down:
            low = not below and (tells.grounded() or state.place.height < TOUCHING)
            self._flown = self._flown and moving and not low
        elif tells.armed():
            self._flown = below or (self._profile.flies and (self._flown or tells.airborne()))
        elif self._flown:
            raise FaultError(
                MOTORS_OFF, "it has disarmed in motion: it has crashed, or was disarmed by someone"
            )

    def check_stands(self, said: str) -> None:
        """Check that a vehicle that has restarted has yet to take off, and so can begin again.

        Args:
            said: of its start.

        Raises:
            FaultError: it was in motion: it has lost its state, and may not know its position.
        """
        armed = self._vehicle.telemetry.armed()
        if armed or self._flown or not self._profile.flies:
            why = f"{said} in motion, {'armed' if armed else 'disarmed'}: its program cannot be continued"
            raise FaultError(VEHICLE_RESTARTED, why, self._profile.down if armed else HOLD)
