from math import inf

import pytest

from mmrs_runtime.injection import injections

pytestmark = pytest.mark.real_time("parts of flights")

URLS = {"alpha": "udpin:127.0.0.1:1", "beta": "udpin:127.0.0.1:2", "a,b:c": "udpin:127.0.0.1:3"}


def the_one(text: str):
    (fault,) = injections([text], URLS).faults
    return fault


def test_parts_and_delays_are_for_the_whole_run():
    loss, delay = injections(["loss=0.15,delay=0.2~0.1"], URLS).faults
    assert (loss.name, loss.amount, loss.robot, loss.begins, loss.ends) == ("loss", 0.15, "", 0.0, inf)
    assert (delay.amount, delay.spread) == (0.2, 0.1)


def test_a_timed_fault_begins_and_ends():
    cut = the_one("alpha:cut@60+20")
    assert (cut.robot, cut.begins, cut.ends) == ("alpha", 60.0, 80.0)
    assert [cut.acts(time) for time in (59.9, 60.0, 79.9, 80.0)] == [False, True, True, False]


def test_a_timed_fault_without_an_end_stays():
    assert the_one("disk-full@5").ends == inf


@pytest.mark.parametrize(("text", "seconds"), [("clock-jump@9+3600", 3600.0), ("clock-jump@9-3600", -3600.0)])
def test_a_clock_jumps_either_way(text, seconds):
    assert the_one(text).amount == seconds


def test_names_of_robots_may_hold_commas_and_colons():
    first, second = injections(["a,b:c:loss=0.5,alpha:loss=0.1"], URLS).faults
    assert (first.robot, second.robot) == ("a,b:c", "alpha")


def test_the_seed_is_that_of_all():
    assert injections(["loss=0.5,seed=7", "delay=1"], URLS).seed == 7


def test_faults_of_a_link_are_those_of_its_robots_and_of_all():
    given = injections(["loss=0.5", "alpha:delay=1,beta:corrupt=0.1,freeze@1+1"], URLS)
    assert [fault.name for fault in given.of_link(["alpha"])] == ["loss", "delay"]


def test_what_is_timed_comes_in_its_order():
    given = injections(["cut@20,freeze@10+1,loss=1"], URLS)
    assert [fault.name for fault in given.timed()] == ["freeze", "cut"]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("lost=0.1", "is not a fault; there are loss, duplicate"),
        ("loss", "say loss=0.15"),
        ("", "is not a fault"),
        (",loss=0.1", "is not a fault"),
        ("loss=0.1,", "^'': is not a fault"),
        ("loss=1.5", "at most 1"),
        ("loss=-0.5", "say loss=0.15"),
        ("loss=0.5~0.1", "only a delay differs"),
        ("delay=0.1~0.2", "by no more than itself"),
        ("loss=0.1,loss=0.2", "asked for twice"),
        ("cut=0.5", "say cut@SECOND"),
        ("loss@5", "say loss=0.15"),
        ("delay=x", "say delay=0.2"),
        ("cut@", "say cut@SECOND"),
        ("clock-jump@90+x", "say clock-jump@SECOND"),
        ("cut@60-20", "ends before it begins"),
        ("freeze@60", "say for how many seconds"),
        ("clock-jump@60+4000000000", "no calendar reaches so far"),
        ("clock-jump@60", "say by how many seconds"),
        ("gamma:loss=0.1", "unknown robot 'gamma'"),
        ("alpha:freeze@1+1", "concerns all robots"),
        ("alpha:disk-full@1", "concerns all robots"),
        ("seed=x", "is not seed=NUMBER"),
        ("alpha:seed=1", "is not a fault"),
    ],
)
def test_what_makes_no_sense_is_refused(text, complaint):
    with pytest.raises(ValueError, match=complaint):
        injections([text], URLS)


@pytest.mark.parametrize("text", ["loss=0.1", "cut@1", "gps-lost@1", "ground-cut@1"])
def test_a_dry_run_has_no_links_to_make_faulty(text):
    with pytest.raises(ValueError, match="a dry run has no link"):
        injections([text], URLS, dry=True)


def test_a_dry_run_can_have_a_full_disk():
    assert injections(["disk-full@1"], URLS, dry=True).faults


def test_one_robot_of_a_shared_link_cannot_have_faults_of_its_own():
    shared = {"alpha": "udpin:127.0.0.1:1", "beta": "udpin:127.0.0.1:1"}
    with pytest.raises(ValueError, match="that of 'beta', too"):
        injections(["alpha:loss=0.1"], shared)
    assert injections(["loss=0.1"], shared).of_link(["alpha", "beta"])
