"""What a vehicle is told to do by itself when it is not heard of, or hears nobody."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from mmrs_core.flight.faults import LINK_LOST
from mmrs_core.flight.program import Policy, Robot
from mmrs_core.flight.steps.responses import BLOCKED, alone, policy_for
from mmrs_core.flight.vehicles.vehicle import Vehicle


class LostLink:
    """Keeps the vehicle's own answer to a lost link that of the policies which count at the time.

    Attributes:
        policies: of the wait that the robot is in; empty: it is in none that has any.
    """

    def __init__(self, robot: Robot, vehicle: Vehicle) -> None:
        """Begin with the robot's own policies; the vehicle is told nothing yet."""
        self.policies: Sequence[Policy] = ()
        self._robot, self._vehicle = robot, vehicle
        self._told = self._wanted = alone(policy_for(LINK_LOST, robot), robot)

    @property
    def is_due(self) -> bool:
        """Return whether the vehicle must be told something else than before."""
        return self._wanted != self._told

    def follow(self, policies: Sequence[Policy]) -> None:
        """Take up the policies of a wait; empty: those of the robot alone."""
        self.policies = policies
        self._wanted = alone(policy_for(LINK_LOST, self._robot, policies), self._robot)

    def tell(self, say: Callable[[str], None]) -> None:
        """Tell the vehicle, and say where it cannot do what the policies want.

        Raises:
            Refused: it cannot respond so, or does not say that it will.
        """
        if self._told != policy_for(LINK_LOST, self._robot, self.policies):
            say(BLOCKED)
        self._vehicle.answer_lost_link(self._told.response, self._told.after)

    def tell_again(self) -> None:
        """Tell the vehicle what is due, if anything is.

        Raises:
            Refused: it cannot respond so, or does not say that it will.
        """
        if self.is_due:
            self._vehicle.answer_lost_link(self._wanted.response, self._wanted.after)
            self._told = self._wanted
