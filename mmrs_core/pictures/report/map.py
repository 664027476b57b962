"""The picture of a flight with the tasks of the mission that its behaviour was planned from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from mmrs_core.behaviour.as_scene import carries_out
from mmrs_core.contributions.registry import Contributions
from mmrs_core.diagnostics import has_errors
from mmrs_core.errors import MmrsError
from mmrs_core.languages.modelset import model_in
from mmrs_core.pictures.preview.features import task_pictures
from mmrs_core.pictures.preview.from_flight import picture_of_flight
from mmrs_core.pictures.preview.picture import MapGap, Picture
from mmrs_core.pictures.report.assembly import Given
from mmrs_core.pictures.report.contents import Report, TaskStatus
from mmrs_core.pipeline import check_models, ground, read_models
from mmrs_core.scene import Scene


def flight_picture(given: Given, report: Report, contributions: Contributions, folder: Path) -> Picture:
    """Return the picture of a flight, with the tasks of the mission in a folder and when they were done.

    A mission that cannot be read, is not valid, lies in another frame, or does not have these tasks
    adds no tasks, which is one of the picture's gaps.
    """
    picture = picture_of_flight(given.program, given.flight, given.planned, contributions, given.place)
    scene = _scene_in(folder, contributions, given)
    if not isinstance(scene, Scene):
        return replace(picture, gaps=(*picture.gaps, MapGap("tasks", scene))) if scene else picture
    begins = {task.name: task.flown[0] for task in report.tasks if task.flown is not None}
    ends = {t.name: t.flown[1] for t in report.tasks if t.flown is not None and t.flown[1] is not None}
    partly = {task.name: task.part for task in report.tasks if task.status is TaskStatus.PART}
    ends |= {name: _last(picture, name) for name in partly if name in begins}
    tasks = task_pictures(scene, begins, ends, contributions.map_symbols)
    return replace(picture, tasks=tuple(replace(each, part=partly.get(each.name, 1.0)) for each in tasks))


def _last(picture: Picture, task: str) -> float:
    """Return when a robot worked last on a task."""
    bars = (bar for robot in picture.robots for bar in robot.bars if bar.task == task and bar.kind == "work")
    return max((bar.end for bar in bars), default=picture.makespan)


def _scene_in(folder: Path, contributions: Contributions, given: Given) -> Scene | str:
    """Return the mission in a folder, or why its tasks cannot be drawn; empty where there is none."""
    try:
        file = model_in(folder, "mission")
        if file is None or not file.is_file():
            return ""
        models, faults = read_models(file, contributions)
        if models is None or has_errors((*faults, *check_models(models, contributions))):
            return f"{file.name} is not valid"
        scene = ground(models)
    except MmrsError:  # the report is of the behaviour: it needs no mission
        return "the mission beside the behaviour cannot be read"
    return scene if carries_out(given.program, scene) else f"{file.name} is of another behaviour"
