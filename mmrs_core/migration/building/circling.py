"""Circular moves as way points around their centre."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import container_of, metaclass_of, root_of
from mmrs_core.languages.grounding.values import number
from mmrs_core.languages.registry import Registry
from mmrs_core.migration.building.converting import number_in
from mmrs_core.migration.building.drafts import Draft
from mmrs_core.migration.building.headings import towards
from mmrs_core.migration.findings import Category
from mmrs_core.migration.recording import Record
from mmrs_core.migration.rules.mapping import Ring, Rule
from mmrs_core.migration.sources.nodes import SourceNode


def draw_ring(node: SourceNode, rule: Rule, draft: Draft, registry: Registry, record: Record) -> None:
    """Let the move that a node became go round its centre once, over way points that further moves lead to.

    The move's target is the centre before, and the first way point, north of the centre, afterwards.
    """
    ring, first = rule.ring, draft.made[node]
    assert ring is not None  # asked before
    robot, centre = container_of(first), getattr(first, "target", None)
    if not (isinstance(first, bl.GoTo) and isinstance(robot, bl.Robot) and isinstance(centre, bl.Coordinate)):
        record.element(Category.LOST, "no centre to go round is known", node)
        return
    try:
        offsets = _offsets(node, ring, number(centre, "altitude") or 0.0)
    except ValueError as fault:
        record.element(Category.DOUBTFUL, f"{fault}, so the robot only goes to the centre", node)
        return
    moves = [first, *(_further(first, index, registry) for index in range(2, len(offsets) + 1))]
    at = robot.moves.index(first) + 1
    robot.moves[at:at] = moves[1:]
    for move, (x, y, z) in zip(moves, offsets, strict=True):
        move.target = bl.RelativeCoordinate(x=x, y=y, z=z, reference=centre)
        _behaviour(robot).targets.append(move.target)
    _join(robot, moves)
    moves[-1].postActions.extend(list(first.postActions))


def _join(robot: bl.Robot, moves: Sequence[bl.GoTo]) -> None:
    """Lead from each way point to the next, and from the last where the first led before."""
    onward = [each for each in robot.moveTransitions if each.from_ is moves[0]]
    for transition in onward:
        transition.from_ = moves[-1]
    at = robot.moveTransitions.index(onward[0]) if onward else len(robot.moveTransitions)
    between = [bl.MoveTransition(from_=one, to=other, fluid=True) for one, other in pairwise(moves)]
    robot.moveTransitions[at:at] = between


def _offsets(node: SourceNode, ring: Ring, altitude: float) -> list[tuple[float, float, float]]:
    """Return metres east, north and up of the centre, around and back to the first.

    Raises:
        ValueError: if the radius or height is no number, or the radius not above 0.
    """
    radius = number_in(node.text(ring.radius) or "0")
    if radius <= 0:
        raise ValueError(f"{ring.radius} is {radius:g} m")
    up = number_in(node.text(ring.height)) - altitude if node.text(ring.height) else 0.0
    turn = 360 / ring.points * (1 if node.text(ring.clockwise).lower() == "true" else -1)
    around = [(index % ring.points) * turn for index in range(ring.points + 1)]
    return [(*towards(angle, radius), round(up, 3)) for angle in around]


def _further(first: bl.GoTo, index: int, registry: Registry) -> bl.GoTo:
    name = f"{first.name}_{index}" if first.name else None
    made = registry.create(*metaclass_of(first).key, name=name)
    assert isinstance(made, bl.GoTo)  # as the first is
    return made


def _behaviour(robot: bl.Robot) -> bl.Behaviour:
    behaviour = root_of(robot)
    assert isinstance(behaviour, bl.Behaviour)  # robots stand in nothing else
    return behaviour
