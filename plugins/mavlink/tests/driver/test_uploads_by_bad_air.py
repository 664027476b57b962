"""Plans that go over links that lose, double, delay and reorder: kept whole, or refused truthfully."""

from collections.abc import Sequence
from contextlib import suppress

import pytest
from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st
from virtual_link import Air, VirtualLink

from mmrs_mavlink.services.items import FENCE, MISSION, NAMES, RALLY, Item
from mmrs_mavlink.services.missions import upload, verify
from mmrs_mavlink.sitl.items import StoredItem
from mmrs_runtime.faults import RefusedError

FIRMWARES = ("ardupilot", "px4")
LONGEST = 1800.0
"""Seconds that an upload with its reading back takes at most, whatever happens to it."""

AIRS = st.builds(
    Air,
    loss=st.sampled_from([0.0, 0.05, 0.15, 0.3]),
    double=st.sampled_from([0.0, 0.1, 0.5]),
    delay=st.floats(0.0, 2.0),
    jitter=st.sampled_from([0.0, 0.1, 0.5, 2.0]),
)
COMMANDS = {MISSION: 16, FENCE: 5002, RALLY: 5100}


def plan(kind: int, number: int, mark: int) -> list[Item]:
    """Return a plan that no other of its kind is like."""
    params = (float(max(3, number)) if kind == FENCE else 0.0, 0.0, 0.0, 0.0)
    return [
        Item(COMMANDS[kind], params, 423_700_000 + 100 * n, 133_500_000 + 1000 * mark, 20.0)
        for n in range(number)
    ]


def old_plan(kind: int, number: int) -> list[StoredItem]:
    return [StoredItem(3, each.command, each.params, each.x, each.y, 5.0) for each in plan(kind, number, 77)]


def places(items: Sequence[Item | StoredItem]) -> list[tuple[int, int]]:
    return [(item.x, item.y) for item in items]


def check(link: VirtualLink, wanted: list[Item], kind: int) -> None:
    """Upload and read back a plan, and check that what is said about it is so."""
    had, begun = places(link.stores[kind]), link.clock.now()
    try:
        upload(link, wanted, kind)
    except RefusedError as refused:
        told, has = str(refused), places(link.stores[kind])
        assert "it has none now" not in told or has == []
        assert "; it keeps what it had" not in told or has == had
        assert told.startswith(f"{NAMES[kind]}: the vehicle ")
        assert "; it " in told or "not known" in told
    else:
        if is_read_back(link, wanted, kind):
            assert places(link.stores[kind]) == places(wanted)
            link.settle()
            assert places(link.stores[kind]) == places(wanted)
    assert link.clock.now() - begun < LONGEST


def is_read_back(link: VirtualLink, wanted: list[Item], kind: int) -> bool:
    """Return whether reading back finds what was wanted."""
    with suppress(RefusedError):
        verify(link, wanted, kind)
        return True
    return False


def upload_all(firmware: str, kinds: Sequence[int], size: int, before: int, air: Air, seed: int) -> None:
    """Upload plans of these kinds, one after the other, to a vehicle that has others."""
    link = VirtualLink(firmware, air, seed)
    for kind in COMMANDS:
        link.stores[kind] = old_plan(kind, before)
    for mark, kind in enumerate(kinds):
        check(link, plan(kind, size, mark), kind)


anyhow = given(
    firmware=st.sampled_from(FIRMWARES),
    kinds=st.lists(st.sampled_from(list(COMMANDS)), min_size=1, max_size=3),
    size=st.integers(0, 12),
    before=st.integers(0, 12),
    air=AIRS,
    seed=st.integers(0, 1 << 30),
)


@anyhow
@settings(max_examples=many(1500, fast=25))
def test_a_plan_is_kept_whole_or_refused_truthfully(firmware, kinds, size, before, air, seed):
    upload_all(firmware, kinds, size, before, air, seed)


@pytest.mark.parametrize("firmware", FIRMWARES)
@pytest.mark.parametrize("delay", [0.0, 0.1, 0.6, 1.0, 2.0])
@pytest.mark.parametrize("double", [0.0, 0.5])
def test_what_only_comes_late_and_twice_is_kept(firmware, delay, double):
    link = VirtualLink(firmware, Air(double=double, delay=delay), seed=3)
    for kind in COMMANDS:
        upload(link, plan(kind, 12, 1), kind)
        verify(link, plan(kind, 12, 1), kind)
        assert places(link.stores[kind]) == places(plan(kind, 12, 1))


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_most_plans_are_kept_where_every_tenth_frame_is_lost(firmware):
    kept = 0
    for seed in range(20):
        link = VirtualLink(firmware, Air(loss=0.1, double=0.05, delay=0.3, jitter=0.05), seed)
        with suppress(RefusedError):
            for kind in COMMANDS:
                upload(link, plan(kind, 10, 1), kind)
                verify(link, plan(kind, 10, 1), kind)
            kept += 1
    assert kept >= 18
