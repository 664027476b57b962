"""What can end a robot's program before its end."""

from __future__ import annotations

LINK_LOST = "LINK_LOST"
PEER_LOST = "PEER_LOST"
BATTERY_LOW = "BATTERY_LOW"
WAIT_TOO_LONG = "WAIT_TOO_LONG"
DEVICE_SILENT = "DEVICE_SILENT"
POSITION_LOST = "POSITION_LOST"
OBSTACLE = "OBSTACLE"
FENCE_BREACHED = "FENCE_BREACHED"
VEHICLE_RESTARTED = "VEHICLE_RESTARTED"
GROUND_LOST = "GROUND_LOST"
MOTOR_FAILED = "MOTOR_FAILED"
NO_PROGRESS = "NO_PROGRESS"
TAKEN_OVER = "TAKEN_OVER"
MOTORS_OFF = "MOTORS_OFF"
REFUSED = "REFUSED"
CONDITION_FAILED = "CONDITION_FAILED"
OBJECT_NOT_FOUND = "OBJECT_NOT_FOUND"
STOPPED = "STOPPED"
ORDERED = "ORDERED"
LOG_FAILED = "LOG_FAILED"
CRASHED = "CRASHED"

FAILURES = (Exception, SystemExit)
"""Exceptions of faulty or foreign code: none of them may end a thread unnoticed."""


def reason_of(error: OSError) -> str:
    """Return the system's message about a file, with its name where that is known."""
    said = error.strerror or str(error)
    return f"{error.filename}: {said}" if error.filename else said


class FaultError(Exception):
    """A fault; `event` names it, and the robot's policies define the response.

    Attributes:
        instead: the response, where that of the policies cannot be carried out; otherwise empty.
    """

    def __init__(self, event: str, message: str, instead: str = "") -> None:
        super().__init__(message)
        self.event = event
        self.instead = instead


class DisplacedError(FaultError):
    """The vehicle has left its commanded state for an event that is tolerated, or answered already.

    The command still holds: the vehicle is to be brought back to it.
    """


class RefusedError(FaultError):
    """The vehicle does not accept a command."""

    def __init__(self, message: str) -> None:
        super().__init__(REFUSED, message)


class UnansweredError(RefusedError):
    """The vehicle says nothing where it should: no answer to a command, no image, no value."""


class StrangeAnswerError(RefusedError):
    """The vehicle is not the robot's, or may be under external control: it must not be commanded."""


class StoppedError(FaultError):
    """The robot was ordered to stop."""

    def __init__(self) -> None:
        super().__init__(STOPPED, "stop was asked for")
