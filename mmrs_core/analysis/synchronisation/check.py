"""The verdict on synchronisation, with who waits for whom."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import pairwise

from mmrs_core.analysis.synchronisation.exploration import find_stuck
from mmrs_core.analysis.synchronisation.fixpoint import Fixpoint, may_fixpoint, must_fixpoint
from mmrs_core.analysis.synchronisation.network import NetNode, Network, groups_of, network_of
from mmrs_core.analysis.synchronisation.search import LIMIT, LimitExceededError, Stuck, Trap, find_trap
from mmrs_core.behaviour.program import Program, SlotId
from mmrs_core.behaviour.walk import moves_reaching_stop, reachable_moves
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict

NAME = "synchronisation"
MOST_NAMES = 8
"""How many robots of a group a message names."""


def verdicts_of(input: CheckInput, *, limit: int = LIMIT) -> Iterator[Verdict]:
    """Yield each robot that may wait forever, or that none does.

    Args:
        input: of the check.
        limit: how many steps a search through the outcomes of Choices may make.
    """
    network = network_of(input.program)
    if not network.awaited:
        yield Verdict(NAME, Status.SAFE, message="no robot waits for another")
        return
    groups = groups_of(network)
    for group in groups:
        yield from _of_group(input.program, group, limit, "" if len(groups) == 1 else _names(group))


def _names(group: Network) -> str:
    names = [net.robot for net in group.nets]
    shown = names if len(names) <= MOST_NAMES else [*names[:MOST_NAMES], f"{len(names) - MOST_NAMES} more"]
    return f"{', '.join(shown)}: "


def _of_group(program: Program, network: Network, limit: int, names: str) -> Iterator[Verdict]:
    orphaned = [
        verdict
        for slot in sorted(network.awaited - network.givers.keys())
        for verdict in _orphaned(program, network, slot)
    ]
    yield from orphaned
    named = {(verdict.robot, verdict.move) for verdict in orphaned}
    decided = _with_resets(program, network) if network.volatile else _monotone(program, network, limit)
    for verdict in decided:
        if verdict.status is not Status.VIOLATED:
            verdict = replace(verdict, message=names + verdict.message)
        if not orphaned or (verdict.status is Status.VIOLATED and (verdict.robot, verdict.move) not in named):
            yield verdict


def _orphaned(program: Program, network: Network, slot: SlotId) -> Iterator[Verdict]:
    """Yield that no robot activates a slot, once for each wait for it."""
    for net in network.nets:
        for node in net.nodes:
            if slot in node.waits:
                words = f"waits after {_move(program, net.robot, node.move)} for '{slot[1]}'"
                yield _violated(program, net.robot, node.move, f"{words}, which no robot activates")


def _monotone(program: Program, network: Network, limit: int) -> Iterator[Verdict]:
    fixpoint = must_fixpoint(network)
    if not fixpoint.blocked:
        yield _free(program, network, "whatever Choices decide")
        return
    if not any(net.chooses for net in network.nets):
        yield from _certainly_stuck(program, network, fixpoint)
        return
    endless = _endless(program, network)
    if endless:
        yield _undecided(f"no path leads {endless} to Stop")
        return
    try:
        trap = find_trap(network, fixpoint.active, limit=limit)
    except LimitExceededError:
        reason = "the Choices that robots make have more outcomes than were looked at"
        yield from _cut_short(program, network, reason)
        return
    if trap is None:
        yield _free(program, network, "whatever Choices decide")
    else:
        yield from _trapped(program, network, trap)


def _certainly_stuck(
    program: Program, network: Network, fixpoint: Fixpoint, condition: str = ""
) -> Iterator[Verdict]:
    stuck = [
        Stuck(number, node, network.nets[number].nodes[node].waits - fixpoint.active)
        for number, nodes in fixpoint.blocked.items()
        for node in nodes
    ]
    yield from _stuck_verdicts(program, network, stuck, condition)


def _cut_short(program: Program, network: Network, reason: str) -> Iterator[Verdict]:
    """Yield each robot that waits forever in every run, and that the others are undecided."""
    yield from _certainly_stuck(program, network, may_fixpoint(network), " at the latest")
    yield _undecided(reason)


def _trapped(program: Program, network: Network, trap: Trap) -> Iterator[Verdict]:
    choices = [
        f"{net.robot} continues with {_move(program, net.robot, _head(net.nodes[before], after))}"
        f" after {_move(program, net.robot, net.nodes[before].move)}"
        for net, path in zip(network.nets, trap.paths, strict=True)
        for before, after in pairwise(path)
        if len(net.nodes[before].branches) > 1
    ]
    yield from _stuck_verdicts(program, network, trap.stuck, f" if {', '.join(choices)}" if choices else "")


def _head(node: NetNode, branch: int) -> int:
    return node.heads[node.branches.index(branch)]


def _with_resets(program: Program, network: Network) -> Iterator[Verdict]:
    try:
        stuck = find_stuck(network)
    except LimitExceededError:
        reason = "slots become inactive again, in more orders of events than were looked at"
        yield from _cut_short(program, network, reason)
        return
    if stuck is None:
        yield _free(program, network, "in any order of events")
    else:
        yield from _stuck_verdicts(program, network, stuck, " in some order of events")


def _stuck_verdicts(
    program: Program, network: Network, stuck: Iterable[Stuck], condition: str
) -> Iterator[Verdict]:
    found = tuple(stuck)
    waiting = {each.net for each in found}
    for each in found:
        net = network.nets[each.net]
        move = net.nodes[each.node].move
        reasons = "; ".join(_reason(program, network, slot, waiting) for slot in sorted(each.missing))
        words = f"waits forever after {_move(program, net.robot, move)}{condition}: {reasons}"
        yield _violated(program, net.robot, move, words)


def _reason(program: Program, network: Network, slot: SlotId, waiting: set[int]) -> str:
    """Return why a slot is not activated: who would, and whether that robot waits itself."""
    givers = [
        f"{network.nets[net].robot} on "
        f"{_move(program, network.nets[net].robot, network.nets[net].nodes[node].move)}"
        f"{', which itself waits forever' if net in waiting else ''}"
        for net, node in network.givers.get(slot, ())
    ]
    return (
        f"'{slot[1]}' would be activated by {' or '.join(givers)}" if givers else f"'{slot[1]}' by no robot"
    )


def _move(program: Program, robot: str, index: int) -> str:
    move = program.robot(robot).moves[index]
    return f"{move.kind} '{move.id}'"


def _violated(program: Program, robot: str, index: int, words: str) -> Verdict:
    move = program.robot(robot).moves[index]
    return Verdict(NAME, Status.VIOLATED, robot, move=move.id, message=f"{robot}: {words}", place=move.place)


def _endless(program: Program, network: Network) -> str:
    """Return the first move that is made and cannot lead to Stop, with its robot; empty if there is none."""
    for robot in (program.robot(net.robot) for net in network.nets):
        lost = reachable_moves(robot) - moves_reaching_stop(robot)
        if lost:
            return f"from {_move(program, robot.id, min(lost))} of {robot.id}"
    return ""


def _free(program: Program, network: Network, scope: str) -> Verdict:
    endless = _endless(program, network)
    if endless:
        return _undecided(f"no path leads {endless} to Stop")
    words = f"every robot comes to its Stop {scope}; slots awaited: {len(network.awaited)}"
    return Verdict(NAME, Status.SAFE, message=words)


def _undecided(reason: str) -> Verdict:
    return Verdict(NAME, Status.UNKNOWN, message=f"undecided whether robots wait forever: {reason}")


SYNCHRONISATION = Check(
    name=NAME,
    title="Every awaited slot is activated, and no run leaves a robot waiting forever.",
    run=verdicts_of,
    hint="let some robot notify the slot on every path it may take, or remove the wait",
)
