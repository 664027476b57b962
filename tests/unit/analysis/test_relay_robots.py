"""Robots as relays in the check of radio range, worked out by hand: radios reach 100 m.

Robot a goes 180 m out, robot r is a relay 90 m out. Moves take between half and double their time.
"""

from dataclasses import replace

import pytest
from checking import FLYER, findings, given, kind, land, rover, strange, take_off, uneven

from mmrs_core.contributions.checks import Status
from mmrs_core.scene import Part
from mmrs_core.scene.relays import RELAY
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, hold, notify, robot

RADIO = {"communicationRange": 100.0}
CARRIER = {**RADIO, "relayRange": 100.0}
OUT, MIDDLE, HOME = (180.0, 0.0, 0.0), (90.0, 0.0, 0.0), (0.0, 0.0, 0.0)


def carrier(id, moves, **more):
    return replace(robot(id, moves, **more), type_name="carrier")


def relay(*, waits=("back",), at=MIDDLE, more=()):
    """Return a relay that tells a when it is in place, and leaves when it has been told to."""
    there = go("there", at, after=(notify("a.ready"),))
    return carrier("r", [there, hold("stay", 0.0), *more, go("leave", HOME)], waits={"stay": waits})


def user(*, waits=("ready",), tells="home", to=OUT):
    """Return a robot that goes out when it is told to, and tells r after one of its moves."""
    moves = [hold("begin", 0.0), go("out", to), hold("work", 5.0), go("home", HOME), hold("end", 0.0)]
    told = [replace(each, after=(notify("r.back"),)) if each.id == tells else each for each in moves]
    return robot("a", told, waits={"begin": waits})


def judged(*robots, figures=CARRIER, moves=None, flying=False, **more):
    """Return the verdict on the range of a."""
    robot_kind = kind(FLYER, launches=True) if flying else kind()
    metaclass = robot_kind.metaclass
    types = {
        name: replace(rover(attributes=attributes), name=name, metaclasses=(metaclass,))
        for name, attributes in ((ROBOT_TYPE, RADIO), ("carrier", figures))
    }
    input = given(*robots, robot_kind=robot_kind, moves=moves or uneven(), **more)
    (verdict,) = [each for each in findings("range", replace(input, types=types)) if each.robot == "a"]
    return verdict


def test_a_relay_counts_that_comes_before_and_leaves_after_because_robots_wait_for_each_other():
    verdict = judged(user(), relay())
    assert (verdict.status, verdict.margin) == (Status.SAFE, pytest.approx(10.0))
    assert "leads 90.00 m away from relay 'r' at (180.0, 0.0, 0.0)" in verdict.message


@pytest.mark.parametrize(
    ("one", "other", "move", "when"),
    [
        (user(waits=()), relay(), "out", "throughout"),
        (user(), relay(waits=()), "out", "throughout"),
        (user(tells="begin"), relay(), "out", "throughout"),
        (user(tells="out"), relay(), "out", "during the wait after it"),
        (user(tells="work"), relay(), "work", "during the wait after it"),
    ],
    ids=["a sets out before", "r does not wait", "told at once", "told far out", "told before the way back"],
)
def test_a_relay_that_may_come_later_or_leave_sooner_counts_for_nothing(one, other, move, when):
    verdict = judged(one, other)
    assert verdict.status is Status.VIOLATED
    assert verdict.margin == pytest.approx(-80.0)
    assert verdict.move == move
    assert verdict.message.endswith(f"; it is not certain that 'r' is a relay {when}")


def test_a_relay_that_may_leave_while_a_robot_waits_far_out_counts_for_nothing_in_that_wait():
    """It is told when a is there, where a then waits for b."""
    moves = [hold("begin", 0.0), go("out", OUT, after=(notify("r.back"),)), go("home", HOME)]
    waiting = robot("a", moves, waits={"begin": ("ready",), "out": ("on",)})
    b = robot("b", [hold("long", 500.0, after=(notify("a.on"),))])
    stay = carrier(
        "r",
        [go("there", MIDDLE, after=(notify("a.ready"),)), hold("stay"), go("leave", HOME)],
        waits={"stay": ("back",)},
    )
    verdict = judged(waiting, stay, b)
    assert verdict.status is Status.VIOLATED


def test_certain_times_do_instead_of_messages():
    """R is there after 45 s at the latest and leaves after 400 s at the earliest; a is out in between."""
    exact = {"moves": uneven(1.0, 1.0)}
    stay = carrier("r", [go("there", MIDDLE), hold("stay", 400.0), go("leave", HOME)])
    late = robot("a", [hold("begin", 50.0), go("out", OUT), go("home", HOME)])
    assert judged(late, stay, **exact).status is Status.SAFE
    early = robot("a", [hold("begin", 20.0), go("out", OUT), go("home", HOME)])
    assert judged(early, stay, **exact).status is Status.VIOLATED
    long = robot("a", [hold("begin", 50.0), go("out", OUT), hold("work", 250.0), go("home", HOME)])
    assert judged(long, stay, **exact).status is Status.VIOLATED
    assert judged(late, stay).status is Status.VIOLATED


def test_a_robot_that_carries_no_relay_or_passes_on_for_itself_does_not_count():
    assert judged(user(), relay(), figures=RADIO).status is Status.VIOLATED
    alone = carrier("a", [go("there", MIDDLE), hold("stay"), go("out", OUT), go("home", HOME)])
    assert judged(alone).status is Status.VIOLATED


def test_a_relay_reaches_as_far_as_the_smaller_range_and_must_be_in_reach_of_home():
    short = {**RADIO, "relayRange": 95.0}
    assert judged(user(), relay(), figures=short).margin == pytest.approx(5.0)
    far = relay(at=(96.0, 0.0, 0.0))
    assert judged(user(), far, figures=short).status is Status.VIOLATED


def test_both_robots_may_be_off_by_the_position_error():
    assert judged(user(), relay(), position_error=4.0).margin == pytest.approx(2.0)
    assert judged(user(), relay(), position_error=6.0).margin == pytest.approx(-2.0)


def test_chains_lead_over_relays_of_the_context_and_robots():
    mast = Part((RELAY,), {"name": "mast", "position": (95.0, 0.0, 0.0), "range": 100.0})
    beyond = relay(at=(190.0, 0.0, 0.0))
    found = judged(user(to=(280.0, 0.0, 0.0)), beyond, elements=(mast,))
    assert (found.status, found.margin) == (Status.SAFE, pytest.approx(10.0))


def test_a_relay_counts_only_if_it_comes_to_its_place_in_every_run():
    """On both branches it tells a, and waits until it is told; on one of them it is not where a needs it."""
    ready = (notify("a.ready"),)
    moves = [
        hold("ask", 0.0),
        *(go("there", MIDDLE, after=ready), hold("stay", 0.0)),
        *(go("elsewhere", (50.0, 0.0, 0.0), after=ready), hold("stay there", 0.0)),
        go("leave", HOME),
    ]
    choosing = carrier(
        "r",
        moves,
        choices={"ask": ("windy", "there", "elsewhere")},
        jumps={"stay": "leave"},
        waits={"stay": ("back",), "stay there": ("back",)},
    )
    assert judged(user(), choosing).status is Status.VIOLATED


def test_a_relay_that_moves_on_before_it_is_told_counts_only_where_it_stands():
    aside = go("aside", (90.0, 5.0, 0.0))
    assert judged(user(), relay(more=())).status is Status.SAFE
    wandering = carrier(
        "r",
        [go("there", MIDDLE, after=(notify("a.ready"),)), aside, hold("stay", 0.0), go("leave", HOME)],
        waits={"stay": ("back",)},
    )
    assert judged(user(), wandering).status is Status.VIOLATED


def test_a_relay_that_makes_a_move_that_nobody_knows_may_have_left():
    unknown = carrier(
        "r",
        [go("there", MIDDLE, after=(notify("a.ready"),)), strange("dig"), hold("stay", 0.0)],
        waits={"stay": ("back",)},
    )
    assert judged(user(), unknown).status is Status.VIOLATED


def test_a_robot_is_no_relay_on_the_ground():
    place = (90.0, 0.0, 20.0)
    up, away = take_off("up", 20.0), go("there", place)
    flown = [
        take_off("up", 20.0),
        go("out", (180.0, 0.0, 20.0)),
        go("home", (0.0, 0.0, 20.0)),
        land("down", after=(notify("r.back"),)),
    ]
    flier = robot("a", [hold("begin", 0.0), *flown], waits={"begin": ("ready",)})
    ready = (notify("a.ready"),)
    aloft = carrier(
        "r",
        [up, replace(away, after=ready), hold("stay", 0.0), go("leave", (0.0, 0.0, 20.0)), land("down")],
        waits={"stay": ("back",)},
    )
    assert judged(flier, aloft, flying=True).status is Status.SAFE
    landed = carrier(
        "r",
        [up, away, land("down", after=ready), hold("stay", 0.0), take_off("up again", 20.0)],
        waits={"stay": ("back",)},
    )
    assert judged(flier, landed, flying=True).status is Status.VIOLATED


def test_only_those_robots_are_named_as_uncertain_that_would_do_as_relays():
    """Robot s holds its position, too, but far from a."""
    aside = carrier("s", [go("aside", (0.0, 90.0, 0.0)), hold("look", 5.0), go("leave", HOME)])
    verdict = judged(user(waits=()), relay(), aside)
    assert verdict.message.endswith("; it is not certain that 'r' is a relay throughout")


def test_all_robots_of_a_chain_are_named_as_uncertain():
    far = carrier("s", [go("there", OUT), hold("look", 5.0), go("leave", HOME)])
    verdict = judged(user(to=(270.0, 0.0, 0.0)), relay(waits=()), far)
    assert verdict.message.endswith("; it is not certain that 'r' and 's' are relays throughout")
