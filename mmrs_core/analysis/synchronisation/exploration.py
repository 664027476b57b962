"""All orders of events that matter, for behaviours that make slots inactive again.

A notify to several slots reaches them one after the other, in any order, because that is what happens
on a network; this contains the case in which it reaches all at once.

A step that touches only slots that are never made inactive stays possible until it is taken and
disturbs no other, so that it may be taken at once (persistent sets; Godefroid 1996): what remains is
the order of the steps that touch the others. Deadlocks are all kept.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias

from mmrs_core.analysis.synchronisation.network import Net, Network
from mmrs_core.analysis.synchronisation.search import LimitExceededError, Stuck
from mmrs_core.behaviour.program import SlotId

LIMIT = 50_000
"""How many states are looked at before the exploration gives up."""


@dataclass(frozen=True, slots=True)
class NetPosition:
    """Where a robot is: at a node, in a group of slots that it sets, of which some are left."""

    node: int
    group: int
    left: frozenset[SlotId]


State: TypeAlias = "tuple[tuple[NetPosition, ...], frozenset[SlotId]]"


def find_stuck(network: Network, *, limit: int = LIMIT) -> tuple[Stuck, ...] | None:
    """Return who is stuck in the first deadlock met, breadth first, or None if there is none.

    Raises:
        LimitExceededError: after so many states without an answer.
    """
    first: State = (tuple(_enter(net, 0) for net in network.nets), frozenset())
    seen = {first}
    pending = deque([first])
    while pending:
        state = pending.popleft()
        following = list(_steps(network, state))
        if not following:
            stuck = _stuck(network, state)
            if stuck:
                return stuck
        for each in following:
            if each not in seen:
                if len(seen) >= limit:
                    raise LimitExceededError
                seen.add(each)
                pending.append(each)
    return None


def _steps(network: Network, state: State) -> Iterator[State]:
    spots, active = state
    for number in _enough(network, state):
        for after, now in _moves(network, network.nets[number], spots[number], active):
            yield (*spots[:number], after, *spots[number + 1 :]), now


def _enough(network: Network, state: State) -> Iterable[int]:
    """Return the robots whose steps need to be looked at: one whose step commutes, or else all."""
    spots, active = state
    for number, spot in enumerate(spots):
        node = network.nets[number].nodes[spot.node]
        if spot.left:
            commutes = not spot.left <= network.volatile
        else:
            commutes = (
                bool(node.branches) and node.waits <= active and node.waits.isdisjoint(network.volatile)
            )
        if commutes:
            return (number,)
    return range(len(spots))


def _moves(
    network: Network, net: Net, spot: NetPosition, active: frozenset[SlotId]
) -> Iterator[tuple[NetPosition, frozenset[SlotId]]]:
    node = net.nodes[spot.node]
    if spot.left:
        value = node.sets[spot.group][1]
        for slot in sorted(spot.left - network.volatile)[:1] or sorted(spot.left):
            yield _without(net, spot, slot), active | {slot} if value else active - {slot}
    elif node.waits <= active:
        for branch in node.branches:
            yield _enter(net, branch), active


def _enter(net: Net, node: int) -> NetPosition:
    sets = net.nodes[node].sets
    return NetPosition(node, 0, sets[0][0] if sets else frozenset())


def _without(net: Net, spot: NetPosition, slot: SlotId) -> NetPosition:
    left = spot.left - {slot}
    sets = net.nodes[spot.node].sets
    if left or spot.group + 1 == len(sets):
        return replace(spot, left=left)
    return NetPosition(spot.node, spot.group + 1, sets[spot.group + 1][0])


def _stuck(network: Network, state: State) -> tuple[Stuck, ...]:
    spots, active = state
    return tuple(
        Stuck(number, spot.node, network.nets[number].nodes[spot.node].waits - active)
        for number, spot in enumerate(spots)
        if not network.nets[number].nodes[spot.node].waits <= active
    )
