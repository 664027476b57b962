"""The cause of a mode change that was not commanded: a failsafe of the vehicle, and for what, or a pilot."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FENCE_BREACHED, TAKEN_OVER, VEHICLE_RESTARTED, FaultError

from ..vehicles.failsafe_events import STARTED_ANEW, Signs

if TYPE_CHECKING:
    from ..links.link import Link
    from ..vehicles.mavlink_vehicle import MavlinkVehicle

Cause = tuple[str, str]
"""An event, and the reason to believe that it is there."""


class Departures:
    """Looks for what a vehicle has left its mode for.

    Attributes:
        looking: whether it does so right now, while nothing may be sent.
        taken: whether it has found that a pilot has taken over.
        taken_back: when the vehicle was taken back last; what it had said until then explains nothing more.
    """

    def __init__(
        self, link: Link, vehicle: MavlinkVehicle, signs: Signs, answers: Callable[[str], bool]
    ) -> None:
        """Look at a vehicle; `answers` returns whether the robot is to answer an event that happens now."""
        self.looking = self.taken = False
        self.taken_back = -inf
        self._answers = answers
        self._link, self._vehicle, self._signs = link, vehicle, signs
        self._moving = True
        vehicle.explain(self._explain)

    @property
    def _clock(self) -> Clock:
        return self._link.clock

    def find(self, *, moving: bool) -> Cause | None:
        """Return the event that the vehicle has answered by leaving its mode; None: it has not left it.

        The cause is awaited for as long as its message may still be in transit.

        Args:
            moving: whether the robot is in motion.

        Raises:
            FaultError: a pilot has taken over, as far as is known.
        """
        self._moving = moving
        left = _left(self._vehicle)
        return None if left is None else self._find(left)

    def check(self, event: str, *, moving: bool) -> None:
        """Check that the vehicle has left its mode only for an event that its failsafes answer.

        Args:
            event: that is responded to; a mode in which the vehicle's failsafe answers it is not a pilot's.
            moving: whether the robot is in motion.

        Raises:
            FaultError: a pilot has taken over, as far as is known.
        """
        tells = self._vehicle.telemetry
        if not tells.armed() or event == VEHICLE_RESTARTED:
            return
        said = [text.text for found, text in tells.announcements.recent() if found == event]
        if tells.mode() not in self._vehicle.answers_to(event, said):
            self.find(moving=moving)

    def _explain(self, left: FaultError) -> FaultError:
        """Return the event that the vehicle has answered by another mode than the commanded one.

        Raises:
            FaultError: a pilot has taken over, as far as is known.
        """
        mode = self._vehicle.state().mode
        event, why = self._find(left)
        return left if event == left.event else FaultError(event, switched(event, why, mode))

    def _find(self, left: FaultError) -> Cause:
        """Return the event that the vehicle has answered by its mode, or by another one since.

        Raises:
            FaultError: a pilot has taken over, as far as is known.
        """
        taken_over, mode = _taken_over(left, self._vehicle), self._vehicle.telemetry.mode()
        self.looking = True
        try:
            found = self._await_cause(mode)
        finally:
            self.looking = False
        if found is None:
            self.taken = True
            raise taken_over
        since = _left(self._vehicle) if self._vehicle.telemetry.mode() != mode else None
        return found if since is None else self._find(since)

    def _await_cause(self, mode: int) -> Cause | None:
        signs, link = self._signs, self._link
        if not self._vehicle.telemetry.armed() or mode == link.profile.starts_in:
            # One that has started anew reports no time until it is asked for messages again. It has lost its
            # position, too: that is no cause.
            self._vehicle.reports.request_at_once()
            anew = link.wait(lambda: signs.restarted, self._clock.patience(link.profile.timing.restart))
            return (VEHICLE_RESTARTED, STARTED_ANEW) if anew else None
        by_itself = mode in link.profile.failsafe_modes | self._vehicle.modes_alone
        seconds = self._clock.patience(link.profile.timing.cause) if by_itself else 0.0
        return link.wait(lambda: self._cause(mode), seconds)

    def _cause(self, mode: int) -> Cause | None:
        """Return the event that the vehicle's failsafe has answered by that very mode."""
        if self._signs.restarted and self._moving:
            return VEHICLE_RESTARTED, STARTED_ANEW
        tells = self._vehicle.telemetry.announcements
        reported = [(event, text.text) for event, text in tells.recent()]
        for event, why in (*self._signs.seen(moving=self._moving), *reported):
            said = tells.of_this_mode(event, self.taken_back) or self._breach(event, why)
            if why and mode in self._vehicle.answers_to(event, (said,)):
                if self._answers(event):
                    return event, why
                if said:
                    return event, said
        return None

    def _breach(self, event: str, why: str) -> str:
        """Return that a fence was broken as the vehicle left its mode: an ArduRover says nothing about it."""
        tells = self._vehicle.telemetry
        since = tells.announcements.since_mode(self.taken_back)
        return why if event == FENCE_BREACHED and tells.breached_at() > since else ""


def switched(event: str, why: str, mode: str) -> str:
    """Return why a vehicle is in a mode that was not commanded: its failsafe for an event, or its restart."""
    return (
        f"{why}, in mode {mode}"
        if event == VEHICLE_RESTARTED
        else f"{why}; a failsafe switched it to mode {mode}"
    )


def _taken_over(left: FaultError, vehicle: MavlinkVehicle) -> FaultError:
    """Return that a pilot has taken over, in the words of why the vehicle is elsewhere, if these say so."""
    if left.event == TAKEN_OVER:
        return left
    mode = vehicle.state().mode
    return FaultError(TAKEN_OVER, f"the vehicle has gone into mode {mode}: it is under external control")


def _left(vehicle: MavlinkVehicle) -> FaultError | None:
    """Return why the vehicle is no longer in the mode that it should be in; None if it is."""
    try:
        vehicle.check()
    except FaultError as fault:
        return fault
    return None
