"""The part of the fault table about links that are lost."""

from fault_table import strikes
from fault_table.row import AT, AUTO, LEG, Row, answered_rows, policy

SILENCE = 2.5
"""Real seconds that a vehicle of ours bears silence at least, with the moment until its next heartbeat."""


def link_rows() -> list[Row]:
    lost = [(LEG, "RETURN", "home"), (AT, "LAND", "here"), (AUTO, "HOLD", "holds")]
    rows = answered_rows(
        "link lost for good",
        strikes.cut_link,
        "LINK_LOST",
        3.0,
        lost,
        fast=(LEG, "RETURN"),
        within=12.0,
        least=SILENCE,
    )
    rows += [
        Row(
            "link lost and back",
            during,
            policy("LINK_LOST", response, 20.0),
            strikes.cut_link,
            "",
            "done",
            within=None,
            stay=15.0,
            mends=(8.0, strikes.mend_link),
            fast=during == LEG,
        )
        for during, response in ((LEG, "RETURN"), (AT, "EMERGENCY_AREA"))
    ]
    rows += [
        Row(
            "link lost one way, the vehicle hears",
            during,
            policy("LINK_LOST", response, 6.0),
            strikes.fall_dumb,
            "LINK_LOST",
            ends,
            within=20.0,
            least=2.0 * SILENCE,
            mends=mends,
            fast=during == AUTO,
        )
        for during, response, ends, mends in (
            (AUTO, "LAND", "here", None),
            (AT, "RETURN", "home", (45.0, strikes.speak)),
        )
    ]
    return rows
