"""What an autopilot does alike with all classes of vehicles: its dialect of MAVLink, as a value."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from .needs import Needs

WAYPOINT, LOITER_UNLIMITED, LOITER_TIME, RETURN_TO_LAUNCH, LAND, TAKE_OFF = 16, 17, 19, 20, 21, 22
ROI_LOCATION, CAMERA_TRIGGER_DISTANCE, RALLY_POINT = 195, 206, 5100
"""Numbers of MAV_CMD: what reads a program needs no library of MAVLink."""

MISSION, RALLY = 0, 2
"""Kinds of plans (MAV_MISSION_TYPE)."""

INT32, REAL32 = 6, 9
WHOLE: Mapping[int, str] = {1: "<Bxxx", 2: "<bxxx", 3: "<Hxx", 4: "<hxx", 5: "<I", INT32: "<i"}
"""How whole numbers are copied into the four bytes of a number of single precision, by MAV_PARAM_TYPE."""


@dataclass(frozen=True, slots=True)
class Keeping:
    """What an autopilot keeps of items that are uploaded: other differences are faults.

    Attributes:
        params: by command, the parameters (0 to 3) that are kept; all of commands that are not here.
        degrees: units of the seventh decimal that places may lose.
        heights: metres that heights may lose, by kind of plan.
        wraps: whether headings come back as another number for the same direction.
    """

    params: Mapping[int, tuple[int, ...]] = field(default_factory=dict)
    degrees: int = 1
    heights: Mapping[int, float] = field(default_factory=lambda: {MISSION: 0.02, RALLY: 0.02})
    wraps: bool = False


@dataclass(frozen=True, slots=True)
class Missions:
    """How an autopilot wants missions.

    Attributes:
        begins_with_home: whether item 0 is home, which also an empty mission has and which is its own.
        commands: numbers of MAV_CMD that missions may have; None: all.
        whole_seconds: whether holds are kept in whole seconds, and the rest is cut off.
        zero_counts: whether a parameter of 0 means 0: a heading of 0 north, and a radius of 0 the default.
        turns: whether it turns on the spot by CONDITION_YAW, and not only at a waypoint.
        judged: whether it judges a mission that it has stored, and may not fly it.
        keeps_speed: whether a run begins at the speed that an earlier one has set.
        starts_itself: parameter that is 1 where a run begins elsewhere, or uncommanded, and what happens.
        gimbal_looks: parameter that is not 0 where a gimbal turns to what the vehicle is to look at; empty:
            any does that turns sideways.
    """

    begins_with_home: bool = True
    commands: frozenset[int] | None = None
    whole_seconds: bool = True
    zero_counts: bool = False
    turns: bool = True
    judged: bool = False
    keeps_speed: bool = False
    starts_itself: tuple[str, str] = ("", "")
    gimbal_looks: str = ""


@dataclass(frozen=True, slots=True)
class FenceLimit:
    """A limit of a vehicle's own fence: a parameter in metres, 0 for none, and its bit of the types."""

    parameter: str
    of: Literal["radius", "height"]
    bit: int = 0


@dataclass(frozen=True, slots=True)
class OwnFence:
    """The fence that a vehicle has beside the areas of its program.

    Attributes:
        limits: about home.
        enabled_by: parameter that is 0 where it has none; empty: it always has.
        types: parameter with the bits of the limits that count; empty: all do.
        polygons: bit of areas that are uploaded.
        rally_limit: parameter for the kilometres beyond which no rally point is returned to; empty: none.
        margin: parameter for the metres from it at which a vehicle that drives halts; empty: none.
    """

    limits: tuple[FenceLimit, ...]
    enabled_by: str = ""
    types: str = ""
    polygons: int = 0
    rally_limit: str = ""
    margin: str = ""


def always(armed: bool, mode: int) -> bool:
    """Return that a vehicle must always report that its checks pass."""
    return True


def never(armed: bool, mode: int) -> bool:
    """Return that a vehicle need not report that its checks pass, unless it announces that it has some."""
    return False


@dataclass(frozen=True, slots=True)
class Autopilot:
    """What an autopilot does alike with all classes of vehicles.

    Attributes:
        name: as the device property ``mavlink.autopilot`` names it.
        title: as printed.
        number: of MAV_AUTOPILOT, which heartbeats report.
        guidance: its `vehicles.guidance.Guidance`, as ``module:class``: how it is steered, step by step.
        streams: whether it is steered by a stream of set-points that move towards their target; otherwise a
            target is sent once, and again only where the vehicle does not go there.
        restores_mode: whether it returns, as it disarms, to the last mode that it may be armed in.
        streamed: messages that it alone knows, with the rate at which they are requested, hertz.
        integers: parameters of 32-bit whole numbers; others are of single precision.
        copies_bytes: whether the bytes of whole numbers are copied into parameters, and not their values.
        missions: how it wants missions.
        keeping: what it keeps of uploaded items.
        fence: its own.
        avoids: parameter that is 0 where it keeps to its path whatever is in the way.
        margins: parameters for the metres that it keeps from what it perceives.
        counts_any_station: whether its failsafe waits until no ground station at all is received.
        stations: parameters with the systems that count as its ground station: the only one, in older
            versions; the first, and the last, which is 0 where the first is the only one; empty: any counts.
        must_report_checks: whether a vehicle that may be armed, in a mode, must report that its checks pass.
        refusals: beginnings of texts about why it does not arm, in lower case.
        crashed: beginnings of its texts when it disarms because it has crashed, in lower case.
        announcements: parts of its texts when a failsafe acts, in lower case, by event of policies.
        needs: what commands to devices need of its parameters; what is not here is unknown.
        capacities: for each battery, the parameter for its milliampere-hours, the one for its monitor, and
            the values of the monitor without a battery of its own.
    """

    name: str
    title: str
    number: int
    guidance: str
    streams: bool = False
    restores_mode: bool = False
    streamed: Mapping[str, float] = field(default_factory=dict)
    integers: frozenset[str] = frozenset()
    copies_bytes: bool = False
    missions: Missions = Missions()
    keeping: Keeping = Keeping()
    fence: OwnFence = OwnFence(())
    avoids: str = ""
    margins: tuple[str, ...] = ()
    counts_any_station: bool = False
    stations: tuple[str, str, str] = ("", "", "")
    must_report_checks: Callable[[bool, int], bool] = never
    refusals: tuple[str, ...] = ()
    crashed: tuple[str, ...] = ()
    announcements: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    needs: Needs = field(default_factory=dict)
    capacities: tuple[tuple[str, str, tuple[int, ...]], ...] = ()

    def encoded(self, name: str, value: float) -> tuple[float, int]:
        """Return the value of a parameter as messages carry it, and its MAV_PARAM_TYPE."""
        if name not in self.integers:
            return value, REAL32
        if not self.copies_bytes:
            return value, INT32
        (coded,) = struct.unpack("<f", struct.pack(WHOLE[INT32], round(value)))
        return float(coded), INT32

    def decoded(self, value: float, kind: int) -> float:
        """Return the value of a parameter that a message carries as a MAV_PARAM_TYPE."""
        form = WHOLE.get(kind)
        if form is None or not self.copies_bytes:
            return float(value)
        (whole,) = struct.unpack(form, struct.pack("<f", value))
        return float(whole)
