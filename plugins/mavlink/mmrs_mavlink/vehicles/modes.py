"""Flight modes by autopilot and vehicle class, and the failsafes of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from mmrs_runtime.faults import BATTERY_LOW, FENCE_BREACHED, POSITION_LOST
from mmrs_runtime.faults import LINK_LOST as LOST_LINK

from ..links.autopilots import is_px4

if TYPE_CHECKING:
    from ..links.link import Link

Answers: TypeAlias = Mapping[str, Mapping[str, int]]
"""Parameters and their values, by response of a policy."""

GUIDED = "guided"
AUTO = "auto"
HOLD = "hold"
LAND = "land"
SURFACE = "surface"

MODES: Mapping[str, Mapping[str, int]] = {
    "copter": {GUIDED: 4, AUTO: 3, HOLD: 17, LAND: 9},
    "sub": {GUIDED: 4, AUTO: 3, HOLD: 16, SURFACE: 9},
    "rover": {GUIDED: 15, AUTO: 10, HOLD: 4},
}
"""ArduPilot's numbers, by kind of vehicle."""

PX4_MODES: Mapping[str, tuple[int, int]] = {
    GUIDED: (6, 0),
    AUTO: (4, 4),
    HOLD: (4, 3),
    LAND: (4, 6),
}
"""PX4's main mode and sub-mode (``px4_custom_mode.h``): OFFBOARD, and of AUTO mission, loiter, land."""


@dataclass(frozen=True, slots=True)
class Mode:
    """A mode: its encoding in heartbeats, and the parameters of the command that requests it."""

    number: int
    params: tuple[float, ...]


def modes_of(link: Link, kind: str) -> Mapping[str, Mode]:
    """Return the modes of the vehicle at a link, by the runtime's words."""
    if is_px4(link):
        return {
            name: Mode(px4_number(main, sub), (1.0, float(main), float(sub)))
            for name, (main, sub) in PX4_MODES.items()
        }
    return {name: Mode(number, (1.0, float(number))) for name, number in MODES[kind].items()}


OTHERS: Mapping[str, Mapping[int, str]] = {
    "copter": {
        0: "stabilize",
        1: "acro",
        2: "altitude hold",
        5: "loiter",
        6: "return",
        16: "position hold",
        21: "smart return",
    },
    "sub": {0: "stabilize", 1: "acro", 2: "depth hold", 19: "manual"},
    "rover": {0: "manual", 1: "acro", 3: "steering", 5: "loiter", 11: "return", 12: "smart return"},
}
PX4_OTHERS: Mapping[tuple[int, int], str] = {
    (1, 0): "manual",
    (2, 0): "altitude",
    (3, 0): "position",
    (4, 2): "take-off",
    (4, 5): "return",
    (5, 0): "acro",
    (7, 0): "stabilize",
}
"""Modes that programs never request, by name."""


def word_of(link: Link, kind: str, number: int) -> str:
    """Return the name of a mode, or its number where it has no name here."""
    for word, mode in modes_of(link, kind).items():
        if mode.number == number:
            return word
    if is_px4(link):
        return {px4_number(*each): word for each, word in PX4_OTHERS.items()}.get(number, str(number))
    return OTHERS[kind].get(number, str(number))


FAILSAFES: Mapping[str, frozenset[int]] = {
    "copter": frozenset({2, 6, 9, 17, 21}),
    "rover": frozenset({4, 11, 12}),
    "sub": frozenset({9, 16, 19}),
}
PX4_FAILSAFES = frozenset({(4, 3), (4, 5), (4, 6)})


def of_failsafes(link: Link, kind: str) -> frozenset[int]:
    """Return the numbers of the modes of a vehicle's failsafes."""
    if is_px4(link):
        return frozenset(px4_number(main, sub) for main, sub in PX4_FAILSAFES)
    return FAILSAFES[kind]


FIRST_MODE = 0
"""The mode that ArduPilot starts in by default."""

PX4_OWN = (4, 6)
"""Main modes of a PX4 that flies autonomously, or under a program."""


def is_pilots(link: Link, kind: str, number: int) -> bool:
    """Return whether only a pilot puts a vehicle into the mode of a number."""
    if is_px4(link):
        return number >> 16 & 0xFF not in PX4_OWN
    own = {mode.number for mode in modes_of(link, kind).values()}
    return number not in own | FAILSAFES[kind] | {FIRST_MODE}


ANSWERS: Mapping[str, Mapping[str, frozenset[int]]] = {
    "copter": {
        POSITION_LOST: frozenset({9}),
        FENCE_BREACHED: frozenset({6, 9, 17, 21}),
        BATTERY_LOW: frozenset({6, 9, 17, 21}),
        LOST_LINK: frozenset({6, 9, 17, 21}),
    },
    "rover": {event: frozenset({4, 11, 12}) for event in (FENCE_BREACHED, BATTERY_LOW, LOST_LINK)}
    | {POSITION_LOST: frozenset({4})},
    "sub": {event: frozenset({9}) for event in (POSITION_LOST, BATTERY_LOW, LOST_LINK)},
}
"""Modes of ArduPilot's failsafes, by the event that they answer.

A pilot who takes over because of an event chooses another: the event alone is not a reason to
bring the vehicle back. Modes that a pilot may choose as well (to hold the height without a position) are left
out: there the vehicle must have named the mode.
"""

NAMED: Mapping[str, Mapping[str, int]] = {"copter": {"althold": 2, "altitudehold": 2}}
"""Modes that failsafe messages name, in lower case only.

``EKF Failsafe: changed to ALT_HOLD Mode`` (ArduCopter, ``ekf_check.cpp``) with FS_EKF_ACTION = 2.
"""


def answers_to(link: Link, kind: str, event: str, said: Iterable[str] = ()) -> frozenset[int]:
    """Return the numbers of the modes of a vehicle's failsafe for an event.

    Args:
        link: to the vehicle.
        kind: of the vehicle.
        event: of policies.
        said: the vehicle's latest message about the event.
    """
    if is_px4(link):
        return of_failsafes(link, kind)
    letters = ["".join(filter(str.isalpha, text.lower())) for text in said]
    named = NAMED.get(kind, {}).items()
    told = {number for name, number in named if any(f"changedto{name}" in each for each in letters)}
    return ANSWERS[kind].get(event, frozenset()) | told


def px4_number(main: int, sub: int) -> int:
    """Return a PX4 mode as its heartbeat encodes it: the sub-mode above the main mode above 16 bits."""
    return sub << 24 | main << 16


ON_LOST_LINK = "FS_GCS_ENABLE"
ON_ANY_LOSS = "FS_ACTION"
NEAREST = "RALLY_INCL_HOME"
"""Whether home counts as a rally point when a copter returns to the nearest of them."""

FARTHEST = "RALLY_LIMIT_KM"
"""Beyond which a copter goes home instead, where that is nearer; 0: never."""

LINK_LOST: Mapping[str, Mapping[str, Mapping[str, int]]] = {
    "copter": {
        "CONTINUE": {ON_LOST_LINK: 0},
        "RETURN": {ON_LOST_LINK: 3},
        "EMERGENCY_AREA": {NEAREST: 0, FARTHEST: 0, ON_LOST_LINK: 1},
        "LAND": {ON_LOST_LINK: 5},
        "HOLD": {ON_LOST_LINK: 7},
    },
    "sub": {
        "CONTINUE": {ON_LOST_LINK: 1},
        "STOP_THRUST": {ON_LOST_LINK: 2},
        "HOLD": {ON_LOST_LINK: 3},
        "SURFACE": {ON_LOST_LINK: 4},
        "LAND": {ON_LOST_LINK: 4},
        "RETURN": {ON_LOST_LINK: 4},
    },
    "rover": {
        "CONTINUE": {ON_LOST_LINK: 0},
        "RETURN": {ON_ANY_LOSS: 3, ON_LOST_LINK: 1},
        "EMERGENCY_AREA": {NEAREST: 0, FARTHEST: 0, ON_ANY_LOSS: 1, ON_LOST_LINK: 1},
        "HOLD": {ON_ANY_LOSS: 2, ON_LOST_LINK: 1},
        "LAND": {ON_ANY_LOSS: 2, ON_LOST_LINK: 1},
        "STOP_THRUST": {ON_ANY_LOSS: 5, ON_LOST_LINK: 1},
    },
}
"""Parameters of the failsafe for a lost ground station.

By vehicle class and the policy's response, or the nearest possible one: a copter retraces its
path, or flies to the nearest rally point, and lands where it may not hold without limit; a sub surfaces. A
rover obeys its action only where the failsafe of the ground station is enabled, too, which it is
not by default.
"""

ALONE: Mapping[str, tuple[str, Mapping[int, frozenset[int]]]] = {
    "copter": (
        ON_LOST_LINK,
        {
            1: frozenset({6, 9}),
            2: frozenset({3, 6, 9}),
            3: frozenset({6, 9, 21}),
            4: frozenset({9, 21}),
            5: frozenset({9}),
            6: frozenset({3, 6, 9}),
            7: frozenset({9, 17}),
        },
    ),
    "sub": (ON_LOST_LINK, {3: frozenset({2}), 4: frozenset({9})}),
    "rover": (
        ON_ANY_LOSS,
        {
            1: frozenset({4, 11}),
            2: frozenset({4}),
            3: frozenset({4, 11, 12}),
            4: frozenset({4, 12}),
            6: frozenset({4, 5}),
        },
    ),
}
"""Modes of ArduPilot's failsafe for a lost ground station: the parameter, and by its value.

Including the fallback where the first of them is not possible; in other modes it stays as it is, or disarms.
"""

PX4_ON_SILENCE, PX4_ON_STILLNESS = "NAV_DLL_ACT", "COM_OBL_RC_ACT"
"""A PX4's failsafe for a lost ground station, and, in OFFBOARD, for missing set-points."""

PX4_RETURNS_TO = "RTL_TYPE"
"""Whether a PX4 returns to home or a rally point (0 at first), or to a rally point rather than home (1)."""

PX4_HOLDS, PX4_RETURNS, PX4_LANDS = (4, 3), (4, 5), (4, 6)
PX4_ALONE: Mapping[str, Mapping[int, tuple[tuple[int, int], ...]]] = {
    PX4_ON_SILENCE: {
        1: (PX4_HOLDS,),
        2: (PX4_HOLDS, PX4_RETURNS, PX4_LANDS),
        3: (PX4_HOLDS, PX4_LANDS),
    },
    PX4_ON_STILLNESS: {3: (PX4_RETURNS, PX4_LANDS), 4: (PX4_LANDS,), 5: (PX4_HOLDS,)},
}
"""Modes of a PX4's failsafe, by parameter and value, with those where the first is not possible.

Before it returns or lands for a lost station it holds for COM_FAIL_ACT_T, five seconds by default
(``failsafe/framework.cpp``, ``getSelectedAction``); for missing set-points it does so at once.
"""

BREACH: Mapping[str, Answers] = {
    "copter": {
        "CONTINUE": {"FENCE_ACTION": 0},
        "RETURN": {"FENCE_ACTION": 3},
        "EMERGENCY_AREA": {"FENCE_ACTION": 3},
        "LAND": {"FENCE_ACTION": 2},
        "HOLD": {"FENCE_ACTION": 4},
    },
    "rover": {
        "CONTINUE": {"FENCE_ACTION": 0},
        "RETURN": {"FENCE_ACTION": 3},
        "EMERGENCY_AREA": {"FENCE_ACTION": 3},
        "HOLD": {"FENCE_ACTION": 2},
        "LAND": {"FENCE_ACTION": 2},
    },
    "sub": {},
}
"""ArduPilot's failsafe for a broken fence."""

PX4_LINK_LOST: Answers = {
    "CONTINUE": {PX4_ON_STILLNESS: 5, PX4_ON_SILENCE: 0},
    "HOLD": {PX4_ON_STILLNESS: 5, PX4_ON_SILENCE: 1},
    "RETURN": {PX4_ON_STILLNESS: 3, PX4_ON_SILENCE: 2},
    "EMERGENCY_AREA": {PX4_RETURNS_TO: 1, PX4_ON_STILLNESS: 3, PX4_ON_SILENCE: 2},
    "LAND": {PX4_ON_STILLNESS: 4, PX4_ON_SILENCE: 3},
    "STOP_THRUST": {PX4_ON_STILLNESS: 7, PX4_ON_SILENCE: 6},
}
"""A PX4 in OFFBOARD misses set-points before it misses heartbeats, and then acts by their failsafe:
by default, it gives control to the pilot. It cannot continue without set-points: where it is to, it holds.
"""

PX4_BREACH: Answers = {
    "CONTINUE": {"GF_ACTION": 1},
    "HOLD": {"GF_ACTION": 2},
    "RETURN": {"GF_ACTION": 3},
    "EMERGENCY_AREA": {PX4_RETURNS_TO: 1, "GF_ACTION": 3},
    "LAND": {"GF_ACTION": 5},
}
PATIENCE = dict.fromkeys(("copter", "rover", "sub"), ("FS_GCS_TIMEOUT", 2.0, 120.0))
PX4_PATIENCE = ("COM_DL_LOSS_T", 5.0, 300.0)
"""The parameter for the seconds until a link counts as lost, with its least and largest value."""

OFFBOARD_PATIENCE = ("COM_OF_LOSS_T", 5.0, 60.0)
"""The same for set-points. A PX4 misses them after one second at first, in which poor links and busy
computers lose some now and then; until then it goes to the last one, and stays there.
"""

MAV_PARAM_TYPE_INT32 = 6
PARAMETER_KINDS = dict.fromkeys(
    (PX4_ON_SILENCE, PX4_ON_STILLNESS, PX4_RETURNS_TO, "GF_ACTION", "COM_DL_LOSS_T", "COM_TAKEOFF_ACT"),
    MAV_PARAM_TYPE_INT32,
)
"""Types of parameters that are not of single precision."""


def lost_link_answers(link: Link, kind: str) -> Answers:
    """Return the possible failsafes for a lost ground station of the vehicle at a link."""
    return PX4_LINK_LOST if is_px4(link) else LINK_LOST[kind]


def decides_alone(link: Link, kind: str) -> tuple[str, ...]:
    """Return the parameters of the failsafe for a lost ground station of the vehicle at a link."""
    if is_px4(link):
        return tuple(PX4_ALONE)
    return (ON_LOST_LINK, ON_ANY_LOSS) if kind == "rover" else (ON_LOST_LINK,)


def alone(link: Link, kind: str, values: Mapping[str, float]) -> frozenset[int]:
    """Return the numbers of the modes of a vehicle's failsafe for a lost ground station.

    Args:
        link: to the vehicle.
        kind: of the vehicle.
        values: of its parameters; unknown ones add no modes.
    """
    if is_px4(link):
        told = (known.get(round(values.get(name, 0.0)), ()) for name, known in PX4_ALONE.items())
        return frozenset(px4_number(*mode) for modes in told for mode in modes)
    name, known = ALONE[kind]
    if not values.get(ON_LOST_LINK):
        return frozenset()
    return known.get(round(values.get(name, 0.0)), frozenset())


def patience(link: Link, kind: str) -> tuple[str, float, float] | None:
    """Return the parameter for the seconds until a link counts as lost: name, least, largest."""
    return PX4_PATIENCE if is_px4(link) else PATIENCE.get(kind)


def set_point_patience(link: Link) -> tuple[str, float, float] | None:
    """Return the parameter for the seconds until set-points count as lost: name, least, largest."""
    return OFFBOARD_PATIENCE if is_px4(link) else None


def breach_answers(link: Link, kind: str) -> Answers:
    """Return the possible failsafes for a broken fence of the vehicle at a link."""
    return PX4_BREACH if is_px4(link) else BREACH[kind]
