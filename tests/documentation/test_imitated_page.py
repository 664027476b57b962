"""The page about rehearsals says of all that simulated vehicles imitate which flight has confirmed it."""

import re
from pathlib import Path

from mmrs_mavlink.profiles import PROFILES
from mmrs_mavlink.sitl import FAULTS

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "rehearse.md").read_text("utf-8")
TABLE = re.compile(r"\| what \| how \| confirmed by a flight \|\n\|---\|---\|---\|\n((?:\|[^\n]*\n)+)")
FIRMWARE = {"ArduCopter", "ArduRover", "ArduSub", "PX4"}


def test_each_row_names_the_firmware_that_was_flown_or_why_it_is_there_all_the_same():
    rows = [line.strip("| ").split(" | ") for line in TABLE.search(PAGE)[1].splitlines()]
    assert {name.partition("-")[0] for name in PROFILES} >= {name.lower() for name in FIRMWARE}
    assert len(rows) > 15
    for what, _, flown in rows:
        assert flown.startswith("no: ") or set(flown.split(", ")) <= FIRMWARE, what


def test_each_fault_is_explained():
    assert set(re.findall(r"^\| `([a-z-]+)` \| [^|]*\|", PAGE, re.MULTILINE)) == set(FAULTS)
