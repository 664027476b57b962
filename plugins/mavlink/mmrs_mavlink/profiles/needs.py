"""What commands to devices need of a vehicle's parameters: without it they are refused, or have no effect."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

SET_RELAY, REPEAT_RELAY, SET_SERVO, REPEAT_SERVO, GRIPPER, WINCH = 181, 182, 183, 184, 211, 42600
ROI_LOCATION, GIMBAL_PITCH_YAW = 195, 1000
DIGICAM_CONTROL, TRIGGER_DISTANCE, IMAGE_START_CAPTURE = 203, 206, 2000
VIDEO_START_CAPTURE, VIDEO_STOP_CAPTURE = 2500, 2501

OF_CAMERAS = frozenset({DIGICAM_CONTROL, TRIGGER_DISTANCE, IMAGE_START_CAPTURE, VIDEO_START_CAPTURE})
"""Commands that only a camera carries out."""


@dataclass(frozen=True, slots=True)
class Need:
    """Parameters of which one must have a suitable value.

    Attributes:
        names: of the parameters; none: the autopilot does not carry out the command, whatever they are.
        lacking: what is missing otherwise, as printed.
        values: that suit; empty: all but `off`.
        off: value that stands for none.
        further: what else is needed, by the value that suits.
        older: what counts instead where a vehicle reports it: firmware before these parameters.
    """

    names: tuple[str, ...]
    lacking: str
    values: tuple[int, ...] = ()
    off: int = 0
    further: Mapping[int, Need] = field(default_factory=dict)
    older: Need | None = None

    @property
    def all_names(self) -> tuple[str, ...]:
        """Return the names of all parameters that count, each once."""
        others = (*self.further.values(), *filter(None, (self.older,)))
        further = (name for each in others for name in each.all_names)
        return tuple(dict.fromkeys([*self.names, *further]))

    def judge(self, values: Mapping[str, float]) -> Judgement:
        """Return whether the values of parameters suit; those that are missing are unknown."""
        if self.older is not None and any(name in values for name in self.older.names):
            return self.older.judge(values)
        reported = {name: round(values[name]) for name in self.names if name in values}
        met = {name: value for name, value in reported.items() if self._suits(value)}
        unreported = [name for name in self.names if name not in reported]
        if unreported and not met:
            names = ", ".join(unreported) if reported else _shown(self.names)
            return Judgement(unknown=f"the vehicle does not report {names}")
        if not met:
            return Judgement(defect=self._defect(reported))
        name, value = next(iter(met.items()))
        found = self.further[value].judge(values) if value in self.further else Judgement()
        return Judgement(found.defect, found.unknown, (f"{name} = {value}", *found.met))

    def _suits(self, value: int) -> bool:
        return value in self.values if self.values else value != self.off

    def _defect(self, reported: Mapping[str, int]) -> str:
        if not self.names:
            return self.lacking
        wanted = " or ".join(map(str, self.values)) if len(self.values) <= 4 else ""
        if len(self.names) == 1:
            (value,) = reported.values()
            must = f", and must be {wanted}" if wanted else ""
            return f"{self.names[0]} is {value}{must}: {self.lacking}"
        return f"none of {_shown(self.names)} is {wanted or 'set'}: {self.lacking}"


def _shown(names: Sequence[str]) -> str:
    """Return the names of parameters in their order, in short."""
    return names[0] if len(names) == 1 else f"{names[0]} to {names[-1]}"


@dataclass(frozen=True, slots=True)
class Judgement:
    """Whether a command can have an effect.

    Attributes:
        defect: why it cannot. unknown: why that is not known; both empty: it can.
        met: the parameters that suit, with their values.
    """

    defect: str = ""
    unknown: str = ""
    met: tuple[str, ...] = ()


Params: TypeAlias = tuple[float, ...]
Needs: TypeAlias = Mapping[int, Callable[[Params], Need]]
"""What a command needs, given its parameters, by its number."""


def _output(function: int, lacking: str) -> Need:
    """Return that a servo output must have a function."""
    return Need(tuple(f"SERVO{number}_FUNCTION" for number in range(1, 17)), lacking, (function,))


_RELAY, _CAMERA_RELAY = 1, 4
_RELAYS, _CAMERAS = range(1, 7), (1, 2)
_CAMERA_TRIGGER, _GRIPPER_OUTPUT, _WINCH_OUTPUT = 10, 28, 88
_COMMANDED = (0, 1, 22, 23, 28, *range(51, 67), *range(140, 156))
_BY_SERVO, _BY_RELAY = 1, 2
_RECORDING = (4, 6, 7, 8)


def _relay(params: Params) -> Need:
    number = round(params[0]) + 1
    pin = Need((f"RELAY{number}_PIN",), "the relay has no output", off=-1)
    lacking = f"relay {number - 1} is not switched by commands"
    return Need((f"RELAY{number}_FUNCTION",), lacking, (_RELAY,), further={_RELAY: pin})


def _servo(params: Params) -> Need:
    number = round(params[0])
    lacking = "the output belongs to the vehicle itself, and is set to 0 for commands"
    return Need((f"SERVO{number}_FUNCTION",), lacking, _COMMANDED)


def _gripper(params: Params) -> Need:
    moved = _output(_GRIPPER_OUTPUT, "no output moves the gripper")
    kind = Need(
        ("GRIP_TYPE",), "the gripper has no type (1 is a servo, 2 an EPM)", further={_BY_SERVO: moved}
    )
    return Need(("GRIP_ENABLE",), "the vehicle has no gripper", (1,), further={1: kind})


def _camera(number: int) -> Need:
    wired = {
        _BY_SERVO: _output(_CAMERA_TRIGGER, "no output moves the camera's shutter"),
        _BY_RELAY: Need(
            tuple(f"RELAY{each}_FUNCTION" for each in _RELAYS),
            "no relay moves the camera's shutter",
            (_CAMERA_RELAY,),
        ),
    }
    names = tuple(f"CAM{each}_TYPE" for each in ((number,) if number else _CAMERAS))
    named = f"camera {number}" if number else "camera"
    kinds = "1 is a shutter on a servo output, 2 on a relay; 4 is in a gimbal, 5 and 6 speak MAVLink"
    return Need(names, f"the vehicle has no {named} ({kinds})", further=wired)


def _video(params: Params) -> Need:
    names = tuple(f"CAM{each}_TYPE" for each in ((round(params[0]),) if params[0] else _CAMERAS))
    return Need(names, "the camera records no video", _RECORDING)


def _winch(params: Params) -> Need:
    return Need(
        ("WINCH_TYPE",),
        "the vehicle has no winch (1 is one on a servo output, 2 a Daiwa)",
        further={each: _output(_WINCH_OUTPUT, "no output moves the winch") for each in (1, 2)},
    )


def _gimbal(number: int) -> Need:
    names = tuple(f"MNT{each}_TYPE" for each in ((number,) if number else (1, 2)))
    return Need(names, "the vehicle has no such gimbal")


ON_ARDUPILOT: Needs = {
    SET_RELAY: _relay,
    REPEAT_RELAY: _relay,
    SET_SERVO: _servo,
    REPEAT_SERVO: _servo,
    GRIPPER: _gripper,
    DIGICAM_CONTROL: lambda params: _camera(0),
    TRIGGER_DISTANCE: lambda params: _camera(0),
    IMAGE_START_CAPTURE: lambda params: _camera(round(params[0])),
    VIDEO_START_CAPTURE: _video,
    VIDEO_STOP_CAPTURE: _video,
    WINCH: _winch,
    GIMBAL_PITCH_YAW: lambda params: _gimbal(round(params[6]) if len(params) > 6 else 0),
    ROI_LOCATION: lambda params: _gimbal(round(params[0])),
}
"""Read in ArduPilot 4.7 (``AP_ServoRelayEvents.cpp``, ``AP_Relay.cpp``, ``AP_Camera.cpp``,
``AP_Gripper.cpp``, ``AP_Winch.cpp``, ``AP_Mount.cpp``), and tried on ArduCopter 4.7 in simulation: a relay, a
servo output, a gripper, a winch, a gimbal or a camera that is not set up answers FAILED, but
DO_DIGICAM_CONTROL and DO_SET_CAM_TRIGG_DIST are accepted without any camera.
"""


def _refused_by_px4(what: str) -> Callable[[Params], Need]:
    return lambda params: Need((), f"PX4 carries out no {what}")


def _px4_gripper(params: Params) -> Need:
    lacking = "the vehicle has no gripper"
    enabled = Need(("PD_GRIPPER_EN",), lacking, (1,))  # up to PX4 1.16, where each has a type
    return Need(("PD_GRIPPER_TYPE",), lacking, off=-1, older=enabled)


def _px4_trigger(params: Params) -> Need:
    return Need(("TRIG_MODE",), "no camera is triggered (1 is on command, 4 by distance, on command)")


ON_PX4: Needs = {
    SET_RELAY: _refused_by_px4("DO_SET_RELAY"),
    REPEAT_RELAY: _refused_by_px4("DO_REPEAT_RELAY"),
    SET_SERVO: _refused_by_px4("DO_SET_SERVO"),
    REPEAT_SERVO: _refused_by_px4("DO_REPEAT_SERVO"),
    IMAGE_START_CAPTURE: _refused_by_px4("IMAGE_START_CAPTURE; mavlink.camera.command = digicam triggers it"),
    GRIPPER: _px4_gripper,
    DIGICAM_CONTROL: _px4_trigger,
    TRIGGER_DISTANCE: _px4_trigger,
}
"""Read in PX4 1.16 (``Commander.cpp``, ``camera_trigger.cpp``, ``payload_deliverer.cpp``), and tried on its
simulation: it answers UNSUPPORTED to what it does not carry out, and nothing without a trigger or gripper.
PD_GRIPPER_TYPE alone as in PX4 1.17 (``module.yaml`` of ``payload_deliverer``), which was not flown.
"""
