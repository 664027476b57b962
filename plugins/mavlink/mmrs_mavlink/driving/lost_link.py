"""What a vehicle is told to do by itself when it is not heard of, or hears nobody."""

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
        """Begin with the robot's own policies; the vehicle is told nothing yet.

        Args:
            robot: whose policies count.
            vehicle: of the robot.
            say: tells people where the vehicle cannot do by itself what the policies want.
        """
        self.policies: Sequence[Policy] = ()
        self._robot, self._vehicle, self._say = robot, vehicle, say
        self._told: Policy | None = None

    @property
    def is_due(self) -> bool:
        """Return whether the vehicle must be told something else than it was told before."""
        return self._told is not None and self._told != self._wanted

    def follow(self, policies: Sequence[Policy]) -> None:
        """Take up the policies of a wait; empty: those of the robot alone."""
        self.policies = policies

    def tell(self) -> None:
        """Tell the vehicle what counts now, also one that was told before, and has forgotten it.

        Raises:
            Refused: it cannot respond so, or does not say that it will.
        """
        wanted = self._wanted
        possible = alone(wanted, self._robot)
        if possible != wanted:
            self._say(BLOCKED)
        self._vehicle.answer_lost_link(possible.response, possible.after)
        self._told = wanted

    def tell_what_is_due(self) -> None:
        """Tell the vehicle what counts now, unless it was told that last.

        Raises:
            Refused: it cannot respond so, or does not say that it will.
        """
        if self.is_due:
            self.tell()

    @property
    def _wanted(self) -> Policy:
        return policy_for(LINK_LOST, self._robot, self.policies)
