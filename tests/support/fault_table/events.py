"""The part of the fault table about what befalls a vehicle, or what it tells of itself."""

from dataclasses import replace

from resets import reset

from fault_table import strikes
from fault_table.row import AT, AUTO, LEG, Act, Row, policy


def _event_rows(
    fault: str, event: str, strike: Act, cases: list[tuple[str, str, str]], fast: str
) -> list[Row]:
    return [
        Row(
            fault,
            during,
            policy(event or "BATTERY_LOW", response),
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


def event_rows() -> list[Row]:
    """Return rows in which the policy alone says what the vehicle does."""
    return [
        *_landed(
            "satellites lost",
            "POSITION_LOST",
            strikes.satellites,
            [(AUTO, "LAND", "here"), (LEG, "HOLD", "here")],
            "LAND",
        ),
        *_landed(
            "position leaps by 40 m",
            "POSITION_LOST",
            strikes.shift,
            [(AUTO, "LAND", "here"), (LEG, "HOLD", "here")],
            "LAND",
        ),
        *_event_rows(
            "obstacle reported",
            "OBSTACLE",
            strikes.obstacle,
            [(AT, "HOLD", "holds"), (LEG, "EMERGENCY_AREA", "meadow"), (AUTO, "LAND", "here")],
            "EMERGENCY_AREA",
        ),
        *_event_rows(
            "fence breached",
            "FENCE_BREACHED",
            strikes.breach,
            [(AT, "RETURN", "home"), (LEG, "LAND", "here")],
            "RETURN",
        ),
        *_event_rows(
            "autopilot reset, motors on",
            "VEHICLE_RESTARTED",
            reset,
            [(AT, "LAND", "here"), (LEG, "RETURN", "home")],
            "RETURN",
        ),
        *_fallen(
            "autopilot reboot, motors off",
            "VEHICLE_RESTARTED",
            strikes.reboot,
            [(AT, "HOLD", "here"), (AUTO, "RETURN", "here")],
            "",
        ),
        *(
            # One that falls out of its mission leaves its path, which may be noticed first.
            replace(row, event="MOTOR_FAILED|NO_PROGRESS" if row.during == AUTO else row.event, stays=5.0)
            for row in _event_rows(
                "a motor fails",
                "MOTOR_FAILED",
                strikes.motor,
                [(AT, "LAND", "here"), (AUTO, "RETURN", "here"), (LEG, "CONTINUE", "here")],
                "LAND",
            )
        ),
        *_event_rows(
            "battery low",
            "",
            strikes.battery,
            [(AUTO, "EMERGENCY_AREA", "meadow"), (LEG, "LAND", "here")],
            "EMERGENCY_AREA",
        ),
        *_event_rows("point of no return", "", strikes.barely, [(AUTO, "RETURN", "home")], ""),
        *(
            replace(row, settings={"tells_battery": False})
            for row in _event_rows(
                "battery critical, as only the vehicle says",
                "",
                strikes.critical,
                [(AT, "EMERGENCY_AREA", "meadow")],
                "",
            )
        ),
    ]


def own_failsafe_rows() -> list[Row]:
    """Return rows in which the vehicle answers by itself, too, and otherwise than the policy."""
    own = {"parameters": {"BATT_FS_LOW_ACT": 2.0, "BATT_LOW_TIMER": 2.0, "BATT_LOW_VOLT": 11.0}}
    cases = [(AUTO, "EMERGENCY_AREA", "meadow"), (AT, "HOLD", "holds")]
    batteries = [
        replace(row, settings=own, suspends=row.ends != "holds")
        for row in _event_rows(
            "battery low, and vehicle returns by itself", "", strikes.battery, cases, "EMERGENCY_AREA"
        )
    ]
    batteries[-1] = replace(batteries[-1], event="BATTERY_LOW")
    blind = _landed(
        "satellites lost, and vehicle holds its height",
        "POSITION_LOST",
        strikes.satellites,
        [(AT, "HOLD", "here"), (AUTO, "CONTINUE", "here")],
        "",
    )
    return [*batteries, *(replace(row, settings={"parameters": {"FS_EKF_ACTION": 2.0}}) for row in blind)]


def landing_rows() -> list[Row]:
    return [
        Row(
            "battery low as it lands at home",
            "landing at home",
            policy("BATTERY_LOW", response),
            strikes.battery,
            "",
            "home",
            within=None,
            stay=2.0,
            stays=3.0,
        )
        for response in ("RETURN",)
    ]
