"""What must happen whatever Choices decide, if slots are only ever activated.

Every step stays possible until it is taken, and steps of different robots do not disturb each other;
so without Choices all runs end in the same state, and one run shows it. With Choices, a slot
counts as activated if some robot activates it on every path it can take; that is sound, but not complete.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass

from mmrs_core.analysis.synchronisation.network import Net, Network
from mmrs_core.behaviour.program import SlotId
from mmrs_core.behaviour.walk import reachable


@dataclass(frozen=True, slots=True)
class Fixpoint:
    """What all runs have in common.

    Attributes:
        active: slots that are activated in every run.
        blocked: by number of the net, the nodes at which that robot may wait for a slot not among
            `active`; robots that certainly come to Stop are missing.
    """

    active: frozenset[SlotId]
    blocked: dict[int, tuple[int, ...]]


def must_fixpoint(network: Network) -> Fixpoint:
    """Return the least set of certain activations. Exact for robots none of which makes a Choice."""
    active: set[SlotId] = set()
    waiting: dict[SlotId, set[int]] = defaultdict(set)
    blocked: dict[int, tuple[int, ...]] = {}
    pending = deque(range(len(network.nets)))
    progress = [_Progress(net) for net in network.nets]
    while pending:
        number = pending.popleft()
        certain, ends = progress[number].advance(active)
        blocked[number] = ends
        for end in ends:
            for slot in network.nets[number].nodes[end].waits - active:
                waiting[slot].add(number)
        for slot in certain - active:
            active.add(slot)
            pending.extend(sorted(waiting.pop(slot, ())))
    return Fixpoint(frozenset(active), {number: ends for number, ends in blocked.items() if ends})


def may_fixpoint(network: Network) -> Fixpoint:
    """Return what comes of all Choices taking every branch at once with no slot made inactive again.

    No run activates more: `active` are the slots that any may, `blocked` where robots that never come
    to Stop wait at the latest. Quadratic at worst.
    """
    active: set[SlotId] = set()
    while True:
        reached = [_passable(net, active) for net in network.nets]
        given = {
            slot
            for net, nodes in zip(network.nets, reached, strict=True)
            for node in nodes
            for slot in net.nodes[node].gives
        }
        if given <= active:
            break
        active |= given
    blocked = {
        number: tuple(sorted(node for node in nodes if not net.nodes[node].waits <= active))
        for number, (net, nodes) in enumerate(zip(network.nets, reached, strict=True))
        if net.stop not in nodes
    }
    return Fixpoint(frozenset(active), {number: nodes for number, nodes in blocked.items() if nodes})


def _passable(net: Net, active: set[SlotId]) -> frozenset[int]:
    return reachable([node.branches if node.waits <= active else () for node in net.nodes], (0,))


class _Progress:
    """How far one robot certainly gets; a path without branches is never followed twice."""

    def __init__(self, net: Net) -> None:
        self.net = net
        self.at = 0
        self.given: set[SlotId] = set()
        self.entered = False

    def advance(self, active: set[SlotId]) -> tuple[frozenset[SlotId], tuple[int, ...]]:
        """Return what the robot certainly activates, and where it may be blocked, given these slots."""
        passed: set[int] = set()
        while True:
            node = self.net.nodes[self.at]
            if not self.entered:
                self.given |= node.gives
                self.entered = True
            if not node.waits <= (active | self.given):
                return frozenset(self.given), (self.at,)
            if len(node.branches) != 1:
                break
            if self.at in passed:
                return frozenset(self.given), ()
            passed.add(self.at)
            self.at, self.entered = node.branches[0], False
        if not self.net.nodes[self.at].branches:
            return frozenset(self.given), ()
        return self._spread(active)

    def _spread(self, active: set[SlotId]) -> tuple[frozenset[SlotId], tuple[int, ...]]:
        """Return the same from a Choice on: what lies on all paths to where the robot may end.

        A wait for slots that the robot itself activated on all paths to it is not a blockage.
        """
        entering: dict[int, frozenset[SlotId]] = {self.at: frozenset(self.given)}
        pending = deque([self.at])
        while pending:
            index = pending.popleft()
            node = self.net.nodes[index]
            have = entering[index] | node.gives
            for branch in node.branches if node.waits <= active | have else ():
                common = have & entering.get(branch, have)
                if branch not in entering or common != entering[branch]:
                    entering[branch] = common
                    pending.append(branch)
        return self._ends(active, entering)

    def _ends(
        self, active: set[SlotId], entering: dict[int, frozenset[SlotId]]
    ) -> tuple[frozenset[SlotId], tuple[int, ...]]:
        leaving = {index: have | self.net.nodes[index].gives for index, have in entering.items()}
        blocked = tuple(
            index for index in sorted(entering) if not self.net.nodes[index].waits <= active | leaving[index]
        )
        ends = [leaving[index] for index in blocked]
        if self.net.stop is not None and self.net.stop in leaving:
            ends.append(leaving[self.net.stop])
        certain = frozenset.intersection(*ends) if ends else frozenset(self.given)
        return certain | self.given, blocked
