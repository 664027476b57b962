"""The part of the fault table about orders: every order, from every state."""

from __future__ import annotations

from fault_table.row import Row, leave_alone

STATES = ("climbing", "on a leg (GUIDED)", "on a mission (AUTO)", "at its place", "waiting", "charging")
FAST = (
    ("hold", "on a mission (AUTO)"),
    ("return", "at its place"),
    ("land", "climbing"),
    ("stop", "waiting"),
)


def _row(order: str, state: str, event: str, ends: str, *, resumes: float | None = None) -> Row:
    program = {"waiting": "wait", "charging": "charge"}.get(state, "tour")
    words = f"order {order}" + (", then resume" if resumes is not None else "")
    return Row(
        words,
        state,
        None,
        leave_alone,
        event,
        ends,
        within=None if state == "charging" else 3.0,
        least=1.0,
        program=program,
        stay={"on a mission (AUTO)": 5.0, "charging": 30.0}.get(state, 20.0),
        order=order,
        resumes=resumes,
        fast=(order, state) in FAST and resumes is None,
    )


def _rows() -> list[Row]:
    rows = []
    for state in STATES:
        down = state == "charging"
        rows.append(_row("hold", state, "", "home" if down else "holds"))
        rows.append(_row("return", state, "ORDERED", "home"))
        rows.append(_row("land", state, "ORDERED", "home" if down or state == "climbing" else "here"))
        rows.append(_row("stop", state, "STOPPED", "home" if down else "holds"))
        if state != "waiting":
            rows.append(_row("hold", state, "", "done", resumes=12.0))
    return rows


ORDERS: tuple[Row, ...] = tuple(_rows())
