"""What a plan leaves out of its tasks, since robots must keep away from there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_core.scene import Branch, LeftOut, Scene, Serve, Step, Work

_LEAST = 0.05
"""Square metres, or metres, under which what is left out is rounding."""


def left_out(scene: Scene, steps: Mapping[str, tuple[Step, ...]]) -> tuple[LeftOut, ...]:
    """Return what robots that go these steps leave out of the tasks that they do."""
    served = {(task, robot) for robot, taken in steps.items() for task in _served(taken)}
    found = (
        each
        for task in scene.tasks
        for robot in scene.robots
        if (task.name, robot.name) in served
        for each in _of(task.name, scene.works[(task.name, robot.name)])
    )
    return tuple(dict.fromkeys(found))


def _served(steps: tuple[Step, ...]) -> Iterator[str]:
    for step in steps:
        if isinstance(step, Serve):
            yield step.task
        elif isinstance(step, Branch):
            for _, arm in step.arms:
                yield from _served(arm)


def _of(task: str, work: Work) -> Iterator[LeftOut]:
    for gap in work.gaps:
        if gap.length > _LEAST:
            east, north, _ = gap.at
            place = f"from {gap.begin:.1f} m along {gap.line}, about ({east:.1f}, {north:.1f})"
            yield LeftOut(task, gap.length, "m", f"{place}, too near to {gap.area}", gap.at)
    if work.coverage is not None and work.coverage.unreachable > _LEAST:
        yield LeftOut(
            task, work.coverage.unreachable, "m²", "of its area, too near to what is kept away from"
        )
