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
"""What may come out of code that is wrong, or somebody else's: what it raises must end no thread unseen."""


def reason_of(error: OSError) -> str:
    """Return what a system says of a file, with its name where that is known."""
    said = error.strerror or str(error)
    return f"{error.filename}: {said}" if error.filename else said


class Fault(Exception):  # noqa: N818  # the word that policies and logs use
    """Something went wrong; `event` says what, and the robot's policies say what it does about it.

    Attributes:
        instead: the response, where what policies say cannot be carried out; else empty.
    """

    def __init__(self, event: str, message: str, instead: str = "") -> None:
        super().__init__(message)
        self.event = event
        self.instead = instead


class Displaced(Fault):
    """The vehicle has left by itself what it was told, for an event that is borne, or answered already.

    What it was told goes on: it is to be taken back.
    """


class Refused(Fault):
    """The vehicle does not accept something that it was told."""

    def __init__(self, message: str) -> None:
        super().__init__(REFUSED, message)


class Unanswered(Refused):
    """The vehicle says nothing where it should: no answer to a command, no image, no value."""


class Strange(Refused):
    """The vehicle is not the robot's, or somebody else may have it: it must be told nothing."""


class Stopped(Fault):
    """Somebody asked the robot to stop."""

    def __init__(self) -> None:
        super().__init__(STOPPED, "stop was asked for")
