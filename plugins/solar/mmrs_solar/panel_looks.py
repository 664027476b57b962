"""The rule for closer looks at suspected panels."""

from __future__ import annotations

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.positions import refuse_blocked, refuse_heights, refuse_unsteady
from mmrs_core.scene import Look, Part, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import text
from mmrs_solar.camera import optics_of
from mmrs_solar.groups import group_of, whole
from mmrs_solar.names import PANEL_LOOK_TASK
from mmrs_solar.nearness import refuse_near
from mmrs_solar.recording import camera_for, distance_for, recorded
from mmrs_solar.views import before, view_of

RULE = "panel_look"


def panel_look_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return for each panel the position on its normal, or as near to it as the camera can be tilted."""
    refuse_unsteady(robot)
    part, group = task.part, group_of(task.part, scene)
    action = text(part, "actionName")
    camera = camera_for(part, robot, action)
    optics = optics_of(camera)
    view = view_of(group.azimuth, group.tilt, optics.lowest, optics.highest)
    distance = distance_for(part, camera.id, optics, view)
    strokes = []
    for row, column, tier in _suspects(part):
        panel = group.panel(row, column, tier)
        place = before(panel, view, distance)
        what = f"the position before row {row}, column {column}, tier {tier}"
        refuse_heights(robot, (place,))
        refuse_blocked(robot, scene, (place,), what)
        refuse_near(robot, group, place, what)
        done, look = (recorded(part, camera, action, 0.0),), Look(panel, camera.id)
        strokes.append(Stroke((place,), done, look, part=what))
    return Work(tuple(strokes), divisible=True, rule=RULE, ordered=False)


def _suspects(part: Part) -> tuple[tuple[int, int, int], ...]:
    """Return (row, column, tier) of each panel to look at, each once, in the order of the task."""
    listed = part.attributes.get("panels")
    found = [each for each in listed if isinstance(each, Part)] if isinstance(listed, tuple) else []
    if not found:
        raise InfeasibleError("panels are missing")
    return tuple(dict.fromkeys(address_of(each) for each in found))


def address_of(panel: Part) -> tuple[int, int, int]:
    """Return (row, column, tier) of a suspected panel; 0 where one is not given, which never is a panel."""
    row, column, tier = (whole(panel, name, 0) for name in ("row", "column", "tier"))
    return row, column, tier


PANEL_LOOK_RULE = Rule(RULE, PANEL_LOOK_TASK, panel_look_work)
