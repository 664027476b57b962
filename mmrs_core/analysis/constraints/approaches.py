"""Moves that end at a distance from their target, begun nearer to it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import dist

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, finding
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number
from mmrs_core.languages.element import Element, Unknown, is_kind, metaclass_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position

EXACT = 1e-6
"""Metres."""


@dataclass(frozen=True, slots=True)
class _Around:
    """Where something is: within `radius` metres of a position."""

    position: Position
    radius: float


_Before = Mapping[Element, Sequence[Element]]


def _nearer_already(robot: Element, models: ModelSet) -> Iterator[Finding]:
    before = _before(robot)
    for move in children(robot, "moves"):
        distance, target = number(move, "distance") or 0.0, _target(move, models)
        if distance <= 0.0 or target is None or not is_kind(move, BEHAVIOUR, "GoTo"):
            continue
        starts = [_end(each, before, robot, models) for each in before.get(move, ())]
        farthest = [
            dist(each.position, target.position) + each.radius + target.radius for each in starts if each
        ]
        if farthest and min(farthest) < distance - EXACT:
            yield finding(
                move,
                f"is to end {distance:g} m from its target, but begins at most {min(farthest):.4g} m from it",
            )


def _before(robot: Element) -> _Before:
    before: dict[Element, list[Element]] = {}
    for transition in children(robot, "moveTransitions"):
        origin = child(transition, "from")
        for move in (child(transition, "to"), child(transition, "falseBranch")):
            if move is not None and origin is not None:
                before.setdefault(move, []).append(origin)
    return before


def _target(move: Element, models: ModelSet) -> _Around | None:
    target = child(move, "target")
    expected = child(target, "expectedAt") if target is not None else None
    place = expected if expected is not None else target
    position = sketch_of(models).program_ground.positions.get(place) if place is not None else None
    tolerance = number(target, "tolerance") if target is not None else 0.0
    if position is None or (expected is not None and tolerance is None):
        return None
    return _Around(position, (tolerance or 0.0) if expected is not None else 0.0)


def _end(move: Element, before: _Before, robot: Element, models: ModelSet) -> _Around | None:
    """Return where a robot is when a move has ended; None where that is not known."""
    seen: set[Element] = set()
    while move not in seen:
        seen.add(move)
        if is_kind(move, BEHAVIOUR, "Start"):
            return _home(robot, models)
        if is_kind(move, BEHAVIOUR, "GoTo"):
            target = _target(move, models)
            kept = number(move, "distance") or 0.0
            return _Around(target.position, target.radius + kept) if target is not None else None
        if isinstance(move, Unknown) or metaclass_of(move).ns_uri != BEHAVIOUR:
            return None  # a plug-in's move may lead anywhere
        if len(before.get(move, ())) != 1:
            return None  # several ways lead here from several places
        (move,) = before[move]
    return None


def _home(robot: Element, models: ModelSet) -> _Around | None:
    home = child(robot, "home")
    position = sketch_of(models).program_ground.positions.get(home) if home is not None else None
    return _Around(position, 0.0) if position is not None else None


CONSTRAINTS = (
    Constraint(
        "BL052",
        "A move that ends at a distance from its target begins no nearer to it.",
        (BEHAVIOUR, "Robot"),
        _nearer_already,
        "make the distance smaller, or lead the robot away from the target first",
        Severity.WARNING,
    ),
)
