"""Thrusters as electronic speed controllers on DroneCAN."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import copysign, isfinite, sqrt
from typing import TYPE_CHECKING, Any

import dronecan

from auv_vessel.control.drives import Status
from auv_vessel.sheet import Thruster
from auv_vessel.wire.frame import Frame
from mmrs_dronecan.transfers import Company, Incoming, Outgoing

if TYPE_CHECKING:
    from collections.abc import Iterator


_NAMES = ("node", "curve", "max-rpm", "arming")


@dataclass(frozen=True, slots=True)
class Options:
    """What can be chosen.

    Attributes:
        node: identifier of the node that commands, 1 to 127.
        square: whether thrust goes with the square of the command.
        max_rpm: revolutions per minute at peak thrust; None: not known.
        arming: whether to say that drives may turn.
    """

    node: int = 10
    square: bool = True
    max_rpm: float | None = None
    arming: bool = True


def options_of(given: Mapping[str, str]) -> Options:
    """Return the options that were given by name.

    Raises:
        ValueError: there is no such option, or its value is none.
    """
    if odd := sorted(given.keys() - set(_NAMES)):
        raise ValueError(f"dronecan: no option {', '.join(odd)}; there are {', '.join(_NAMES)}")
    return Options(
        _node(given.get("node", "10")),
        _one_of("curve", given.get("curve", "square"), "square", "linear"),
        _rpm(given["max-rpm"]) if "max-rpm" in given else None,
        _one_of("arming", given.get("arming", "yes"), "yes", "no"),
    )


def _node(text: str) -> int:
    if not (text.isascii() and text.isdecimal() and len(text) < 4) or not 1 <= int(text) <= 127:
        raise ValueError(f"dronecan: node {text!r} is not 1 to 127")
    return int(text)


def _rpm(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not isfinite(value) or not 0.0 < value <= 131_071.0:
        raise ValueError(f"dronecan: max-rpm {text!r} is not above 0, up to 131071")
    return value


def _one_of(what: str, text: str, yes: str, no: str) -> bool:
    if text not in (yes, no):
        raise ValueError(f"dronecan: {what} {text!r} is neither {yes} nor {no}")
    return text == yes


MOST, LEAST_RAW, MOST_RAW = 20, -8192, 8191
COMMANDS_A_SECOND = 20
STATUS_ID = 1034
_ARMED, _DISARMED = 255, 0


class SpeedControllers:
    """Speaks for the thrusters of one vehicle."""

    def __init__(self, thrusters: Sequence[Thruster], options: Options) -> None:
        """Prepare.

        Raises:
            ValueError: there are more thrusters than a message carries.
        """
        if len(thrusters) > MOST:
            raise ValueError(f"dronecan: {len(thrusters)} thrusters: a RawCommand carries {MOST}")
        self._most = [each.max_thrust for each in thrusters]
        self._options = options
        self._outgoing = Outgoing(options.node)
        self._statuses = Incoming(STATUS_ID)
        self._company = Company(options.node)
        self._condemned = 0
        self._ticks = 0
        self._armed: bool | None = None

    @property
    def faults(self) -> int:
        """Frames and messages of drives that cannot be believed."""
        return self._statuses.faults

    def commands(self, thrusts: Sequence[float], enable: bool) -> list[Frame]:
        """Return the frames that ask for those newtons; not enabled: that no propeller turns.

        Once another node was found to command the drives, none turns any more.
        """
        enable = enable and not self._company.rival
        raw = [self._raw(number, thrust) if enable else 0 for number, thrust in enumerate(thrusts)]
        said = [self._outgoing.frames(dronecan.uavcan.equipment.esc.RawCommand(cmd=raw))]
        said += [self._outgoing.frames(message) for message in self._now_and_then(enable)]
        self._ticks += 1
        return [frame for frames in said for frame in frames]

    def hear(self, frame: Frame) -> Status | None:
        """Return the status of a thruster in a frame, or None."""
        self._company.notice(frame)
        if self._company.rival and self._most:
            self._condemned = (self._condemned + 1) % len(self._most)
            return Status(self._condemned, None, fault=True, runs=False)
        said = self._statuses.message(frame)
        if said is None or said.esc_index >= len(self._most):
            return None
        number, node = int(said.esc_index), frame.id & 0x7F
        fault = self._company.shares(number, node) or node in self._company.ill
        return Status(number, self._thrust(number, int(said.rpm)), fault)

    def _now_and_then(self, enable: bool) -> Iterator[Any]:
        due = self._ticks % COMMANDS_A_SECOND == 0
        if due:
            yield dronecan.uavcan.protocol.NodeStatus(uptime_sec=self._ticks // COMMANDS_A_SECOND)
        if self._options.arming and (due or enable != self._armed):
            self._armed = enable
            yield dronecan.uavcan.equipment.safety.ArmingStatus(status=_ARMED if enable else _DISARMED)

    def _raw(self, number: int, thrust: float) -> int:
        part = max(-1.0, min(1.0, thrust / self._most[number]))
        if self._options.square:
            part = copysign(sqrt(abs(part)), part)
        return round(part * (MOST_RAW if part > 0.0 else -LEAST_RAW))

    def _thrust(self, number: int, rpm: int) -> float | None:
        if self._options.max_rpm is None:
            return None
        part = rpm / self._options.max_rpm
        return self._most[number] * part * abs(part)


def opened(thrusters: Sequence[Thruster], options: Mapping[str, str]) -> SpeedControllers:
    """Return what speaks for thrusters, with options by name.

    Raises:
        ValueError: there are too many, or an option is none.
    """
    return SpeedControllers(thrusters, options_of(options))
