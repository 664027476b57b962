"""What matters of a behaviour for synchronisation: slots set, slots awaited, branches.

Moves that neither set nor await a slot that matters, and have one successor, are passed over: they
are always possible and touch nothing. A node stands for a move that remains. The reduction keeps
deadlocks: a robot is stuck in the reduced network exactly if it is in the behaviour.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program, RobotProgram, SlotId
from mmrs_core.behaviour.walk import reachable, reachable_moves
from mmrs_runtime.program import ExecutableRobot
from mmrs_runtime.semantics import Phase, entry, steps
from mmrs_runtime.semantics import awaited as awaited_at


@dataclass(frozen=True, slots=True)
class NetNode:
    """A move that synchronisation depends on, with the transition that leaves it.

    Attributes:
        move: index in the robot.
        sets: groups of slots, in order; each group is set to its value by one notify.
        waits: what the transition waits for.
        branches: numbers of the nodes that may follow; empty for Stop and for a move that never ends.
        heads: for each of `branches`, the move that it begins with, which may be passed over itself.
    """

    move: int
    sets: tuple[tuple[frozenset[SlotId], bool], ...] = ()
    waits: frozenset[SlotId] = frozenset()
    branches: tuple[int, ...] = ()
    heads: tuple[int, ...] = ()

    @property
    def gives(self) -> frozenset[SlotId]:
        """Return the slots that the move activates."""
        return frozenset(slot for slots, active in self.sets if active for slot in slots)


@dataclass(frozen=True, slots=True)
class Net:
    """The nodes of one robot that can be reached; the first is where it begins, `stop` where it ends."""

    robot: str
    nodes: tuple[NetNode, ...]
    stop: int | None

    @property
    def chooses(self) -> bool:
        """Return whether some node leads several branches."""
        return any(len(node.branches) > 1 for node in self.nodes)


@dataclass(frozen=True, slots=True)
class Network:
    """The nets of all robots.

    Attributes:
        awaited: slots that some transition waits for: no others matter.
        volatile: slots among them that are ever made inactive.
        givers: where each slot is activated: pairs of a net's number and a node's.
    """

    nets: tuple[Net, ...]
    awaited: frozenset[SlotId]
    volatile: frozenset[SlotId]
    givers: Mapping[SlotId, tuple[tuple[int, int], ...]]


def network_of(program: Program) -> Network:
    """Return the network of a behaviour; linear in its moves, actions and transitions."""
    reached = {robot.id: reachable_moves(robot) for robot in program.robots}
    awaited = frozenset(
        (robot.id, slot)
        for robot in program.robots
        for move in reached[robot.id]
        if move in robot.transitions
        for slot in robot.transitions[move].waits
    )
    nets = tuple(
        _net(robot, executable, reached[robot.id], awaited)
        for robot, executable in zip(program.robots, program.executable.robots, strict=True)
    )
    volatile = frozenset(
        slot
        for net in nets
        for node in net.nodes
        for slots, active in node.sets
        if not active
        for slot in slots
    )
    givers: dict[SlotId, list[tuple[int, int]]] = defaultdict(list)
    for i, net in enumerate(nets):
        for j, node in enumerate(net.nodes):
            for slot in node.gives:
                givers[slot].append((i, j))
    return Network(nets, awaited, volatile, {slot: tuple(where) for slot, where in givers.items()})


def groups_of(network: Network) -> tuple[Network, ...]:
    """Return a network for each group of robots that share slots, in order; lone robots are in none.

    Robots share a slot if one waits for it that the other sets, to whatever value.
    """
    number = {net.robot: index for index, net in enumerate(network.nets)}
    neighbours: list[set[int]] = [set() for _ in network.nets]
    for index, net in enumerate(network.nets):
        for owner in {number[slot[0]] for node in net.nodes for slots, _ in node.sets for slot in slots}:
            neighbours[index].add(owner)
            neighbours[owner].add(index)
    graph = tuple(tuple(sorted(each)) for each in neighbours)
    waiting = {number[robot] for robot, _ in network.awaited}
    found = []
    while waiting:
        group = reachable(graph, [min(waiting)])
        waiting -= group
        found.append(_part(network, sorted(group)))
    return tuple(found)


def _part(network: Network, group: Sequence[int]) -> Network:
    renumbered = {old: new for new, old in enumerate(group)}
    robots = {network.nets[old].robot for old in group}
    return Network(
        tuple(network.nets[old] for old in group),
        frozenset(slot for slot in network.awaited if slot[0] in robots),
        frozenset(slot for slot in network.volatile if slot[0] in robots),
        {
            slot: tuple((renumbered[net], node) for net, node in where)
            for slot, where in network.givers.items()
            if slot[0] in robots
        },
    )


def _net(
    robot: RobotProgram, executable: ExecutableRobot, reached: frozenset[int], awaited: frozenset[SlotId]
) -> Net:
    numbers = {move.id: index for index, move in enumerate(executable.moves)}
    full = {move: _node(executable, move, numbers, awaited) for move in reached}
    kept = [move for move in sorted(reached) if move == robot.stop or _matters(full[move])]
    kept_moves = frozenset(kept)
    first = _next_kept(robot.start, full, kept_moves)
    order = [first, *(move for move in kept if move != first)]
    number = {move: index for index, move in enumerate(order)}
    nodes: list[NetNode] = []
    for move in order:
        node = full[move]
        nexts = {_next_kept(head, full, kept_moves): head for head in reversed(node.branches)}
        for branch in nexts:
            if branch not in number:
                number[branch] = len(order)
                order.append(branch)
        branches = tuple(number[branch] for branch in nexts)
        nodes.append(NetNode(move, node.sets, node.waits, branches, tuple(nexts.values())))
    return Net(robot.id, tuple(nodes), number.get(robot.stop))


def _node(
    robot: ExecutableRobot, index: int, numbers: Mapping[str, int], awaited: frozenset[SlotId]
) -> NetNode:
    """Return a move as the step rules lead through it."""
    point = entry(robot, robot.moves[index].id)
    sets: list[tuple[frozenset[SlotId], bool]] = []
    while point.phase is not Phase.OUT and not point.is_final:
        (step,) = steps(robot, point, frozenset())
        if group := awaited.intersection(step.sets):
            sets.append((group, step.active))
        point = step.leads_to
    waits = frozenset(awaited_at(robot, point))
    branches = (numbers[step.leads_to.move] for step in steps(robot, point, waits))
    return NetNode(index, tuple(sets), waits, tuple(dict.fromkeys(branches)))


def _matters(node: NetNode) -> bool:
    return bool(node.sets or node.waits or len(node.branches) != 1)


def _next_kept(move: int, full: Mapping[int, NetNode], kept: frozenset[int]) -> int:
    """Return the first move from here on that matters; one of the loop itself where none ever does."""
    passed: set[int] = set()
    while move not in kept and move not in passed:
        passed.add(move)
        move = full[move].branches[0]
    return move
