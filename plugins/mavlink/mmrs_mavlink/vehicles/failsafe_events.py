"""What a vehicle tells that has gone wrong, as the events that policies answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.faults import FENCE_BREACHED, MOTOR_FAILED, OBSTACLE, POSITION_LOST, VEHICLE_RESTARTED

if TYPE_CHECKING:
    from .telemetry import Telemetry

STARTED_ANEW = "the vehicle has restarted"


class Signs:
    """Reads what a vehicle tells; nothing here waits."""

    def __init__(self, telemetry: Telemetry, *, jumps: bool = True, flies: bool = False) -> None:
        """Take for granted what was up to now.

        Args:
            telemetry: of the vehicle.
            jumps: whether its position must not leap; that of what dives does when it comes up to a fix.
            flies: whether it needs its motors to stay where it is.
        """
        self._telemetry = telemetry
        self._heeds_leaps, self._flies = jumps, flies
        self.renew()

    def renew(self) -> None:
        """Take the vehicle's restarts and jumps, and its failed motors, up to now for granted."""
        self._failed = ""
        self._telemetry.motor_failures.renew()
        self._starts = self._telemetry.starts()
        self._jumps = self._telemetry.jumps.count

    @property
    def restarted(self) -> bool:
        """Return whether the vehicle has restarted since `renew`."""
        return self._telemetry.starts() > self._starts

    @property
    def leapt(self) -> bool:
        """Return whether its position estimate has jumped since `renew`."""
        return self._heeds_leaps and self._telemetry.jumps.count > self._jumps

    def seen(self, *, moving: bool) -> tuple[tuple[str, str], ...]:
        """Return each event with the reason to assume it; an empty one: none.

        Args:
            moving: whether the robot is in motion; one that is not may restart.
        """
        tells = self._telemetry
        active = moving and tells.armed()
        return (
            (VEHICLE_RESTARTED, STARTED_ANEW if moving and self.restarted else ""),
            (POSITION_LOST, self._unlocated() if active else ""),
            (FENCE_BREACHED, tells.breach() if active else ""),
            (OBSTACLE, tells.obstacle() if active else ""),
            (MOTOR_FAILED, self._failure() if active and self._flies else ""),
        )

    def _unlocated(self) -> str:
        """Return why the vehicle's position is unknown; empty if it is known."""
        return self._telemetry.position_trouble() or (self._telemetry.jumps.last if self.leapt else "")

    def fallen(self, *, in_air: bool) -> str:
        """Return why the motors of a vehicle must stop after one has failed; empty where it may still fly.

        Args:
            in_air: whether a fall counts that nothing stops, and not only its end.
        """
        return self._telemetry.motor_failures.fallen(in_air=in_air) if self._failed else ""

    def _failure(self) -> str:
        """Return why a motor must have failed since `renew`: none recovers."""
        said = (text.text for event, text in self._telemetry.announcements.recent() if event == MOTOR_FAILED)
        self._failed = self._failed or self._telemetry.motor_failures.failure or next(said, "")
        return self._failed
