"""Makes legs and bars of a robot's planned steps, with every way of its choices."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.preview.footprints import along, footprints
from mmrs_core.pictures.preview.picture import Arm, Bar, Leg
from mmrs_core.scene import (
    Await,
    Branch,
    Launch,
    Recharge,
    Recover,
    Scene,
    Serve,
    Step,
    Transit,
)

_KINDS: dict[type[Step], str] = {
    Launch: "launch",
    Recover: "recover",
    Transit: "transit",
    Serve: "work",
    Recharge: "recharge",
}


def legs_of(scene: Scene, robot: str, steps: Iterable[Step], *, aside: bool = False) -> Iterator[Leg]:
    """Yield where a robot travels and works, those of all ways of a choice one after the other.

    Args:
        scene: expanded.
        robot: whose steps these are.
        steps: in order.
        aside: whether all of it is on a way that is not the longest of a choice.
    """
    for step in steps:
        match step:
            case Launch(at=at, up=up):
                points = (at, (at[0], at[1], up))
                yield Leg("launch", points, step.begin, step.end, step.task, aside=aside)
            case Transit(route=route):
                yield Leg("transit", route, step.begin, step.end, step.task, aside=aside)
            case Serve():
                yield replace(_work_leg(scene, robot, step), aside=aside)
            case Recover(at=at, up=up):
                points = (at, (at[0], at[1], up))
                yield Leg("recover", points, step.begin, step.end, step.task, aside=aside)
            case Branch(arms=arms):
                longest = _longest(step)
                for index, (condition, arm) in enumerate(arms):
                    legs = legs_of(scene, robot, arm, aside=aside or index != longest)
                    yield from (_under(leg, condition) for leg in legs)


def _work_leg(scene: Scene, robot: str, step: Serve) -> Leg:
    stroke = step.stroke
    work = scene.works.get((step.task, robot))
    coverage = work.coverage if work else None
    hold = f"holds for {clock(stroke.hold)}" if stroke.hold > 0 else ""
    actions = f"{len(stroke.actions)} actions" if len(stroke.actions) > 1 else ""
    only = stroke.actions[0].action if len(stroke.actions) == 1 else ""
    return Leg(
        "work",
        stroke.points,
        step.begin,
        step.end,
        step.task,
        covered=tuple(footprints(stroke, coverage)) if coverage else (),
        actions=tuple(along(stroke.points, action.at)[0] for action in stroke.actions),
        note=", ".join(filter(None, (actions, only, hold, stroke.object or ""))),
    )


def _under(leg: Leg, condition: str | None) -> Leg:
    return replace(leg, note=", ".join(filter(None, (_when(condition), leg.note))))


def bars_of(steps: Iterable[Step]) -> Iterator[Bar]:
    """Yield what a robot spends its time on; a choice is one bar, whatever its ways are made of."""
    for step in steps:
        match step:
            case Launch() | Recover() | Transit() | Serve() | Recharge():
                yield Bar(_KINDS[type(step)], step.begin, step.end, step.task)
            case Await(until=until):
                note = f"not before {clock(until)}" if until is not None else ""
                yield Bar("wait", step.begin, step.end, step.task, note)
            case Branch(arms=arms):
                ways = ", ".join(_when(condition) for condition, _ in arms)
                yield Bar("choice", step.begin, step.end, step.task, ways)


def arms_of(steps: Iterable[Step], level: int = 0) -> Iterator[Arm]:
    """Yield the ways of every choice, those of inner choices after the way that they are on."""
    for step in steps:
        if not isinstance(step, Branch):
            continue
        longest = _longest(step)
        for index, (condition, arm) in enumerate(step.arms):
            end = arm[-1].end if arm else step.begin
            yield Arm(_when(condition), step.begin, end, tuple(bars_of(arm)), level, index == longest)
            yield from arms_of(arm, level + 1)


def _when(condition: str | None) -> str:
    return "otherwise" if condition is None else f"if {condition}"


def _longest(branch: Branch) -> int:
    ends = [arm[-1].end if arm else branch.begin for _, arm in branch.arms]
    return ends.index(max(ends))


def flat(steps: Iterable[Step]) -> Iterator[Step]:
    """Yield steps and all that are inside of choices, in order."""
    for step in steps:
        yield step
        if isinstance(step, Branch):
            for _, arm in step.arms:
                yield from flat(arm)
