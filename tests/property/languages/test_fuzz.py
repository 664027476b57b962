"""Damaged models of every kind are refused or have faults; they never break us, hang, or fill the memory."""

import pytest
from fuzz_ways import ways
from fuzzing import HangError, Way, fuzz, in_time

LARGEST_FACTORS = {"XMI": 40.0, "JSON": 40.0, "project": 60.0, "ecore": 150.0, "migrate": 60.0}
"""Bytes of memory for a byte of text: the tag of an element of some hundred bytes may have ten letters only.

A class takes some kilobytes; a project has other files besides the damaged one.
"""


def judged(contributions, folder, cases, seed):
    tallies = fuzz(ways(contributions, folder), cases, seed)
    assert {name: tally.defects for name, tally in tallies.items() if tally.defects} == {}
    assert all(sum(tally.ends.values()) for tally in tallies.values())
    assert all(tally.worst_factor < LARGEST_FACTORS[name] for name, tally in tallies.items())
    return tallies


def test_damaged_models_never_break_us(contributions, tmp_path):
    """Migration goes on with other files, so that one that cannot be read is a fault to it."""
    tallies = judged(contributions, tmp_path, 150, seed=1)
    assert all("faults" in tally.ends for tally in tallies.values())
    assert all("unreadable" in tally.ends for name, tally in tallies.items() if name != "migrate")


@pytest.mark.thorough
@pytest.mark.timeout(7200)
def test_a_hundred_thousand_damaged_models_never_break_us(contributions, tmp_path):
    judged(contributions, tmp_path, 100_000, seed=2)


def test_a_reader_that_breaks_is_a_defect():
    def breaks(text, name):
        if text != b"sound":
            raise KeyError(name)
        return "sound"

    tally = fuzz([Way("broken", breaks, (("a", b"sound"),))], 5, seed=0)["broken"]
    assert len(tally.defects) == 5


def test_a_reader_that_hangs_is_told():
    def hang():
        while True:
            pass

    with pytest.raises(HangError), in_time(0.05):
        hang()
