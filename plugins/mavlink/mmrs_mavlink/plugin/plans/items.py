"""Items of missions: MAVLink commands with their parameters, in the order in which they are done."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import nan
from struct import pack, unpack

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.behaviour.program import Move
from mmrs_core.behaviour.travel import TRAVEL_MARGINS
from mmrs_core.contributions.targets import TracedStep
from mmrs_core.scene import Position
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.profiles.autopilot import Missions
from mmrs_mavlink.wiring import Wired

WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, LAND, TAKE_OFF = 16, 17, 19, 21, 22
CONDITION_YAW, CHANGE_SPEED, ROI_LOCATION, ROI_NONE = 115, 178, 195, 197
FENCE_EXCLUSION, RALLY_POINT = 5002, 5100
ABSOLUTE, NO_FRAME, RELATIVE = 0, 2, 3
PARAMETERS = 7
RADIUS, HEADING = 1, 3
"""Places of these among the parameters of what has a place."""

HEADED = frozenset({WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, LAND, TAKE_OFF})


@dataclass(frozen=True, slots=True)
class PlanItem:
    """An item in the local frame.

    Attributes:
        command: number of its MAV_CMD.
        move: that it serves.
        params: at most seven, four where there is a position; the rest is 0.
        position: None for commands without a place.
    """

    command: int
    move: Move
    params: tuple[float, ...] = ()
    position: Position | None = None


@dataclass(frozen=True, slots=True)
class Row:
    """An item as files hold it.

    Attributes:
        number: of the item in its file.
        frame: `RELATIVE` where it has a place, `NO_FRAME` where it has none; home is `ABSOLUTE`.
        params: seven; with a place, the last three are latitude, longitude and height above home.
        step: which move and task it serves.
    """

    number: int
    frame: int
    command: int
    params: tuple[float, ...]
    step: TracedStep

    @property
    def has_place(self) -> bool:
        """Return whether its last three parameters are a place."""
        return self.frame != NO_FRAME


LEAST_ANGLE = 0.25
"""Degrees from which on eight decimals tell two neighbouring numbers of single precision apart."""

FLAGS, ABOVE_HOME = 0b1101, 0b0001
"""Flags of ArduPilot's ``Location``: relative to home, to the terrain, to the origin."""


def angle_like_a_place(angle: float) -> float:
    """Return the nearest angle whose first byte says "above home" if it is taken for a place.

    >>> angle_like_a_place(40.6)
    40.5999870300293
    """
    (bits,) = unpack("<I", pack("<f", max(angle, LEAST_ANGLE)))
    near = sorted(range(-FLAGS, FLAGS + 1), key=abs)
    changed = next(bits + each for each in near if (bits + each) & FLAGS == ABOVE_HOME)
    return float(unpack("<f", pack("<I", changed))[0])


def rows_of(context: VehicleContext, sortie: Sequence[PlanItem]) -> tuple[Row, ...]:
    """Return the items of a sortie, counted from 1: home, where a file has one, is number 0."""
    positions = [item.position for item in sortie if item.position is not None]
    degrees = iter(degrees_of([(east, north) for east, north, _ in positions], context.frame))
    return tuple(_row(number, item, context, degrees) for number, item in enumerate(sortie, start=1))


def _row(number: int, item: PlanItem, context: VehicleContext, degrees: Iterator[tuple[float, float]]) -> Row:
    place: tuple[float, ...] = ()
    if item.position is not None:
        place = (*next(degrees), context.profile.item_height(context.height(item.position)))
    filled = [0.0] * (PARAMETERS - len(place) - len(item.params))
    if context.profile.autopilot.missions.zero_counts:
        filled = _left_open(item, filled, context)
    move = item.move
    step = TracedStep(f"item {number}", context.robot.id, move.id, move.task, move.rule)
    frame = RELATIVE if place else NO_FRAME
    return Row(number, frame, item.command, (*item.params, *filled, *place), step)


def _left_open(item: PlanItem, filled: list[float], context: VehicleContext) -> list[float]:
    """Return the parameters behind those that an item has, for an autopilot with which 0 counts.

    A heading of 0 is north, and none at all is what the vehicle chooses; a radius of 0 is its default.
    """
    before = len(item.params)
    if item.command in HEADED and before <= HEADING:
        filled[HEADING - before] = nan
    if item.command == WAYPOINT and before <= RADIUS:
        filled[RADIUS - before] = TRAVEL_MARGINS[context.robot.travel_mode].radius
    return filled


def unknown_in(wiring: Wired, missions: Missions) -> tuple[int, ...]:
    """Return the commands of a device action that no mission of an autopilot may have."""
    commands = (wiring.command, *(command for command, _ in wiring.more))
    return tuple(each for each in commands if missions.commands is not None and each not in missions.commands)
