"""The page about rehearsals tells what simulated vehicles imitate; `--update-golden` writes it anew."""

import re
from pathlib import Path

from mmrs_mavlink.profiles import PROFILES
from mmrs_mavlink.sitl.imitated import IMITATED, UNCONFIRMED, page_table

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "rehearse.md"
TABLE = re.compile(r"\| what \| how \| confirmed by a flight \|\n(?:\|[^\n]*\n)+")


def test_the_table_is_current(request):
    page = PAGE.read_text("utf-8")
    current = TABLE.sub(lambda _: page_table() + "\n", page)
    if request.config.getoption("--update-golden"):
        PAGE.write_text(current, "utf-8")
    assert TABLE.search(page)
    assert PAGE.read_text("utf-8") == current


def test_each_row_names_firmware_that_a_profile_is_of():
    known = {"ArduCopter", "ArduRover", "ArduSub", "PX4"}
    assert {name.partition("-")[0] for name in PROFILES} >= {name.lower() for name in known}
    assert all(flown == UNCONFIRMED or set(flown.split(", ")) <= known for _, _, flown in IMITATED)
