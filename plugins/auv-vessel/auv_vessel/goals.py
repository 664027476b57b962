"""What the decision centre wants of movement, and how it says it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec, Received, Value
from auv_vessel.wire.frame import Frame

GOAL_PERIOD = 0.2
"""Seconds from one repetition of a goal to the next."""

FAREWELL = 0.5
"""Real seconds in which the last goal is still repeated, at the end of a program."""

SLOWEST = 0.02
"""Metres per second, the least speed that a goal can say: less would mean as the vehicle likes."""

GOALS = 16
"""Numbers that goals have, from 0 on, again and again."""


@dataclass(frozen=True, slots=True)
class Goal:
    """Where a vehicle is to be, and how it gets there.

    Attributes:
        mode: one of `catalogue.MODES`.
        north, east, depth: metres. SURFACE and TURN start at the current position instead.
        heading: degrees, unless `along`.
        speed: metres per second at most; 0: as the vehicle likes.
        along: whether it faces the direction in which it goes, and any at its goal.
        number: 0 to 15; another number is another goal.
    """

    mode: str = "IDLE"
    north: float = 0.0
    east: float = 0.0
    depth: float = 0.0
    heading: float = 0.0
    speed: float = 0.0
    along: bool = False
    number: int = 0


def goal_frames(codec: Codec, goal: Goal) -> list[Frame]:
    """Return the two frames that say a goal, in the order in which they are to be sent.

    Raises:
        ValueError: a value is beyond what messages hold.
    """
    return [codec.encode(name, **values) for name, values in _said(goal)]


def check_goal(codec: Codec, goal: Goal) -> None:
    """Return if a goal can be said; nothing is.

    Raises:
        ValueError: as `goal_frames`.
    """
    for name, values in _said(goal):
        codec.check(name, **values)


def _said(goal: Goal) -> tuple[tuple[str, dict[str, Value]], ...]:
    """Return the names and values of the messages that say a goal."""
    pose: dict[str, Value] = {
        "Depth": goal.depth,
        "Heading": goal.heading % 360.0,
        "Speed": goal.speed,
        "Mode": goal.mode,
        "FaceAlong": goal.along,
        "Goal": goal.number,
    }
    return ("GoalPlace", {"North": goal.north, "East": goal.east}), ("GoalPose", pose)


def goal_of(place: Received, pose: Received) -> Goal:
    """Return the goal that a place and a pose say."""
    of_place, of_pose = place.values, pose.values
    return Goal(
        mode=str(of_pose["Mode"]),
        north=float(of_place["North"]),
        east=float(of_place["East"]),
        depth=float(of_pose["Depth"]),
        heading=float(of_pose["Heading"]),
        speed=float(of_pose["Speed"]),
        along=bool(of_pose["FaceAlong"]),
        number=int(of_pose["Goal"]),
    )


def within_rating(goal: Goal, sheet: Sheet) -> Goal:
    """Return a goal no deeper and no faster than the vehicle may go."""
    return replace(goal, depth=min(max(goal.depth, 0.0), sheet.max_depth), speed=min(goal.speed, sheet.speed))
