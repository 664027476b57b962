"""The tasks of the mission that a behaviour was planned from, for the map of its flight."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.registry import Contributions
from mmrs_core.diagnostics import has_errors
from mmrs_core.errors import MmrsError
from mmrs_core.languages.modelset import model_in
from mmrs_core.pictures.preview.features import task_pictures
from mmrs_core.pictures.preview.picture import Picture
from mmrs_core.pictures.report.values import Report, Status
from mmrs_core.pipeline import check_models, ground, read_models
from mmrs_core.scene import Scene


def with_tasks(
    picture: Picture, report: Report, program: Program, contributions: Contributions, folder: Path
) -> Picture:
    """Return the picture with the tasks of the mission beside the behaviour, when they were done.

    A mission that cannot be read, is not valid, lies in another frame, or has none of these tasks
    changes nothing.
    """
    scene = _scene_in(folder, contributions)
    named = {task.name for task in report.tasks}
    if scene is None or scene.frame != program.frame or not named <= {task.name for task in scene.tasks}:
        return picture
    begins = {task.name: task.flown[0] for task in report.tasks if task.flown is not None}
    ends = {t.name: t.flown[1] for t in report.tasks if t.flown is not None and t.flown[1] is not None}
    partly = {task.name: task.part for task in report.tasks if task.status is Status.PART}
    ends |= {name: _last(picture, name) for name in partly if name in begins}
    tasks = task_pictures(scene, begins, ends, contributions.map_symbols)
    return replace(picture, tasks=tuple(replace(each, part=partly.get(each.name, 1.0)) for each in tasks))


def _last(picture: Picture, task: str) -> float:
    """Return when a robot worked last on a task."""
    bars = (bar for robot in picture.robots for bar in robot.bars if bar.task == task and bar.kind == "work")
    return max((bar.end for bar in bars), default=picture.makespan)


def _scene_in(folder: Path, contributions: Contributions) -> Scene | None:
    try:
        file = model_in(folder, "mission")
        if file is None or not file.is_file():
            return None
        models, faults = read_models(file, contributions)
        if models is None or has_errors((*faults, *check_models(models, contributions))):
            return None
        return ground(models)
    except MmrsError:  # the report is of the behaviour: it needs no mission
        return None
