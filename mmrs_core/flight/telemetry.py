"""What a vehicle tells about itself, read from the latest messages of its link."""

from __future__ import annotations

from math import hypot

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .link import Link
from .program import Geographic, Local, Place
from .vehicle import State

PREARM = 0x1000_0000
EKF_HORIZONTAL = 16
NO_HEADING = 65_535


class Telemetry:
    """Reads the latest messages of a link; nothing here waits."""

    def __init__(self, link: Link, home: Place) -> None:
        """Read a link; the frame of `home` decides which positions count."""
        self._link = link
        self._home = home
        self._geographic = isinstance(home, Geographic)
        self._position = "GLOBAL_POSITION_INT" if self._geographic else "LOCAL_POSITION_NED"

    def state(self) -> State:
        """Return all that conditions are asked with."""
        return State(self._link.clock.now(), self.here(), self.speed(), self.heading() or 0.0, self.energy())

    def ready(self) -> bool:
        """Return whether the vehicle knows where it is and its own checks pass."""
        status, ekf = self._link.latest("SYS_STATUS"), self._link.latest("EKF_STATUS_REPORT")
        if status is None or self._link.latest(self._position) is None:
            return False
        located = ekf is None or bool(ekf.flags & EKF_HORIZONTAL)
        return located and bool(status.onboard_control_sensors_health & PREARM)

    def here(self) -> Place:
        """Return the position; home before there is one."""
        found = self._link.latest(self._position)
        if found is None:
            return self._home
        if self._geographic:
            return Geographic(found.lat * 1e-7, found.lon * 1e-7, found.relative_alt * 1e-3)
        return Local(found.x, found.y, -found.z)

    def speed(self) -> float:
        """Return the speed in metres per second."""
        found = self._link.latest(self._position)
        if found is None:
            return 0.0
        return float(hypot(found.vx, found.vy, found.vz) * (0.01 if self._geographic else 1.0))

    def heading(self) -> float | None:
        """Return the heading in degrees clockwise from north; None where the vehicle does not say."""
        found = self._link.latest("GLOBAL_POSITION_INT")
        return found.hdg / 100.0 if found is not None and found.hdg != NO_HEADING else None

    def energy(self) -> float | None:
        """Return the part of the battery that is left; None where the vehicle does not say."""
        status = self._link.latest("SYS_STATUS")
        left = status.battery_remaining if status is not None else -1
        return left / 100.0 if left >= 0 else None

    def armed(self) -> bool:
        """Return whether the motors may run."""
        beat = self._link.latest("HEARTBEAT")
        return bool(beat is not None and beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    def mode(self) -> int:
        """Return the number of the mode; -1 before the first heartbeat."""
        beat = self._link.latest("HEARTBEAT")
        return int(beat.custom_mode) if beat is not None else -1

    def grounded(self) -> bool:
        """Return whether the vehicle says that it stands on the ground."""
        state = self._link.latest("EXTENDED_SYS_STATE")
        return bool(state is not None and state.landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND)

    def item(self) -> int:
        """Return the mission item that the vehicle is at; -1 where it does not say."""
        current = self._link.latest("MISSION_CURRENT")
        return int(current.seq) if current is not None else -1
