"""Every message on the bus of a vehicle, as plain data: the database (DBC) and all codecs come from here.

Identifiers are fixed, so that recordings and other people's nodes stay readable; a lower one goes first
on the bus. Every message carries a counter and a check over its identifier and the bytes before, where
``guarded`` says so: those decide what thrusters do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import ceil, floor
from typing import NamedTuple, TypeVar

from auv_vessel.refusals import refuse
from auv_vessel.sheet import Sheet, Thruster

Kind = TypeVar("Kind")

VEHICLE, SENSORS, ACTUATORS, MOVEMENT, DECISION = "Vehicle", "Sensors", "Actuators", "Movement", "Decision"
NODES = (VEHICLE, SENSORS, ACTUATORS, MOVEMENT, DECISION)

CLOCK_ID, FORCE_ID, MOMENT_ID, GOAL_POSE_ID = 0x001, 0x080, 0x081, 0x401
EMERGENCY_BASE, COMMAND_BASE, STATUS_BASE, HEARTBEAT_BASE = 0x010, 0x100, 0x140, 0x700

EMERGENCIES: Mapping[str, int] = {f"{node}Emergency": EMERGENCY_BASE + NODES.index(node) for node in NODES}
"""Identifiers of the emergency messages, by name: each node has one of its own, and obeys all."""

MOST_UPTIME = (2**28 - 1) * 0.001
"""Seconds of uptime that a beat holds; it stays at that afterwards."""

COMMAND_PERIOD, STATUS_PERIOD, SENSOR_PERIOD, STATE_PERIOD, BEAT_PERIOD = 0.05, 0.1, 0.05, 0.05, 0.5
SEQUENCE, CHECK = "Sequence", "Check"


@dataclass(frozen=True, slots=True)
class Field:
    """A number in a message; its value is raw * scale + offset.

    Attributes:
        bits: length; whether it has a sign.
        low, high: of the value; what lies outside is refused.
        names: of values, where they are not quantities.
    """

    name: str
    bits: int
    signed: bool = False
    scale: float = 1.0
    unit: str = ""
    low: float = 0.0
    high: float = 0.0
    names: tuple[str, ...] = ()
    comment: str = ""


@dataclass(frozen=True, slots=True)
class Message:
    """A message: its fields follow each other from bit 0 on, least significant bit first.

    Attributes:
        period: seconds between two of them; None: sent when there is something to say.
        guarded: whether an 8-bit counter and a check of 8 bits end it.
    """

    id: int
    name: str
    sender: str
    fields: tuple[Field, ...]
    period: float | None = None
    guarded: bool = True
    comment: str = ""


def _signed(name: str, bits: int, scale: float, unit: str) -> Field:
    most = (2 ** (bits - 1) - 1) * scale
    return Field(name, bits, True, scale, unit, -most, most)


def _unsigned(name: str, bits: int, scale: float, unit: str, comment: str = "") -> Field:
    return Field(name, bits, False, scale, unit, 0.0, (2**bits - 1) * scale, comment=comment)


def _body(bits: int, scale: float, unit: str) -> tuple[Field, ...]:
    return tuple(_signed(name, bits, scale, unit) for name in ("Surge", "Sway", "Heave"))


def _turns(scale: float, unit: str) -> tuple[Field, ...]:
    return tuple(_signed(name, 16, scale, unit) for name in ("Roll", "Pitch", "Yaw"))


def _place() -> tuple[Field, ...]:
    return (_signed("North", 24, 0.001, "m"), _signed("East", 24, 0.001, "m"))


def _angles() -> tuple[Field, ...]:
    leaning = tuple(_signed(name, 16, 0.01, "deg") for name in ("Roll", "Pitch"))
    return (*leaning, _unsigned("Heading", 16, 0.01, "deg"))


def _named(name: str, bits: int, *names: str) -> Field:
    return Field(name, bits, False, 1.0, "", 0.0, float(2**bits - 1), names)


def _flag(name: str, comment: str = "") -> Field:
    return Field(name, 1, False, 1.0, "", 0.0, 1.0, comment=comment)


MODES = ("IDLE", "HOLD", "GO_TO", "TURN", "SURFACE", "SEARCH")
PROGRESS = ("NONE", "ACTIVE", "REACHED", "FAILED")
DRIVES = ("OFF", "RUNS", "WATCHDOG", "FAULT")
REASONS = (
    "NONE", "ORDERED", "COMMANDS_SILENT", "SENSORS_SILENT", "LEAK", "THRUSTER_FAULT", "TOO_DEEP", "BATTERY",
    "POLICY", "TWO_SENDERS",
)  # fmt: skip


def _goal_pose(scale: float) -> Message:
    """Return the message of goals, with metres of depth in a step, as fine as 16 bits allow for a vehicle."""
    fields = (
        _unsigned("Depth", 16, scale, "m"), _unsigned("Heading", 16, 0.01, "deg"),
        _unsigned("Speed", 8, 0.02, "m/s"), _named("Mode", 3, *MODES), _flag("FaceAlong"),
        _unsigned("Goal", 4, 1.0, ""),
    )  # fmt: skip
    return Message(GOAL_POSE_ID, "GoalPose", DECISION, fields, 0.2,
                   comment="repeated; Goal changes when another goal begins")  # fmt: skip


def _wrench(newtons: float, newton_metres: float) -> tuple[Message, Message]:
    """Return the messages of a force and its moment, with so much in a step of each."""
    level = tuple(_signed(name, 16, newtons, "N") for name in ("Surge", "Sway"))
    force = (*level, _signed("Heave", 15, newtons, "N"), _flag("Enable"))
    return (
        Message(FORCE_ID, "WrenchForce", MOVEMENT, force, COMMAND_PERIOD,
                comment="force on the body; obeyed when its moment comes"),
        Message(MOMENT_ID, "WrenchMoment", MOVEMENT, _turns(newton_metres, "N.m"), COMMAND_PERIOD,
                comment="moment on the body; its counter is that of its force"),
    )  # fmt: skip


COMMON = (
    Message(CLOCK_ID, "Clock", VEHICLE, (_unsigned("Time", 32, 0.001, "s"),), None,
            comment="simulated time: nodes that go by it tick when it has come"),
    *(Message(EMERGENCIES[f"{node}Emergency"], f"{node}Emergency", node,
              (_named("Reason", 8, *REASONS), _flag("Release")), None,
              comment="thrust zero at once; Release: let go of the drop weight") for node in NODES),
    *_wrench(0.02, 0.01),
    Message(0x0A0, "Reach", ACTUATORS,
            (*(_flag(degree) for degree in ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")),
             _flag("Limited", "the wrench asks for more than thrusters may give"),
             _unsigned("Thrusters", 6, 1.0, "", "that work")),
            STATUS_PERIOD, comment="degrees of freedom that the thrusters that work can push along"),
    Message(0x200, "Pressure", VEHICLE,
            (_unsigned("Pressure", 32, 1.0, "Pa", "absolute"), _signed("Temperature", 16, 0.01, "degC")),
            SENSOR_PERIOD),
    Message(0x201, "Rates", VEHICLE, _turns(0.01, "deg/s"), SENSOR_PERIOD),
    Message(0x202, "Attitude", VEHICLE, _angles(), SENSOR_PERIOD),
    Message(0x203, "Acceleration", VEHICLE, _body(16, 0.001, "m/s2"), SENSOR_PERIOD),
    Message(0x204, "GroundSpeed", VEHICLE,
            (*_body(15, 0.001, "m/s"), _flag("Valid")), 0.2, comment="of the Doppler log, over ground"),
    Message(0x205, "Altitude", VEHICLE, (_unsigned("Altitude", 16, 0.01, "m"), _flag("Valid")), 0.2,
            comment="above the bottom"),
    Message(0x206, "Fix", VEHICLE, _place(), 1.0,
            comment="of the satellite receiver, at the surface only"),
    Message(0x207, "Health", VEHICLE,
            (_flag("Leak"), _unsigned("Charge", 15, 0.0001, "", "part of the battery that is left"),
             _unsigned("Power", 16, 0.1, "W"),
             _unsigned("SonarRange", 16, 0.01, "m", "ahead; 655.35: nothing seen")), 0.2),
    Message(0x300, "Position", SENSORS, _place(), STATE_PERIOD),
    Message(0x301, "Depth", SENSORS,
            (_signed("Depth", 24, 0.001, "m"),
             _unsigned("Uncertainty", 16, 0.01, "m", "of the position, one sigma"),
             _flag("Trusted", "depth, heading and position may be relied on")), STATE_PERIOD),
    Message(0x302, "Pose", SENSORS, _angles(), STATE_PERIOD),
    Message(0x303, "Velocity", SENSORS, _body(16, 0.001, "m/s"), STATE_PERIOD),
    Message(0x304, "Turning", SENSORS, _turns(0.01, "deg/s"), STATE_PERIOD),
    Message(0x305, "Current", SENSORS,
            (_signed("North", 16, 0.001, "m/s"), _signed("East", 16, 0.001, "m/s")), 0.2,
            comment="of the water over ground, as far as it is known"),
    Message(0x400, "GoalPlace", DECISION, _place(), 0.2,
            comment="obeyed when its pose comes"),
    _goal_pose(0.01),
    Message(0x402, "Progress", MOVEMENT,
            (_unsigned("Goal", 4, 1.0, ""), _named("State", 2, *PROGRESS),
             _unsigned("Distance", 16, 0.01, "m")), 0.1),
    Message(0x500, "DeviceCommand", DECISION,
            (_unsigned("Device", 8, 1.0, ""), _unsigned("Action", 8, 1.0, ""),
             _signed("Parameter", 24, 0.001, ""), _unsigned("Request", 8, 1.0, "")), None,
            comment="repeated until its status comes"),
    Message(0x501, "DeviceStatus", VEHICLE,
            (_unsigned("Device", 8, 1.0, ""), _unsigned("Request", 8, 1.0, ""),
             _named("State", 2, *PROGRESS)), None),
)  # fmt: skip

BEATS = tuple(
    Message(HEARTBEAT_BASE + number, f"{node}Beat", node,
            (_named("State", 4, "STARTS", "RUNS", "FAILS_SAFE", "ENDS"), _unsigned("Uptime", 28, 0.001, "s"),
             _named("Reason", 8, *REASONS)), BEAT_PERIOD)
    for number, node in enumerate(NODES)
)  # fmt: skip


def by_id(named: Mapping[str, Kind]) -> dict[int, Kind]:
    """Return what belongs to messages that every vehicle has, by their identifiers instead of their names.

    Raises:
        KeyError: there is no such message.
    """
    ids = {message.name: message.id for message in (*COMMON, *BEATS)}
    return {ids[name]: each for name, each in named.items()}


def depth_step(max_depth: float) -> float:
    """Return how many metres a step of a goal's depth is, for a vehicle that dives so deep."""
    return max(1, ceil(max_depth * 100.0 / 65535.0)) / 100.0


def wrench_steps(thrusters: Sequence[Thruster]) -> tuple[float, float]:
    """Return how many newtons and newton metres a step of a wrench is: all that thrusters give has room."""
    forces, moments = [0.0] * 3, [0.0] * 3
    for each in thrusters:
        arm, push = each.position, each.direction
        for axis, (one, other) in enumerate(((1, 2), (2, 0), (0, 1))):
            forces[axis] += each.max_thrust * abs(push[axis])
            moments[axis] += each.max_thrust * abs(arm[one] * push[other] - arm[other] * push[one])
    force = max(forces[0], forces[1], 2.0 * forces[2])  # heave has a bit less
    return _step(0.02, force), _step(0.01, max(moments))


def _step(least: float, most: float) -> float:
    """Return a step, in thousandths, by which 16 bits with a sign hold as much as that."""
    return max(round(least * 1000.0), ceil(most * 1000.0 / 32766.0)) / 1000.0


def messages_of(sheet: Sheet) -> tuple[Message, ...]:
    """Return all messages of a vehicle, by identifier.

    Raises:
        SheetError: a bus cannot be made of the vehicle's data; lists all that is wrong.
    """
    refuse(sheet)
    own = [
        message
        for number, thruster in enumerate(sheet.thrusters)
        for message in (_command(number, thruster), _status(number, thruster))
    ]
    scaled = (_goal_pose(depth_step(sheet.max_depth)), *_wrench(*wrench_steps(sheet.thrusters)))
    by_number = {each.id: each for each in (*COMMON, *scaled, *BEATS, *own)}
    return tuple(by_number[number] for number in sorted(by_number))


def _thrust(thruster: Thruster) -> Field:
    """Return the field of a thrust: a scale of whole millinewtons, as fine as 16 bits allow."""
    scale = max(1, ceil(thruster.max_thrust * 1000.0 / 32767.0)) / 1000.0
    return Field("Thrust", 16, True, scale, "N", -thruster.max_thrust, thruster.max_thrust)


def _command(number: int, thruster: Thruster) -> Message:
    fields = (_thrust(thruster), _flag("Enable"))
    return Message(COMMAND_BASE + number, f"Thruster{number}Command", ACTUATORS, fields, COMMAND_PERIOD,
                   comment=f"thruster {thruster.id}")  # fmt: skip


def _status(number: int, thruster: Thruster) -> Message:
    fields = (_thrust(thruster), _unsigned("Power", 16, 0.1, "W"), _named("Drive", 2, *DRIVES))
    return Message(STATUS_BASE + number, f"Thruster{number}Status", VEHICLE, fields, STATUS_PERIOD,
                   comment=f"thruster {thruster.id}")  # fmt: skip


_COUNTER = Field(SEQUENCE, 8, high=255.0, comment="one more with every frame of this message, from 255 to 0")
_CHECK = Field(CHECK, 8, high=255.0, comment="CRC-8 SAE J1850 over the identifier (two bytes) and all before")


class Slot(NamedTuple):
    """A field in its place.

    Attributes:
        start: its least significant bit; bit 0 is the lowest of byte 0.
        mask: as many ones as it has bits.
        low, high: the least and the greatest raw number that is sent and believed.
    """

    field: Field
    start: int
    mask: int
    low: int
    high: int


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """Where a message's fields lie.

    Attributes:
        own: its fields by name, without counter and check.
        slots: all of them, counter and check last if it is guarded.
        length: bytes.
    """

    message: Message
    own: Mapping[str, Slot]
    slots: Mapping[str, Slot]
    length: int


@cache
def layout_of(message: Message) -> Layout:
    """Return where a message's fields lie; counter and check have whole bytes to themselves."""
    own: dict[str, Slot] = {}
    start = 0
    for field in message.fields:
        own[field.name] = Slot(field, start, (1 << field.bits) - 1, *_bounds(field))
        start += field.bits
    slots, length = dict(own), (start + 7) // 8
    if message.guarded:
        for field in (_COUNTER, _CHECK):
            slots[field.name] = Slot(field, length * 8, 255, 0, 255)
            length += 1
    return Layout(message, own, slots, length)


def _bounds(field: Field) -> tuple[int, int]:
    """Return the raw numbers within the field's range; one that names stand for has a name."""
    if field.names:
        return 0, len(field.names) - 1
    slack = 1e-9  # a range of whole steps, as floating-point numbers have it
    return ceil(field.low / field.scale - slack), floor(field.high / field.scale + slack)
