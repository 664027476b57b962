"""An exact search for a run that leaves a robot waiting forever, if slots are only ever activated.

Such a run exists exactly if there is a set D of slots, none of which is active in every run, and for
every robot a path after its Start that activates none of D and ends at Stop or at a wait for one of D, at
least one of them not at Stop: D are the slots that are inactive in the end. No interleavings need to be
looked at. D is found by backtracking over its slots; the question is NP-complete, so there is a limit.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from mmrs_core.analysis.synchronisation.network import Net, Network
from mmrs_core.behaviour.program import SlotId
from mmrs_core.errors import InternalError

LIMIT = 20_000
"""How many sets of slots are tried before the search gives up."""


@dataclass(frozen=True, slots=True)
class Stuck:
    """A deadlocked robot.

    Attributes:
        net, node: where it is. missing: slots that it waits for and that never become active.
    """

    net: int
    node: int
    missing: frozenset[SlotId]


@dataclass(frozen=True, slots=True)
class Trap:
    """A path for every robot that together leave some of them stuck. Attributes: nodes by net; who is."""

    paths: tuple[tuple[int, ...], ...]
    stuck: tuple[Stuck, ...]


class LimitExceededError(Exception):
    """The search was given up before it had an answer."""


def find_trap(network: Network, certain: frozenset[SlotId], *, limit: int = LIMIT) -> Trap | None:
    """Return a run that leaves robots stuck, or None if there is none: a proof in both cases.

    Args:
        network: without resets.
        certain: slots known to be activated in every run; more of them make the search shorter.
        limit: how many steps may be made.

    Raises:
        LimitExceededError: after so many steps without an answer.
    """
    inactive = _Search(network, certain, limit).run()
    return None if inactive is None else follow(network, _paths(network, certain, inactive))


class _Search:
    """Decides for slots, one after the other, whether they are in D; `inside` and `outside` hold them."""

    def __init__(self, network: Network, certain: frozenset[SlotId], limit: int) -> None:
        self.network = network
        self.inside: set[SlotId] = set()
        self.outside: set[SlotId] = set(certain)
        self.left = limit
        self.concerned: dict[SlotId, list[int]] = defaultdict(list)
        for number, net in enumerate(network.nets):
            for slot in sorted(frozenset().union(*(node.gives | node.waits for node in net.nodes))):
                self.concerned[slot].append(number)
        self.reach = [_reach(net, self.inside, self.outside) for net in network.nets]

    def run(self) -> set[SlotId] | None:
        """Return D, or None if there is none; depth first, without recursion."""
        decided: list[tuple[SlotId, bool]] = []
        while True:
            if all(reach.ends for reach in self.reach):
                if self._complete():
                    return set(self.inside)
                slot = self._next_slot()
                if slot is not None:
                    self._decide(slot, True)
                    decided.append((slot, True))
                    continue
            while decided and not decided[-1][1]:
                self._undo(decided.pop()[0])
            if not decided:
                return None
            slot = decided.pop()[0]
            self._undo(slot)
            self._decide(slot, False)
            decided.append((slot, False))

    def _decide(self, slot: SlotId, inside: bool) -> None:
        self.left -= 1
        if self.left < 0:
            raise LimitExceededError
        (self.inside if inside else self.outside).add(slot)
        self._update(slot)

    def _undo(self, slot: SlotId) -> None:
        self.inside.discard(slot)
        self.outside.discard(slot)
        self._update(slot)

    def _update(self, slot: SlotId) -> None:
        for number in self.concerned[slot]:
            self.reach[number] = _reach(self.network.nets[number], self.inside, self.outside)

    def _complete(self) -> bool:
        """Return whether D may be what is inside already: everyone has an end, and not all are Stop."""
        return all(reach.settled for reach in self.reach) and any(reach.stuck for reach in self.reach)

    def _next_slot(self) -> SlotId | None:
        """Return an undecided slot that a robot without a settled end waits for, or else any robot."""
        unsettled = [reach.open for reach in self.reach if not reach.settled]
        for slots in (unsettled, [reach.open for reach in self.reach]):
            found = [min(each) for each in slots if each]
            if found:
                return found[0]
        return None


@dataclass(frozen=True, slots=True)
class _Reach:
    """What one robot can do under the decisions made.

    Attributes:
        ends: whether it may end at Stop or at a wait, undecided slots being what suits it.
        settled: whether it may with no more slots in D. stuck: whether at a wait for one of D.
        open: undecided slots that it may wait for.
    """

    ends: bool
    settled: bool
    stuck: bool
    open: frozenset[SlotId]


def _reach(net: Net, inside: set[SlotId], outside: set[SlotId]) -> _Reach:
    stuck = stopped = False
    undecided: set[SlotId] = set()
    seen = {0}
    pending = [0]
    while pending:
        index = pending.pop()
        node = net.nodes[index]
        if not inside.isdisjoint(node.gives):
            continue
        if not inside.isdisjoint(node.waits):
            stuck = True
            continue
        undecided |= node.waits - outside
        stopped = stopped or index == net.stop
        pending.extend(branch for branch in node.branches if branch not in seen)
        seen.update(node.branches)
    settled = stuck or stopped
    return _Reach(settled or bool(undecided), settled, stuck, frozenset(undecided))


def _paths(network: Network, certain: frozenset[SlotId], inactive: set[SlotId]) -> list[tuple[int, ...]]:
    return [_path(net, inactive - certain) for net in network.nets]


def _path(net: Net, inactive: set[SlotId]) -> tuple[int, ...]:
    came: dict[int, int] = {0: -1}
    pending = [0]
    ends: list[int] = []
    for index in pending:
        node = net.nodes[index]
        if not inactive.isdisjoint(node.gives):
            continue
        if not inactive.isdisjoint(node.waits):
            return _back(came, index)
        if index == net.stop:
            ends.append(index)
        for branch in node.branches:
            if branch not in came:
                came[branch] = index
                pending.append(branch)
    if not ends:
        raise InternalError(f"robot '{net.robot}' has no path that ends, though one was found")
    return _back(came, ends[0])


def _back(came: dict[int, int], index: int) -> tuple[int, ...]:
    path = [index]
    while came[path[-1]] >= 0:
        path.append(came[path[-1]])
    return tuple(reversed(path))


def follow(network: Network, paths: list[tuple[int, ...]]) -> Trap:
    """Return where the robots end up if they take these paths, as far as they get.

    Raises:
        InternalError: if no robot is stuck: the search was wrong.
    """
    active: set[SlotId] = set()
    at = [0] * len(paths)
    moved = True
    while moved:
        moved = False
        for number, path in enumerate(paths):
            net = network.nets[number]
            active |= net.nodes[path[at[number]]].gives
            while at[number] < len(path) - 1 and net.nodes[path[at[number]]].waits <= active:
                at[number] += 1
                active |= net.nodes[path[at[number]]].gives
                moved = True
    ends = [(number, path[at[number]]) for number, path in enumerate(paths)]
    stuck = tuple(
        Stuck(number, node, network.nets[number].nodes[node].waits - active)
        for number, node in ends
        if not network.nets[number].nodes[node].waits <= active
    )
    if not stuck:
        raise InternalError("no robot is stuck in the run that was found to leave one stuck")
    return Trap(tuple(paths), stuck)
