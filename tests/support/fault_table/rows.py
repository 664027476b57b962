"""The fault table: every fault of one vehicle, with at least two policies each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from fault_table.project import POLICY
from fault_table.row import Row, leave_alone
from mmrs_core.sitl import SimulatedVehicle

PHOTO = 2000
SILENCE = 2.5
"""Real seconds that a vehicle of ours bears silence at least, with the moment until its next heartbeat."""

UNCONFIRMED = 6.0
"""Real seconds in which a device has not confirmed what it was told five times over. Such rounds go on for
half a minute of the run; the last one, and the rest of the leg, come on top."""

AT, LEG, AUTO, UP = "at its place", "on a leg (GUIDED)", "on a mission (AUTO)", "climbing"

Strike = Callable[[SimulatedVehicle], object]


def _link(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.cut_link()


def _stick(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.take_stick("loiter")


def _by_hand(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.take_stick("alt_hold")


def _battery(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.set_battery(0.15)


def _stick_and_battery(vehicle: SimulatedVehicle) -> None:
    _battery(vehicle)
    _stick(vehicle)


def _barely(vehicle: SimulatedVehicle) -> None:
    """Leave a little more than the reserve, but not what the way back takes beside it."""
    vehicle.faults.set_battery(0.215)


def _critical(vehicle: SimulatedVehicle) -> None:
    """Have a vehicle that cannot measure its battery say all the same that it is nearly empty."""
    said = mavlink.MAVLink_battery_status_message(
        0, 0, 0, 32_767, [65_535] * 10, -1, -1, -1, -1, 0, mavlink.MAV_BATTERY_CHARGE_STATE_CRITICAL
    )
    with vehicle.lock:
        for radio in vehicle.radios:
            radio.send(said)


def _mute_camera(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.silence(PHOTO)


def _satellites(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.lose_position()


def _obstacle(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.meet_obstacle(2.0)


def _breach(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.breach_fence()


def _reset(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.restart(armed=True)


def _reboot(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.restart()


def _vehicle_clock(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.jump_clock(3600.0)


def _policy(event: str, response: str, after: float | None = None) -> POLICY:
    return (event, response, after)


def _link_rows() -> list[Row]:
    lost = [
        (LEG, "RETURN", "home"),
        (AT, "LAND", "here"),
        (AUTO, "HOLD", "holds"),
        (AT, "EMERGENCY_AREA", "meadow"),
        (UP, "RETURN", "home"),
    ]
    rows = [
        Row(
            "link lost for good",
            during,
            _policy("LINK_LOST", response, 3.0),
            _link,
            "LINK_LOST",
            ends,
            within=12.0,
            least=SILENCE,
            fast=response == "RETURN" and during == LEG,
        )
        for during, response, ends in lost
    ]
    back = lambda vehicle: vehicle.faults.mend_link()  # noqa: E731
    rows += [
        Row(
            "link lost and back",
            during,
            _policy("LINK_LOST", response, 20.0),
            _link,
            "",
            "done",
            within=None,
            stay=15.0,
            mends=(8.0, back),
            fast=during == LEG,
        )
        for during, response in ((LEG, "RETURN"), (AUTO, "LAND"), (AT, "EMERGENCY_AREA"))
    ]
    return rows


def _pilot_rows() -> list[Row]:
    rows = [
        Row(
            "pilot's stick",
            during,
            _policy("OBSTACLE", response),
            strike,
            "TAKEN_OVER",
            "holds",
            within=None,
            stay=5.0 if during == AUTO else 20.0,
            hands_off=True,
            refuses="return",
            fast=during == AUTO,
        )
        for during, strike, response in (
            (LEG, _stick, "RETURN"),
            (AUTO, _stick, "LAND"),
            (AT, _by_hand, "EMERGENCY_AREA"),
            (UP, _stick, "HOLD"),
        )
    ]
    # Whatever else is wrong at that moment, a pilot goes before it.
    rows += [
        Row(
            "pilot's stick as the battery runs low",
            during,
            _policy("BATTERY_LOW", response),
            _stick_and_battery,
            "TAKEN_OVER|",
            "holds",
            within=None,
            stay=5.0 if during == AUTO else 20.0,
            hands_off=True,
        )
        for during, response in ((LEG, "RETURN"), (AUTO, "EMERGENCY_AREA"), (AT, "LAND"))
    ]
    rows += [
        Row(
            "battery low, and pilot's stick on the way back",
            during,
            _policy("BATTERY_LOW", response),
            _battery,
            "TAKEN_OVER|",
            "holds",
            stay=5.0 if during == AUTO else 20.0,
            mends=(3.0, _stick),
            hands_off=True,
        )
        for during, response in ((AT, "RETURN"), (AUTO, "EMERGENCY_AREA"))
    ]
    rows += [
        Row(
            f"{fault}, then pilot's stick",
            AT,
            policy,
            strike,
            "TAKEN_OVER",
            "holds",
            within=None,
            mends=(after, stick),
            hands_off=True,
        )
        for fault, policy, strike, after, stick in (
            ("satellites lost", _policy("POSITION_LOST", "LAND"), _satellites, 0.4, _by_hand),
            ("obstacle reported", _policy("OBSTACLE", "HOLD", 10.0), _obstacle, 3.0, _stick),
            ("obstacle reported", _policy("OBSTACLE", "EMERGENCY_AREA", 10.0), _obstacle, 3.0, _stick),
        )
    ]
    rows += [
        Row(
            f"obstacle reported, held, then pilot's stick, then order {order}",
            AT,
            _policy("OBSTACLE", "HOLD"),
            _obstacle,
            "OBSTACLE",
            "holds",
            mends=(8.0, stick),
            hands_off=True,
            refuses=order,
            responds="HOLD",
        )
        for stick, order in ((_stick, "return"), (_by_hand, "land"))
    ]
    return rows


def _landing_rows() -> list[Row]:
    return [
        Row(
            "battery low as it lands at home",
            "landing at home",
            _policy("BATTERY_LOW", response),
            _battery,
            "",
            "home",
            within=None,
            stay=2.0,
            stays=3.0,
        )
        for response in ("RETURN", "LAND")
    ]


def _event_rows(
    fault: str, event: str, strike: Strike, cases: list[tuple[str, str, str]], fast: str
) -> list[Row]:
    return [
        Row(
            fault,
            during,
            _policy(event or "BATTERY_LOW", response),
            strike,
            event,
            ends,
            stay=5.0 if during == AUTO else 20.0,
            suspends=not event,
            fast=response == fast,
        )
        for during, response, ends in cases
    ]


def _landed(*given) -> list[Row]:
    """Return rows in which a robot that cannot hold its position comes down instead."""
    return [replace(row, responds="LAND") for row in _event_rows(*given)]


def _fallen(*given) -> list[Row]:
    """Return rows in which the vehicle falls, so that there is nothing left that it could do."""
    return [replace(row, within=None) for row in _event_rows(*given)]


def _device_rows() -> list[Row]:
    cases = [("HOLD", "holds"), ("RETURN", "home"), ("EMERGENCY_AREA", "meadow")]
    rows = [
        Row(
            "device does not answer",
            LEG,
            _policy("DEVICE_SILENT", response),
            _mute_camera,
            "DEVICE_SILENT",
            ends,
            within=46.0,
            least=UNCONFIRMED,
            fast=response == "EMERGENCY_AREA",
        )
        for response, ends in cases
    ]
    return [
        *rows,
        Row(
            "device does not answer",
            LEG,
            _policy("DEVICE_SILENT", "CONTINUE"),
            _mute_camera,
            "",
            "done",
            within=None,
            stay=5.0,
        ),
    ]


def _wait_rows() -> list[Row]:
    rows = [
        Row(
            "wait too long",
            AT,
            _policy("WAIT_TOO_LONG", response, 10.0),
            leave_alone,
            "WAIT_TOO_LONG",
            ends,
            within=13.0,
            program="wait",
            fast=response == "EMERGENCY_AREA",
        )
        for response, ends in (("RETURN", "home"), ("EMERGENCY_AREA", "meadow"), ("HOLD", "holds"))
    ]
    rows += [
        Row(
            "peer's program ends early",
            AT,
            _policy("PEER_LOST", response, 5.0),
            _stick,
            "PEER_LOST",
            ends,
            within=7.0,
            least=SILENCE,
            program="wait",
            strikes_peer=True,
        )
        for response, ends in (("LAND", "here"), ("EMERGENCY_AREA", "meadow"))
    ]
    return rows


def _own_failsafe_rows() -> list[Row]:
    """Return rows in which the vehicle answers by itself, too, and otherwise than the policy."""
    own = {"parameters": {"BATT_FS_LOW_ACT": 2.0, "BATT_LOW_TIMER": 2.0, "BATT_LOW_VOLT": 11.0}}
    cases = [(LEG, "LAND", "here"), (AUTO, "EMERGENCY_AREA", "meadow"), (AT, "HOLD", "holds")]
    batteries = [
        replace(row, settings=own, suspends=row.ends != "holds")
        for row in _event_rows(
            "battery low, and vehicle returns by itself", "", _battery, cases, "EMERGENCY_AREA"
        )
    ]
    batteries[-1] = replace(batteries[-1], event="BATTERY_LOW")
    blind = _landed(
        "satellites lost, and vehicle holds its height",
        "POSITION_LOST",
        _satellites,
        [(AT, "HOLD", "here"), (LEG, "LAND", "here"), (AUTO, "CONTINUE", "here")],
        "",
    )
    return [*batteries, *(replace(row, settings={"parameters": {"FS_EKF_ACTION": 2.0}}) for row in blind)]


ROWS: tuple[Row, ...] = (
    *_link_rows(),
    *_pilot_rows(),
    *_landed(
        "satellites lost",
        "POSITION_LOST",
        _satellites,
        [(AT, "LAND", "here"), (AUTO, "LAND", "here"), (LEG, "HOLD", "here")],
        "LAND",
    ),
    *_event_rows(
        "obstacle reported",
        "OBSTACLE",
        _obstacle,
        [
            (AT, "HOLD", "holds"),
            (LEG, "EMERGENCY_AREA", "meadow"),
            (AUTO, "RETURN", "home"),
            (AT, "LAND", "here"),
        ],
        "EMERGENCY_AREA",
    ),
    *_event_rows(
        "fence breached",
        "FENCE_BREACHED",
        _breach,
        [(AT, "RETURN", "home"), (AUTO, "EMERGENCY_AREA", "meadow"), (LEG, "LAND", "here")],
        "RETURN",
    ),
    *_event_rows(
        "autopilot reset, motors on",
        "VEHICLE_RESTARTED",
        _reset,
        [(AT, "LAND", "here"), (LEG, "RETURN", "home"), (AUTO, "EMERGENCY_AREA", "meadow")],
        "RETURN",
    ),
    *_fallen(
        "autopilot reboot, motors off",
        "VEHICLE_RESTARTED",
        _reboot,
        [(AT, "HOLD", "here"), (AUTO, "RETURN", "here")],
        "",
    ),
    *_event_rows(
        "battery low",
        "",
        _battery,
        [(AT, "RETURN", "home"), (AUTO, "EMERGENCY_AREA", "meadow"), (LEG, "LAND", "here")],
        "EMERGENCY_AREA",
    ),
    *_event_rows(
        "point of no return",
        "",
        _barely,
        [(AUTO, "RETURN", "home"), (AT, "EMERGENCY_AREA", "meadow")],
        "",
    ),
    *(
        replace(row, settings={"tells_battery": False})
        for row in _event_rows(
            "battery critical, as only the vehicle says",
            "",
            _critical,
            [(AUTO, "RETURN", "home"), (AT, "EMERGENCY_AREA", "meadow")],
            "",
        )
    ),
    *_own_failsafe_rows(),
    *_landing_rows(),
    *_device_rows(),
    *_wait_rows(),
    Row(
        "vehicle's clock jumps",
        LEG,
        _policy("VEHICLE_RESTARTED", "LAND"),
        _vehicle_clock,
        "",
        "done",
        within=None,
        stay=5.0,
    ),
)
