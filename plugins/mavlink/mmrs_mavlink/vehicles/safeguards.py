"""Failsafes of a vehicle: parameters that are checked and listed.

Set are only the answers to a lost link and to a broken fence, where the robot's policies
define them (``modes.py``). All others are its owner's business and only listed, with a warning where the
vehicle has no failsafe, or one would interfere with the program. Meanings are those of ArduCopter 4.5 and
later, ArduPilot's Rover and Sub, and PX4 1.14 and later, as their parameter references give them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from ..links.autopilots import is_px4
from ..links.link import Link
from ..services import parameters


@dataclass(frozen=True, slots=True)
class Safeguard:
    """A parameter.

    Attributes:
        name: of the parameter.
        what: its failsafe's trigger.
        words: its actions, by value; others are listed as numbers, in `unit`.
        doubtful: by value, warnings.
        below: warning about values below a limit: (limit, why).
    """

    name: str
    what: str
    words: Mapping[int, str] = field(default_factory=dict)
    doubtful: Mapping[int, str] = field(default_factory=dict)
    below: tuple[float, str] | None = None
    unit: str = ""

    def line(self, value: float) -> str:
        """Return what the value means, with a warning where there is cause for one."""
        whole = round(value)
        shown = self.words.get(whole, f"{value:g}{self.unit}")
        why = self.doubtful.get(whole)
        if self.below is not None and value < self.below[0]:
            why = self.below[1]
        line = f"{self.name} = {value:g}: {self.what}: {shown}"
        return f"{line} (warning: {why})" if why else line


NOTHING = "no failsafe set"
_LANDING = {1: "return, or land", 2: "land", 3: "SmartRTL, else RTL, else land"}

COPTER = (
    Safeguard(
        "FS_GCS_ENABLE",
        "no heartbeats from the ground",
        {0: "nothing", 1: "return", 2: "continue a mission, else RTL", 5: "land", 7: "brake, or land"}
        | {3: "SmartRTL, else RTL", 4: "SmartRTL, else land"},
    ),
    Safeguard(
        "FS_THR_ENABLE",
        "no signal from the pilot's remote control",
        {0: "nothing", 1: "return", 2: "continue a mission, else RTL", 3: "land"}
        | {4: "SmartRTL, else RTL", 5: "SmartRTL, else land", 6: "mission's landing"},
        {0: "a pilot whose remote control fails can not take over, and nothing happens"},
    ),
    Safeguard(
        "BATT_FS_LOW_ACT",
        "battery low",
        {0: "nothing", 1: "land", 2: "return", 3: "SmartRTL, else RTL"}
        | {4: "SmartRTL, else land", 5: "stop the motors", 6: "mission's landing"},
        {0: NOTHING, 5: "it falls"},
    ),
    Safeguard(
        "BATT_FS_CRT_ACT",
        "battery critical",
        {0: "nothing", 1: "land", 2: "return", 5: "stop the motors"},
        {0: NOTHING, 5: "it falls"},
    ),
    Safeguard("FENCE_ENABLE", "the fence", {0: "off", 1: "on"}),
    Safeguard(
        "FENCE_ACTION",
        "fence broken",
        {0: "say so only", 4: "brake, or land", 5: "SmartRTL, else land"} | _LANDING,
        {0: "nothing stops it"},
    ),
    Safeguard(
        "FS_EKF_ACTION",
        "position lost",
        {0: "say so only", 1: "land, or hold its height", 2: "hold its height", 3: "land"},
        {0: "it flies on without a position", 2: "the wind carries it until its program lands it"},
    ),
    Safeguard("RTL_ALT", "height at which it returns", unit=" cm"),
    Safeguard("RTL_ALT_M", "height at which it returns", unit=" m"),
    Safeguard("AUTO_OPTIONS", "options of missions"),
    Safeguard(
        "DISARM_DELAY",
        "seconds on the ground until it disarms",
        below=(5.0, "it may disarm before its take-off command"),
        unit=" s",
    ),
    Safeguard("FLTMODE_GCSBLOCK", "modes that the ground must not choose"),
)

ROVER = (
    Safeguard("FS_GCS_ENABLE", "no heartbeats from the ground", {0: "nothing", 1: "as FS_ACTION says"}),
    Safeguard(
        "FS_ACTION",
        "link lost",
        {0: "nothing", 1: "return", 2: "hold", 3: "SmartRTL", 5: "disarm"},
    ),
    Safeguard("FS_THR_ENABLE", "no signal from the pilot's remote control", {0: "nothing"}, {0: NOTHING}),
    Safeguard("BATT_FS_LOW_ACT", "battery low", {0: "nothing", 1: "return", 2: "hold"}, {0: NOTHING}),
    Safeguard("FENCE_ENABLE", "the fence", {0: "off", 1: "on"}),
    Safeguard("FENCE_ACTION", "fence broken", {0: "say so only", 1: "return", 2: "hold"}, {0: NOTHING}),
    Safeguard("FS_EKF_ACTION", "position lost", {0: "nothing", 1: "hold", 2: "say so only"}, {0: NOTHING}),
)

SUB = (
    Safeguard(
        "FS_GCS_ENABLE",
        "no heartbeats from the ground",
        {0: "nothing", 1: "warn", 2: "disarm", 3: "hold its depth", 4: "surface"},
        {2: "its motors stop wherever it is"},
    ),
    Safeguard(
        "FS_PILOT_INPUT",
        "a pilot's sticks, once used, fall silent",
        {0: "nothing", 1: "warn", 2: "disarm"},
        {2: "its motors stop in every mode where a joystick that was in use since it was switched on does"},
    ),
    Safeguard("BATT_FS_LOW_ACT", "battery low", {0: "nothing", 2: "disarm", 3: "surface"}, {0: NOTHING}),
    Safeguard("FS_LEAK_ENABLE", "water inside", {0: "nothing", 1: "warn", 2: "surface"}, {0: NOTHING}),
    Safeguard("FS_EKF_ACTION", "position lost", {0: "nothing", 1: "warn", 2: "disarm"}),
)

_PX4_ACTIONS = {0: "nothing", 1: "hold", 2: "return", 3: "land", 5: "terminate", 6: "stop the motors"}
PX4 = (
    Safeguard("NAV_DLL_ACT", "no heartbeats from the ground", _PX4_ACTIONS, {5: "it falls", 6: "it falls"}),
    Safeguard("COM_DL_LOSS_T", "seconds until the ground counts as lost", unit=" s"),
    Safeguard(
        "NAV_RCL_ACT",
        "no signal from the pilot's remote control",
        {1: "hold", 2: "return", 3: "land", 5: "terminate", 6: "stop the motors"},
    ),
    Safeguard(
        "COM_LOW_BAT_ACT",
        "battery low",
        {0: "warn", 2: "land when critical", 3: "return when critical, land in an emergency"},
        {0: NOTHING},
    ),
    Safeguard(
        "GF_ACTION",
        "fence broken",
        {0: "nothing", 1: "warn", 2: "hold", 3: "return", 4: "terminate", 5: "land"},
        {0: "nothing stops it", 1: "nothing stops it", 4: "it falls"},
    ),
    Safeguard(
        "COM_OBL_RC_ACT",
        "set-points end",
        {0: "hold by hand", 1: "by hand", 2: "by hand", 3: "return", 4: "land", 5: "hold"}
        | {6: "terminate", 7: "stop the motors"},
        {6: "it falls", 7: "it falls"},
    ),
    Safeguard(
        "COM_DISARM_LAND",
        "seconds after landing until it disarms",
        below=(0.1, "it never does, and its landing is taken for one that does not end"),
        unit=" s",
    ),
    Safeguard(
        "MAV_FWDEXTSP",
        "set-points from outside",
        {0: "passed over", 1: "heeded"},
        {0: "it goes into no OFFBOARD, in which it is steered"},
    ),
    Safeguard("COM_OF_LOSS_T", "seconds until set-points count as ended", unit=" s"),
    Safeguard("COM_FAIL_ACT_T", "seconds that it holds before its failsafe returns or lands", unit=" s"),
    Safeguard("COM_POS_FS_DELAY", "seconds until a lost position counts", unit=" s"),
    Safeguard("RTL_RETURN_ALT", "height at which it returns", unit=" m"),
    Safeguard(
        "COM_DISARM_PRFLT",
        "seconds on the ground until it disarms",
        below=(5.0, "it may disarm before its take-off command"),
        unit=" s",
    ),
)

OF_ARDUPILOT: Mapping[str, tuple[Safeguard, ...]] = {"copter": COPTER, "rover": ROVER, "sub": SUB}


def safeguards_of(link: Link, kind: str) -> tuple[Safeguard, ...]:
    """Return the parameters that matter for a kind of vehicle with the autopilot at a link."""
    return PX4 if is_px4(link) else OF_ARDUPILOT[kind]


def report(link: Link, kind: str, instead: Sequence[Safeguard] = ()) -> Iterator[str]:
    """Yield a line for each safeguard that the vehicle tells, and one if it tells none.

    Args:
        link: to the vehicle.
        kind: of the vehicle.
        instead: told in place of those of the same name.
    """
    safeguards = {each.name: each for each in (*safeguards_of(link, kind), *instead)}
    values = parameters.read(link, list(safeguards))
    if not values:
        yield "the vehicle reports none of its failsafe parameters: check its failsafes yourself"
    for name, safeguard in safeguards.items():
        if name in values:
            yield safeguard.line(values[name])
