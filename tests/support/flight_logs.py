"""Logs made of motions: as ArduPilot writes them, and as a ground station does."""

import struct
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

QUADROTOR, ARDUPILOT = 2, 3


@dataclass(frozen=True, slots=True)
class Sample:
    """Where a vehicle is: seconds, metres and metres per second (east, north, up), degrees, mode, item."""

    time: float
    place: tuple[float, float, float]
    velocity: tuple[float, float, float]
    heading: float = 0.0
    mode: int = 4
    armed: bool = True
    item: int = 0


_FORMATS: Mapping[str, tuple[int, str, str]] = {
    "XKF1": (66, "QBccCfffffffccce", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    "MODE": (67, "QMBB", "TimeUS,Mode,ModeNum,Rsn"),
    "EV": (68, "QB", "TimeUS,Id"),
    "BAT": (69, "QBfff", "TimeUS,Inst,Volt,Curr,CurrTot"),
    "PARM": (70, "QNff", "TimeUS,Name,Value,Default"),
    "VER": (71, "QZ", "TimeUS,FWS"),
    "MISE": (72, "QHH", "TimeUS,CNum,CId"),
}
_CODES = {
    "Q": "Q",
    "B": "B",
    "M": "B",
    "c": "h",
    "C": "H",
    "e": "i",
    "f": "f",
    "N": "16s",
    "Z": "64s",
    "H": "H",
}


def dataflash(samples: Iterable[Sample], firmware: str = "ArduCopter V4.7.0", watts: float = 0.0) -> bytes:
    """Return the log that ArduPilot would have written on board."""
    return b"".join(_dataflash(samples, firmware, watts))


def _dataflash(samples: Iterable[Sample], firmware: str, watts: float) -> Iterator[bytes]:
    yield _format(128, "FMT", 89, "BBnNZ", "Type,Length,Name,Format,Columns")
    for name, (number, codes, fields) in _FORMATS.items():
        yield _format(number, name, 3 + struct.calcsize(_layout(codes)), codes, fields)
    yield _message("VER", 0, firmware.encode())
    yield _message("PARM", 0, b"BATT_CAPACITY", 16000.0, 0.0)
    mode, armed, item = -1, False, 0
    for each in samples:
        micros = round(each.time * 1e6)
        if each.mode != mode:
            mode = each.mode
            yield _message("MODE", micros, mode, mode, 2)
        if each.armed != armed:
            armed = each.armed
            yield _message("EV", micros, 10 if armed else 11)
        if each.item != item:
            item = each.item
            yield _message("MISE", micros, item, 16)
        east, north, up = each.place
        speed_east, speed_north, speed_up = each.velocity
        yaw = round(each.heading % 360.0 * 100.0)
        yield _message(
            "XKF1",
            micros,
            0,
            0,
            0,
            yaw,
            speed_north,
            speed_east,
            -speed_up,
            0.0,
            north,
            east,
            -up,
            0,
            0,
            0,
            0,
        )
        if watts:
            yield _message("BAT", micros, 0, 22.2, watts / 22.2, 0.0)


def _layout(codes: str) -> str:
    return "<" + "".join(_CODES[each] for each in codes)


def _format(number: int, name: str, length: int, codes: str, fields: str) -> bytes:
    body = struct.pack("<BB4s16s64s", number, length, name.encode(), codes.encode(), fields.encode())
    return b"\xa3\x95\x80" + body


def _message(name: str, *values: object) -> bytes:
    number, codes, _ = _FORMATS[name]
    return bytes((0xA3, 0x95, number)) + struct.pack(_layout(codes), *values)


def telemetry(
    samples: Iterable[Sample],
    *,
    system: int = 1,
    mav_type: int = QUADROTOR,
    autopilot: int = ARDUPILOT,
    origin: tuple[float, float] = (42.37, 13.35),
    late: float = 0.0,
) -> bytes:
    """Return the log that a ground station would have written; `late`: seconds until it gets a new item."""
    sender = mavlink.MAVLink(None, srcSystem=system, srcComponent=1)
    return b"".join(_telemetry(samples, sender, mav_type, autopilot, origin, late))


def _telemetry(
    samples: Iterable[Sample],
    sender: mavlink.MAVLink,
    mav_type: int,
    autopilot: int,
    origin: tuple[float, float],
    late: float,
) -> Iterator[bytes]:
    said, item, told = float("-inf"), -1, -1
    since = float("-inf")
    for each in samples:
        stamp = struct.pack(">Q", 1_790_000_000_000_000 + round(each.time * 1e6))

        def frame(message: mavlink.MAVLink_message, stamp: bytes = stamp) -> bytes:
            return stamp + bytes(message.pack(sender))

        if each.time - said >= 1.0:
            said = each.time
            base = 209 if each.armed else 81
            yield frame(mavlink.MAVLink_heartbeat_message(mav_type, autopilot, base, each.mode, 4, 3))
        if each.item != item:
            if late and item >= 0:
                yield frame(mavlink.MAVLink_mission_item_reached_message(item))
            since = each.time if item >= 0 else since
            item = each.item
        if told != item and each.time >= since + late:
            told = item
            yield frame(mavlink.MAVLink_mission_current_message(item))
        latitude = origin[0] + each.place[1] / 111_081.0
        longitude = origin[1] + each.place[0] / 82_379.0
        east, north, up = each.velocity
        yield frame(
            mavlink.MAVLink_global_position_int_message(
                round(each.time * 1e3),
                round(latitude * 1e7),
                round(longitude * 1e7),
                round((720.0 + each.place[2]) * 1e3),
                round(each.place[2] * 1e3),
                round(north * 100),
                round(east * 100),
                round(-up * 100),
                round(each.heading % 360.0 * 100.0) % 36000,
            )
        )
