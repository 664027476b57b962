"""The vehicle's own failsafe for a lost link: to the robot's program, or to the ground."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from mmrs_runtime.faults import LINK_LOST

from ..program import Policy, Robot
from ..steps.responses import BLOCKED, alone, policy_for
from ..vehicles.vehicle import Vehicle


class LostLink:
    """Keeps the vehicle's own answer to a lost link that of the policies which count at the time.

    Attributes:
        policies: of the wait that the robot is in; empty: it is in none that has any.
    """

    def __init__(self, robot: Robot, vehicle: Vehicle, say: Callable[[str], None]) -> None:
        """Create from the robot's own policies; nothing is sent to the vehicle yet.

        Args:
            robot: whose policies count.
            vehicle: of the robot.
            say: reports where the vehicle's failsafes cannot do what the policies ask for.
        """
        self.policies: Sequence[Policy] = ()
        self._robot, self._vehicle, self._say = robot, vehicle, say
        self._reported: Policy | None = None

    @property
    def is_due(self) -> bool:
        """Return whether the vehicle's failsafe must be set differently from before."""
        return self._reported is not None and self._reported != self._wanted

    def follow(self, policies: Sequence[Policy]) -> None:
        """Take up the policies of a wait; empty: those of the robot alone."""
        self.policies = policies

    def tell(self) -> None:
        """Set the vehicle's failsafe, also where it was set before and lost.

        Raises:
            RefusedError: it cannot respond so, or does not confirm that it will.
        """
        wanted = self._wanted
        possible = alone(wanted, self._robot)
        if possible != wanted:
            self._say(BLOCKED)
        self._vehicle.answer_lost_link(possible.response, possible.after)
        self._reported = wanted

    def tell_what_is_due(self) -> None:
        """Set the vehicle's failsafe, unless it was set so last.

        Raises:
            RefusedError: it cannot respond so, or does not confirm that it will.
        """
        if self.is_due:
            self.tell()

    @property
    def _wanted(self) -> Policy:
        return policy_for(LINK_LOST, self._robot, self.policies)
