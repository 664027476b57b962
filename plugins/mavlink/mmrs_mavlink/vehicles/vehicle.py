"""What a robot's program needs of a vehicle, whether there is one or not."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from mmrs_runtime.controllers.state import State

from ..program import Look, Place

if TYPE_CHECKING:
    from ..services.uploads import Uploads


FULL = 0.99
"""Part of a battery from which on it counts as charged."""


class Evidence(Protocol):
    """Shows whether a vehicle obeys, by what it has told since an instant."""

    def in_mode(self, mode: str) -> bool:
        """Return whether it has shown since that it is in a mode, in the runtime's words."""
        ...

    def is_off(self) -> bool:
        """Return whether it was shown disarmed since."""
        ...

    def bound_for(self, place: Place, speed: float | None) -> bool:
        """Return whether it is steered, and goes to a commanded position, or is there."""
        ...


class Vehicle:
    """What a robot's program needs of a vehicle; by default, nothing happens, as in a dry run.

    Attributes:
        start: where it is to stand before it takes off: home, or where its program has landed it.
    """

    start: Place

    def answer_lost_link(self, response: str, after: float | None = None) -> None:
        """Set the failsafe for a ground station that is silent for some seconds."""

    def answer_breach(self, response: str) -> None:
        """Set the failsafe for a vehicle outside its fence."""

    def prepare(self, uploads: Uploads) -> None:
        """Upload what there is to upload, and wait until the vehicle is ready to go to all places."""

    def take_off(self, height: float) -> None:
        """Climb to a height above home, or continue climbing to it."""

    def land(self) -> None:
        """Descend and stop the motors."""

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place; `through`: without a stop there."""

    def turn(self, look: Look) -> None:
        """Turn until a device points at something."""

    def fly(self, first: int, last: int, reached: Callable[[int], None], look: Look | None = None) -> None:
        """Fly items of the uploaded mission, and tell each item that is behind; `look`: all along."""

    def can_look(self, look: Look | None) -> bool:
        """Return whether it looks at a place all along a mission; None: where it goes."""
        return True

    def rest(self, seconds: float) -> None:
        """Stay for `seconds`."""

    def operate(self, number: int, params: tuple[float, ...], *, confirmed: bool = False) -> None:
        """Carry out a device action; `confirmed`: wait for the report of its image, too."""

    def ask(self, number: int, *params: float) -> None:
        """Send a command once, without waiting for the answer."""

    def measure(self, value: str, seconds: float) -> float | None:
        """Return the next value published under that name; None in a dry run.

        Raises:
            UnansweredError: none comes within `seconds`.
        """
        raise NotImplementedError

    def tell_ground(self, text: str) -> None:
        """Send a text to ground stations."""

    def renew_battery(self) -> str:
        """Count the batteries as changed for full ones; return why they do not; empty: they do."""
        return ""

    def hold(self) -> bool:
        """Halt and stay, on the ground with the motors off; return, when it does, whether they run."""
        raise NotImplementedError

    def carry_on(self) -> None:
        """Prepare to move again after a hold; what flies stays where it is."""

    def check(self) -> None:
        """Check, without waiting, that the vehicle is not under external control.

        Raises:
            FaultError: it is.
        """

    @property
    def returns_alone(self) -> bool:
        """Return whether its autopilot brings it home or down, without a command of this program."""
        return False

    def take_back(self) -> None:
        """Prepare to command the vehicle out of a failsafe's mode."""

    def regain(self) -> None:
        """Return the vehicle to the mode that it has left without a command."""

    def surface(self) -> None:
        """Come up to the water surface."""

    def disarm(self) -> None:
        """Switch off propulsion, whatever happens then."""

    def finish(self) -> None:
        """End the mission: nothing moves any more."""

    def evidence(self) -> Evidence:
        """Return what shows, from now on, whether the vehicle obeys."""
        raise NotImplementedError

    def state(self) -> State:
        """Return what is known now."""
        raise NotImplementedError
