"""The part of the fault table about pilots who take their vehicle over: hands off, whatever else is wrong."""

from __future__ import annotations

from fault_table import strikes
from fault_table.row import AT, AUTO, LEG, UP, Row, policy


def pilot_rows() -> list[Row]:
    rows = [
        Row(
            "pilot's stick",
            during,
            policy("OBSTACLE", response),
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
            (LEG, strikes.stick, "RETURN"),
            (AUTO, strikes.stick, "LAND"),
            (AT, strikes.by_hand, "EMERGENCY_AREA"),
            (UP, strikes.stick, "HOLD"),
        )
    ]
    # Whatever else is wrong at that moment, a pilot goes before it.
    rows += [
        Row(
            "pilot's stick as the battery runs low",
            during,
            policy("BATTERY_LOW", response),
            strikes.stick_and_battery,
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
            policy("BATTERY_LOW", response),
            strikes.battery,
            "TAKEN_OVER|",
            "holds",
            stay=5.0 if during == AUTO else 20.0,
            mends=(3.0, strikes.stick),
            hands_off=True,
        )
        for during, response in ((AT, "RETURN"), (AUTO, "EMERGENCY_AREA"))
    ]
    rows += [
        Row(
            f"{fault}, then pilot's stick",
            AT,
            declared,
            strike,
            "TAKEN_OVER",
            "holds",
            within=None,
            mends=(after, stick),
            hands_off=True,
        )
        for fault, declared, strike, after, stick in (
            ("satellites lost", policy("POSITION_LOST", "LAND"), strikes.satellites, 0.4, strikes.by_hand),
            ("obstacle reported", policy("OBSTACLE", "HOLD", 10.0), strikes.obstacle, 3.0, strikes.stick),
            (
                "obstacle reported",
                policy("OBSTACLE", "EMERGENCY_AREA", 10.0),
                strikes.obstacle,
                3.0,
                strikes.stick,
            ),
        )
    ]
    rows += [
        Row(
            f"obstacle reported, held, then pilot's stick, then order {order}",
            AT,
            policy("OBSTACLE", "HOLD"),
            strikes.obstacle,
            "OBSTACLE",
            "holds",
            mends=(8.0, stick),
            hands_off=True,
            refuses=order,
            responds="HOLD",
        )
        for stick, order in ((strikes.stick, "return"), (strikes.by_hand, "land"))
    ]
    return rows
