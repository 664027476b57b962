"""What plans for vehicles of others cannot express alike."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mmrs_core.behaviour.program import Move, MoveTarget, RobotProgram
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.plan_moves import DEEPEST, FASTEST, MOVES, SLOWEST, above_surface
from mmrs_core.scene import Policy


@dataclass(frozen=True, slots=True)
class Wording:
    """Why a form of plans refuses what it does, as the end of sentences.

    Attributes:
        turn: of turns on the spot. heading: of headings on the way. object: of objects that are sought.
        policy: who alone can answer what goes wrong.
    """

    turn: str
    heading: str
    object: str
    policy: str


def of_policies(robot: RobotProgram, context: RobotContext, wording: Wording) -> Iterator[str]:
    """Yield the policies of a robot and of its type."""
    of_type = context.type.policies if context.type is not None else ()
    for policy in dict.fromkeys((*robot.policies, *of_type)):
        yield f"robot '{robot.id}': {of_policy(policy, wording)}"


def of_policy(policy: Policy, wording: Wording) -> str:
    """Return why a policy is refused."""
    return f"{policy_words(policy)}, which only {wording.policy} can do"


def policy_words(policy: Policy) -> str:
    """Return a policy in words."""
    after = "" if policy.after is None else f" after {policy.after:g} s"
    return f"policy {policy.event}{after}: {policy.response}"


def of_movement(move: Move, context: RobotContext, wording: Wording) -> Iterator[str]:
    """Yield why a movement is refused, whatever is done before and after it."""
    known = MOVES.get(move.metaclasses[0])
    if known is None:
        yield f"{move.kind} is not known to this target"
    if known == "go":
        yield from _of_speed(context.speed(move))
    if known == "turn":
        yield f"turns on the spot, {wording.turn}"
    elif move.heading is not None:
        yield f"heading on the way, {wording.heading}"
    if move.target is not None:
        yield from _of_target(move.target, context, wording)


def _of_speed(speed: float | None) -> Iterator[str]:
    if speed is None:
        yield "its speed is not known, because its robot type is not given"
    elif not SLOWEST <= speed <= FASTEST:
        yield f"its speed of {speed:g} m/s is not from {SLOWEST:g} to {FASTEST:g}"


def _of_target(target: MoveTarget, context: RobotContext, wording: Wording) -> Iterator[str]:
    if target.description is not None:
        yield f"object '{target.description}', {wording.object}"
    if target.position is not None and not context.flies:
        above = above_surface(target.position, context)
        if above > 1e-6:
            yield f"leads {above:g} m above the surface"
        elif -above > DEEPEST:
            yield f"leads {-above:g} m below the surface, and no sea is deeper than {DEEPEST:,g} m"
