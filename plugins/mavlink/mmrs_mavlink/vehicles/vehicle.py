"""What a robot's program needs of a vehicle, whether there is one or not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from mmrs_runtime.records.blackbox import plain

from ..program import GoTo, Look, Place

if TYPE_CHECKING:
    from ..services.uploads import Uploads


@dataclass(frozen=True, slots=True)
class State:
    """What a robot knows of itself; conditions are asked with it.

    Attributes:
        time: seconds of the run. place: where it is. speed: metres per second.
        heading: degrees clockwise from north. energy: part of the battery that is left, 0 to 1, or
            None where the vehicle does not say.
        wind: metres per second; wind_from: degrees clockwise from north; None where nobody knows.
        detected: names of what the vehicle has detected so far. places: where, as far as it knows.
        found: names of what it, or a robot that has notified it since, has detected.
        answers: what the operator has answered, by question, and no choice has used up.
        mode: in the runtime's words (``guided``, ``auto``, ``hold``, ``land`` …) or, where it has none
            for it, the vehicle's number. armed: whether the motors may run.
    """

    time: float
    place: Place
    speed: float
    heading: float
    energy: float | None
    mode: str = ""
    armed: bool = False
    wind: float | None = None
    wind_from: float | None = None
    detected: frozenset[str] = frozenset()
    places: Mapping[str, Place] = field(default_factory=dict)
    found: frozenset[str] = frozenset()
    answers: Mapping[str, bool] = field(default_factory=dict)

    @property
    def charge(self) -> float | None:
        """Return the part of the battery that is left, as the standard conditions call it."""
        return self.energy


def told_of(state: State) -> dict[str, object]:
    """Return what there is to say of a vehicle's state, as JSON has it."""
    found = {
        "mode": state.mode,
        "armed": state.armed,
        "energy": state.energy,
        "place": state.place,
        "speed": round(state.speed, 2),
    }
    return {name: plain(value) for name, value in found.items()}


class Evidence(Protocol):
    """Shows whether a vehicle obeys, by what it has told since an instant."""

    def in_mode(self, mode: str) -> bool:
        """Return whether it has shown since that it is in a mode, in the runtime's words."""
        ...

    def is_off(self) -> bool:
        """Return whether it has shown since that its motors are off."""
        ...

    def bound_for(self, place: Place, speed: float | None) -> bool:
        """Return whether it is steered, and goes to a place that it was told, or is there."""
        ...


class Vehicle(Protocol):
    """What a robot's program needs of a vehicle.

    Attributes:
        start: where it is to stand before it takes off: home, or where its program has landed it.
        about: what its black box says first of how it is reached, where that is not by MAVLink.
    """

    start: Place
    about: Mapping[str, object]

    def answer_lost_link(self, response: str, after: float | None = None) -> None:
        """Have the vehicle respond so by itself when it has not heard the ground for some seconds."""
        ...

    def answer_breach(self, response: str) -> None:
        """Have the vehicle respond so by itself when it is outside its fence."""
        ...

    def prepare(self, uploads: Uploads) -> None:
        """Upload what there is to upload, and wait until the vehicle is ready to go to all places."""
        ...

    def take_off(self, height: float) -> None:
        """Climb to a height above home, or go on climbing to it."""
        ...

    def land(self) -> None:
        """Descend and stop the motors."""
        ...

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place; `through`: without a stop there."""
        ...

    def turn(self, look: Look) -> None:
        """Turn until a device points at something."""
        ...

    def fly(self, first: int, last: int, reached: Callable[[int], None]) -> None:
        """Fly items of the uploaded mission, and tell each item that is behind."""
        ...

    def rest(self, seconds: float) -> None:
        """Stay for so many seconds."""
        ...

    def operate(self, number: int, params: tuple[float, ...], *, confirmed: bool = False) -> None:
        """Have a device do something; `confirmed`: and wait for the image that it has promised to tell."""
        ...

    def measure(self, value: str, seconds: float) -> float | None:
        """Return the next value published under that name; None where there is only a dry run.

        Raises:
            Unanswered: none comes within so many seconds.
        """
        ...

    def tell_ground(self, text: str) -> None:
        """Have people at ground stations read something."""
        ...

    def hold(self) -> bool:
        """Halt and stay, on the ground with the motors off; return, when it does, whether they run."""
        ...

    def carry_on(self) -> None:
        """Be ready to move again after a hold; what flies stays where it is."""
        ...

    def check(self) -> None:
        """Make sure, without waiting, that nobody else has taken the vehicle over.

        Raises:
            Fault: somebody has.
        """
        ...

    def take_back(self) -> None:
        """Be ready to command the vehicle out of a mode that it went into by itself."""
        ...

    def regain(self) -> None:
        """Have the vehicle again in the mode that it has left by itself."""
        ...

    def surface(self) -> None:
        """Come up to the water surface."""
        ...

    def disarm(self) -> None:
        """Switch off propulsion, whatever happens then."""
        ...

    def finish(self) -> None:
        """End the mission: nothing moves any more."""
        ...

    def evidence(self) -> Evidence:
        """Return what shows, from now on, whether the vehicle obeys."""
        ...

    def state(self) -> State:
        """Return what is known now."""
        ...


@runtime_checkable
class Seeking(Protocol):
    """What a program also needs of a vehicle that finds objects itself."""

    def seek(self, movement: GoTo) -> Place | None:
        """Go and look until the object that a movement leads to is found; return where it is.

        None: nothing looks for it, so that the user's function says where it is.
        """
        ...
