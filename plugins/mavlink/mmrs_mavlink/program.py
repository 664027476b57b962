"""The words of programs whose vehicles speak MAVLink: those of all programs, and more."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias

from mmrs_runtime import controllers
from mmrs_runtime.controllers import *  # noqa: F403  # all that programs of any vehicle say
from mmrs_runtime.controllers import GoTo, NoEffect, Notify, Object, Place, Report
from mmrs_runtime.controllers import vocabulary as words

from .profiles import ARDUPILOT, VehicleProfile, profile_for

__all__ = ["Action", "Charge", "Measure", "Operate", "Robot", "Run", "TakeOff", "Travel"]
__all__ += controllers.__all__


@dataclass(frozen=True, slots=True)
class TakeOff:
    """Climb straight up to a height above home."""

    height: float


@dataclass(frozen=True, slots=True)
class Operate:
    """A device action: a MAVLink command with its parameters, and its duration.

    Attributes:
        more: further commands with their parameters, which follow at once.
        confirmed: whether the vehicle reports each image that it takes (CAMERA_IMAGE_CAPTURED
            or CAMERA_FEEDBACK), so that silence is a fault.
        trial: whether it may be tried on the ground, before take-off.
    """

    device: str
    action: str
    command: int
    params: tuple[float, ...]
    seconds: float = 0.0
    more: tuple[tuple[int, tuple[float, ...]], ...] = ()
    confirmed: bool = False
    trial: bool = False


@dataclass(frozen=True, slots=True)
class Measure:
    """Record the next value that the vehicle publishes under a name (NAMED_VALUE_FLOAT)."""

    device: str
    action: str
    value: str
    seconds: float = 0.0


Action: TypeAlias = Notify | Report | Operate | Measure | NoEffect


@dataclass(frozen=True, slots=True)
class Run:
    """Moves without a stop between them, uploaded as a mission and flown in one go.

    Attributes:
        moves: GoTo moves in order.
        holds: seconds to hold at the end of each, so that corners are not cut.
    """

    moves: tuple[str, ...]
    holds: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Travel:
    """How carefully a robot travels.

    Attributes:
        mode: ``SAFE``, ``NORMAL`` or ``AGGRESSIVE``; speeds stand with the moves.
        acceptance: metres from a place at which the controller counts it as reached.
        radius: metres within which the vehicle counts places of a run as passed, at most.
        margin: metres that the vehicle keeps from what it perceives itself, at least.
        turning_radius: of its narrowest curve, metres; 0: it turns on its own.
        climb, descent: its type's largest vertical speeds, metres per second; None where unknown.
        turn_rate: its type's largest, degrees per second; None where unknown.
    """

    mode: str = "NORMAL"
    acceptance: float = 0.5
    radius: float = 2.0
    margin: float = 0.0
    turning_radius: float = 0.0
    climb: float | None = None
    descent: float | None = None
    turn_rate: float | None = None


@dataclass(frozen=True, slots=True)
class Charge:
    """What full batteries hold, and what sorties take of them.

    Attributes:
        energy: joules in full batteries of the robot's type.
        voltage: nominal; None where unknown, or where batteries differ.
        least, most: seconds that the first sortie takes; `most` is None where nothing bounds it.
        longest: seconds that any sortie takes at most; None where nothing bounds it.
    """

    energy: float
    voltage: float | None
    least: float
    most: float | None
    longest: float | None


@dataclass(frozen=True)
class Robot(words.Robot):
    """One robot whose vehicle speaks MAVLink, such as a ``copter``, and all its moves.

    Attributes:
        endurance: seconds that a full battery lasts at the type's mean power; None where unknown.
        charge: what its batteries are to hold, and what its sorties take of that; None where unknown.
        fastest: its type's largest speed through air or water, metres per second; None where unknown.
        fence: polygons to stay out of; rally: emergency positions.
        tight: what operators must know of these.
        straight: whether the vehicle may fly straight to the nearest rally point from anywhere on its path.
        neighbours: homes of the others whose vehicles might be taken for this robot's, by robot.
        travel: travel mode.
        driven_by: ``module:name`` of the profile of a plug-in that drives its vehicle; empty: one of ours.
        autopilot: whose times count for its plan, as the device property ``mavlink.autopilot`` names it.
    """

    endurance: float | None = field(default=None, kw_only=True)
    charge: Charge | None = field(default=None, kw_only=True)
    fastest: float | None = field(default=None, kw_only=True)
    runs: tuple[Run, ...] = field(default=(), kw_only=True)
    fence: tuple[tuple[Place, ...], ...] = field(default=(), kw_only=True)
    rally: tuple[Place, ...] = field(default=(), kw_only=True)
    straight: bool = field(default=True, kw_only=True)
    tight: tuple[str, ...] = field(default=(), kw_only=True)
    neighbours: tuple[tuple[str, Place], ...] = field(default=(), kw_only=True)
    travel: Travel = field(default=Travel(), kw_only=True)
    driven_by: str = field(default="", kw_only=True)
    autopilot: str = field(default=ARDUPILOT.name, kw_only=True)

    @cached_property
    def profile(self) -> VehicleProfile:
        """Return the profile of its class of vehicle, whose autopilot may be another one.

        Raises:
            ValueError: there is none, as where its plug-in is not installed.
        """
        return profile_for(self.vehicle, self.driven_by)

    @property
    def judged(self) -> Robot:
        """Return its program with the places that its vehicle is judged by; devices look at the true ones."""
        if not self.profile.in_plane:
            return self
        return replace(
            self,
            home=self.profile.level(self.home),
            steps=tuple(replace(step, movement=self._judged(step.movement)) for step in self.steps),
            escapes=tuple((move, tuple(map(self.profile.level, places))) for move, places in self.escapes),
        )

    def _judged(self, movement: object) -> object:
        if not isinstance(movement, GoTo):
            return movement
        at = movement.at if isinstance(movement.at, Object) else self.profile.level(movement.at)
        return replace(movement, at=at, legs="direct")
