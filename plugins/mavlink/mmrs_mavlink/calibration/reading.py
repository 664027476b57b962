"""Reads logs of flights: which format a file has, and what its messages say."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import nan, radians
from pathlib import Path
from typing import Any

from mmrs_core.behaviour.box_files import black_boxes, is_part
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_runtime.records.entries import Entry, number_of

from ..links.messages import tells_place
from ..profiles import PROFILES
from . import dataflash, telemetry_log
from .damage import Damages
from .flight import Flight
from .gathering import Gathered, profile_of_type

LARGEST_LOG = 2 * 1024**3
"""Bytes of a log; boards write up to a gigabyte."""

FORMATS = "ArduPilot's .bin, a ground station's .tlog, or a black box of MMRS"

_UNSUPPORTED = {
    b"ULog": "a log of PX4 (.ulg), which is not read: give the ground station's .tlog of the flight",
    b"FMT,": "a log as text, which is not read: give the .bin that it was made from",
    b"\x1f\x8b": "compressed: unpack it first",
    b"PK\x03\x04": "compressed: unpack it first",
}
_ARMED, _DISARMED = 10, 11
_TAKE_OFF = 22
_LAST_NAVIGATION = 95
_NO_HEADING = 65_535
_NO_CURRENT = -1
_NO_VOLTAGE = 65_535
_ARMED_FLAG = 128
_NO_AUTOPILOT = 8
_NO_PLACE = 7
"""Bits of a set-point's mask by which its place does not count."""
_RESTARTED = 1.0
"""Seconds that a clock goes back when its vehicle has restarted; messages may overtake each other by less."""


def flight_in(path: Path, system: int | None = None) -> Flight:
    """Return the flight that a log holds.

    Args:
        path: of the log.
        system: MAVLink's number of the vehicle, where a .tlog holds several.

    Raises:
        UnreadableError: there is no such file, its format is not read, or it holds no flight.
    """
    if is_part(path):
        return _box_flight(path)
    data = read_bytes(path, LARGEST_LOG)
    if not data:
        raise UnreadableError.of("FIL002", "empty", path)
    for magic, why in _UNSUPPORTED.items():
        if data.startswith(magic):
            raise UnreadableError(f"{path}: {why}")
    if data.startswith(dataflash.MAGIC):
        return _dataflash_flight(path, data)
    if telemetry_log.is_telemetry(data):
        return _telemetry_flight(path, data, system)
    raise UnreadableError(f"{path}: byte 0: not the beginning of a log: neither {FORMATS}")


def _dataflash_flight(path: Path, data: bytes) -> Flight:
    found, damages = Gathered(str(path)), Damages(str(path))
    core: object = None
    for name, fields in dataflash.messages_in(data, _DATAFLASH, damages):
        if name in _ESTIMATES:
            estimate = name, fields.get(_ESTIMATES[name])
            core = core or estimate
            if core != estimate:
                continue
        try:
            _DATAFLASH[name](found, fields)
        except (KeyError, TypeError):
            raise UnreadableError(f"{path}: its message {name} has other fields than ArduPilot's") from None
    found.damages += damages.messages()
    if core is None:
        raise UnreadableError(f"{path}: no positions (XKF1 or NKF1): LOG_BITMASK excludes them, or it is cut")
    return found.flight()


def _of_estimate(found: Gathered, fields: Mapping[str, Any]) -> None:
    found.add(
        fields["TimeUS"] * 1e-6,
        (fields["PE"], fields["PN"], -fields["PD"]),
        (fields["VE"], fields["VN"], -fields["VD"]),
        radians(fields["Yaw"]),
    )


def _of_mode(found: Gathered, fields: Mapping[str, Any]) -> None:
    found.is_in_mode(fields["TimeUS"] * 1e-6, int(fields.get("ModeNum", fields["Mode"])))


def _of_event(found: Gathered, fields: Mapping[str, Any]) -> None:
    if fields["Id"] in (_ARMED, _DISARMED):
        found.is_armed(fields["TimeUS"] * 1e-6, fields["Id"] == _ARMED)


def _of_battery(found: Gathered, fields: Mapping[str, Any]) -> None:
    if fields.get("Inst", 0) == 0:
        found.power.append((fields["TimeUS"] * 1e-6, fields["Volt"], fields["Curr"]))


def _of_item(found: Gathered, fields: Mapping[str, Any]) -> None:
    if fields["CId"] < _LAST_NAVIGATION:
        found.aims_at(fields["TimeUS"] * 1e-6, ("item", fields["CNum"]))
    if fields["CId"] == _TAKE_OFF:
        found.take_offs.append(fields["TimeUS"] * 1e-6)


def _of_target(found: Gathered, fields: Mapping[str, Any]) -> None:
    found.aims_at(fields["TimeUS"] * 1e-6, (fields["pX"], fields["pY"], fields["pZ"]))


def _of_command(found: Gathered, fields: Mapping[str, Any]) -> None:
    if fields["Cmd"] == _TAKE_OFF:
        found.take_offs.append(fields["TimeUS"] * 1e-6)


def _of_parameter(found: Gathered, fields: Mapping[str, Any]) -> None:
    found.parameters[fields["Name"]] = fields["Value"]


def _of_version(found: Gathered, fields: Mapping[str, Any]) -> None:
    found.vehicle = fields["FWS"]
    for profile in PROFILES.values():
        if found.vehicle.lower().startswith(profile.name):
            found.profile = profile


_ESTIMATES = {"XKF1": "C", "NKF1": "C"}
_DATAFLASH: Mapping[str, Callable[[Gathered, Mapping[str, Any]], None]] = {
    "XKF1": _of_estimate,
    "NKF1": _of_estimate,
    "MODE": _of_mode,
    "EV": _of_event,
    "BAT": _of_battery,
    "MISE": _of_item,
    "GUIP": _of_target,
    "MAVC": _of_command,
    "PARM": _of_parameter,
    "VER": _of_version,
}


def _telemetry_flight(path: Path, data: bytes, system: int | None) -> Flight:
    damages = Damages(str(path))
    vehicles: dict[int, list[Gathered]] = {}
    for message in telemetry_log.messages_in(data, _TELEMETRY.keys() | _SENT.keys(), damages):
        kind, sender = message.get_type(), message.get_srcSystem()
        if kind in _SENT:
            for number, starts in vehicles.items():
                if message.target_system in (0, number):
                    _SENT[kind](starts[-1], message)
        elif kind != "HEARTBEAT" or message.autopilot != _NO_AUTOPILOT:
            starts = vehicles.setdefault(sender, [Gathered(str(path))])
            if kind == "GLOBAL_POSITION_INT" and message.time_boot_ms * 1e-3 < starts[-1].now - _RESTARTED:
                starts.append(starts[-1].restarted())
            _TELEMETRY[kind](starts[-1], message)
    longest = {number: max(starts, key=lambda each: len(each.samples)) for number, starts in vehicles.items()}
    chosen = _chosen({number: each for number, each in longest.items() if each.samples}, path, system)
    if any(len(starts) > 1 and chosen in starts for starts in vehicles.values()):
        chosen.damages.append(f"{path}: the vehicle restarted: only its longest flight counts")
    chosen.damages += damages.messages()
    return chosen.flight()


def _chosen(flown: Mapping[int, Gathered], path: Path, system: int | None) -> Gathered:
    if not flown:
        raise UnreadableError(f"{path}: no positions (GLOBAL_POSITION_INT) in it")
    known = ", ".join(map(str, sorted(flown)))
    if system is None and len(flown) > 1:
        raise UnreadableError(f"{path}: holds several vehicles: choose one by --system: {known}")
    if system is not None and system not in flown:
        raise UnreadableError(f"{path}: no vehicle with system {system}; known are {known}")
    return flown[next(iter(flown)) if system is None else system]


def _of_heartbeat(found: Gathered, message: Any) -> None:
    found.is_in_mode(found.now, message.custom_mode)
    found.is_armed(found.now, bool(message.base_mode & _ARMED_FLAG))
    found.profile = found.profile or profile_of_type(message.autopilot, message.type)
    if found.profile is not None:
        found.vehicle = found.profile.name


def _of_position(found: Gathered, message: Any) -> None:
    if not tells_place(message):
        return
    place = (*found.metres(message.lat * 1e-7, message.lon * 1e-7), message.alt * 1e-3)
    velocity = (message.vy * 0.01, message.vx * 0.01, -message.vz * 0.01)
    heading = nan if message.hdg == _NO_HEADING else radians(message.hdg * 0.01)
    found.add(message.time_boot_ms * 1e-3, place, velocity, heading)


def _of_battery_status(found: Gathered, message: Any) -> None:
    cells = [each for each in message.voltages if each != _NO_VOLTAGE]
    if message.id == 0 and cells and message.current_battery != _NO_CURRENT:
        found.power.append((found.now, sum(cells) * 1e-3, message.current_battery * 0.01))
    if message.id == 0 and message.battery_remaining >= 0:
        found.charges.append((found.now, message.battery_remaining * 0.01))


def _of_current_item(found: Gathered, message: Any) -> None:
    found.aims_at(found.now, ("item", message.seq))


def _of_reached_item(found: Gathered, message: Any) -> None:
    found.has_reached(found.now, message.seq)


def _of_value(found: Gathered, message: Any) -> None:
    found.parameters[message.param_id] = message.param_value


def _of_set_point(found: Gathered, message: Any) -> None:
    if not message.type_mask & _NO_PLACE:
        found.aims_at(found.now, (message.lat_int, message.lon_int, message.alt))


def _of_sent_command(found: Gathered, message: Any) -> None:
    if message.command == _TAKE_OFF:
        found.take_offs.append(found.now)


_TELEMETRY: Mapping[str, Callable[[Gathered, Any], None]] = {
    "HEARTBEAT": _of_heartbeat,
    "GLOBAL_POSITION_INT": _of_position,
    "BATTERY_STATUS": _of_battery_status,
    "MISSION_CURRENT": _of_current_item,
    "MISSION_ITEM_REACHED": _of_reached_item,
    "PARAM_VALUE": _of_value,
}
_SENT: Mapping[str, Callable[[Gathered, Any], None]] = {
    "SET_POSITION_TARGET_GLOBAL_INT": _of_set_point,
    "COMMAND_LONG": _of_sent_command,
    "COMMAND_INT": _of_sent_command,
}


def _box_flight(path: Path) -> Flight:
    found = Gathered(str(path))
    for box in black_boxes([path]):
        found.damages += box.missing
        for entry in box.entries(lambda damage: found.damages.append(str(damage))):
            if entry.kind in _BOX:
                _BOX[entry.kind](found, entry)
    if not found.samples:
        raise UnreadableError(f"{path}: no fixes with positions in it")
    return found.flight()


def _of_start(found: Gathered, entry: Entry) -> None:
    vehicle, firmware = entry.content.get("vehicle"), str(entry.content.get("firmware", ""))
    found.vehicle = f"{firmware} {vehicle}".strip()
    found.profile = next(
        (
            each
            for each in PROFILES.values()
            if vehicle in each.words and firmware.lower().startswith(each.autopilot.name)
        ),
        None,
    )


def _of_fix(found: Gathered, entry: Entry) -> None:
    place, speed = entry.content.get("place"), number_of(entry.content.get("speed"))
    heading, mode = number_of(entry.content.get("heading")), entry.content.get("mode")
    here = _metres(found, place) if isinstance(place, dict) else None
    if here is not None and speed is not None:
        found.add_by_speed(entry.time, here, speed, nan if heading is None else radians(heading))
    if found.profile is not None and mode in found.profile.modes:
        found.is_in_mode(entry.time, found.profile.modes[str(mode)].number)
    elif isinstance(mode, str):
        found.is_in_mode(entry.time, -1)
    if isinstance(entry.content.get("armed"), bool):
        found.is_armed(entry.time, bool(entry.content["armed"]))
    energy = number_of(entry.content.get("energy"))
    if energy is not None:
        found.charges.append((entry.time, energy))


def _metres(found: Gathered, place: Mapping[str, object]) -> tuple[float, float, float] | None:
    """Return a place of a black box as metres east, north and up; None where it is incomplete."""
    height = number_of(place.get("height"))
    latitude, longitude = number_of(place.get("latitude")), number_of(place.get("longitude"))
    north, east = number_of(place.get("north")), number_of(place.get("east"))
    if height is not None and latitude is not None and longitude is not None:
        return (*found.metres(latitude, longitude), height)
    if height is not None and north is not None and east is not None:
        return east, north, height
    return None


def _of_message(found: Gathered, entry: Entry) -> None:
    fields = entry.content.get("fields")
    if entry.content.get("type") == "SET_POSITION_TARGET_GLOBAL_INT" and isinstance(fields, dict):
        found.aims_at(entry.time, tuple(fields.get(name) for name in ("lat_int", "lon_int", "alt")))


def _of_box_command(found: Gathered, entry: Entry) -> None:
    if entry.content.get("name") == "NAV_TAKEOFF":
        found.take_offs.append(entry.time)


def _of_clock(found: Gathered, entry: Entry) -> None:
    rate = number_of(entry.content.get("rate"))
    if rate is not None:
        why = f"its times are the run's, and the vehicle's clock ran {rate:.2g} times as fast"
        raise UnreadableError(f"{found.file}: {why}: fly it again with the --speedup of its simulation")


_BOX: Mapping[str, Callable[[Gathered, Entry], None]] = {
    "start": _of_start,
    "fix": _of_fix,
    "message": _of_message,
    "command": _of_box_command,
    "clock": _of_clock,
}
