"""The part of the fault table about orders: every order, from every state, to one robot and to all."""

from dataclasses import replace

from fault_table.row import Row, leave_alone

DOWN = ("on the ground", "charging")
ABOVE_HOME = ("climbing", "landing at home")
FAST = (
    ("hold", "on a mission (AUTO)"),
    ("return", "at its place"),
    ("land", "climbing"),
    ("stop", "waiting"),
)
STAYS = {"on a mission (AUTO)": 5.0, "charging": 30.0, "landing at home": 2.0, "on the ground": 5.0}

CHARGER = {"recharge": 20.0}
"""What vehicles have that charge: a battery that stays as it is holds robots up that found it below full."""

RESUMED_AFTER = 12.0
"""Seconds of the run for which robots are held before they may go on."""


def _row(order: str, state: str, event: str, ends: str, *, resumes: bool = False, stay: float = 20.0) -> Row:
    program = {"waiting": "wait", "charging": "charge"}.get(state, "tour")
    at_once = state not in (*DOWN, "landing at home")
    return Row(
        f"order {order}" + (", then resume" if resumes else ""),
        state,
        None,
        leave_alone,
        event,
        ends,
        within=3.0 if at_once else None,
        least=1.0,
        program=program,
        stay=STAYS.get(state, stay),
        settings=CHARGER if state == "charging" else {},
        order=order,
        resumes=RESUMED_AFTER if resumes else None,
        fast=(order, state) in FAST and not resumes,
    )


def _of(state: str) -> list[Row]:
    """Return all orders in a state of the robot."""
    down = state in DOWN
    rows = [
        _row("hold", state, "", "home" if down else "holds"),
        _row("return", state, "ORDERED", "home"),
        _row("land", state, "ORDERED", "home" if down or state in ABOVE_HOME else "here"),
        _row("stop", state, "STOPPED", "home" if down else "holds"),
    ]
    if state != "waiting":
        rows.append(_row("hold", state, "", "done", resumes=True))
    return rows


CHOSEN = {
    "hold": ("on a mission (AUTO)", "charging"),
    "return": ("at its place", "on the ground"),
    "land": ("climbing",),
    "stop": ("waiting", "landing at home"),
    "hold, then resume": ("on a leg (GUIDED)", "charging"),
}
"""For each order a state in which the robot flies, and one in which it does not, or hardly."""

ORDERS: tuple[Row, ...] = tuple(
    row
    for order, states in CHOSEN.items()
    for state in states
    for row in _of(state)
    if row.fault == f"order {order}"
)

AT_ONCE = ("on a mission (AUTO)", "waiting")
"""States in which the robots of one process are at the same moment."""


def to_all(order: str, *, resumes: bool = False) -> tuple[Row, ...]:
    """Return the rows of an order that all robots get at once, each in another state."""
    return tuple(
        replace(
            row, fault=row.fault.replace("order ", "order to all: "), together=True, fast=False, resumes=None
        )
        for state in AT_ONCE
        for row in _of(state)
        if row.order == order and (row.resumes is not None) == resumes
    )
