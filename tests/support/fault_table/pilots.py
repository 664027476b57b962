"""The part of the fault table about pilots who take their vehicle over: hands off, whatever else is wrong."""

from fault_table import strikes
from fault_table.row import AT, AUTO, LEG, Row, policy


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
            (AUTO, strikes.stick, "LAND"),
            (AT, strikes.by_hand, "EMERGENCY_AREA"),
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
        for during, response in ((LEG, "RETURN"), (AT, "LAND"))
    ]
    rows += [
        Row(
            "satellites lost, then pilot's stick",
            AT,
            policy("POSITION_LOST", "LAND"),
            strikes.satellites,
            "TAKEN_OVER",
            "holds",
            within=None,
            mends=(0.4, strikes.by_hand),
            hands_off=True,
        ),
        Row(
            "obstacle reported, held, then pilot's stick, then order land",
            AT,
            policy("OBSTACLE", "HOLD"),
            strikes.obstacle,
            "OBSTACLE",
            "holds",
            mends=(8.0, strikes.by_hand),
            hands_off=True,
            refuses="land",
            responds="HOLD",
        ),
        Row(
            "battery low, and pilot's stick on the way back",
            AUTO,
            policy("BATTERY_LOW", "EMERGENCY_AREA"),
            strikes.battery,
            "TAKEN_OVER|",
            "holds",
            stay=5.0,
            mends=(3.0, strikes.stick),
            hands_off=True,
        ),
    ]
    return rows
