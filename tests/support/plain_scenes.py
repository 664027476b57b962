"""Small expanded scenes made by hand, without models or plug-ins."""

from dataclasses import replace
from math import inf

from mmrs_core.planning.coverage import Sweep, work_over
from mmrs_core.scene import (
    ActionAt,
    Area,
    AreaUse,
    Capability,
    Dependency,
    Device,
    DeviceAction,
    Frame,
    Kinematics,
    Part,
    Robot,
    RobotType,
    Scene,
    Stroke,
    Task,
    Work,
)

MISSION = "urn:mmrs:mission:1.0"
DRONE = Kinematics(
    cruise=10.0,
    slowest=0.0,
    fastest=15.0,
    climb=3.0,
    descent=2.0,
    floor=1.0,
    ceiling=120.0,
    launch=5.0,
    recovery=5.0,
    endurance=1200.0,
    energy=240_000.0,
    power=200.0,
    recharge=300.0,
    launches=True,
)
CRAWLER = Kinematics(cruise=2.0, slowest=0.0, fastest=3.0, climb=1.0, descent=1.0, floor=0.0, ceiling=0.0)
CAMERA = Device("camera", {"photo": DeviceAction("photo", 1.0)}, {})
TYPE = RobotType(
    "quad", (), (), 0.5, None, (Capability(0.0, None, (0.0, 15.0)),), (), {"camera": CAMERA}, Part((), {})
)


def robot(name="r1", home=(0.0, 0.0, 0.0), *, kinematics=DRONE, returns=True, clearance=1.0):
    """Return a robot of an expanded scene."""
    return Robot(name, TYPE, home, returns, 0.0, "NORMAL", clearance, "kind", kinematics)


def box(name, west, south, east, north, *, low=-inf, high=inf, safety=2.0, use=AreaUse.FORBIDDEN):
    """Return a rectangular area."""
    shell = ((west, south), (east, south), (east, north), (west, north))
    return Area(name, use, shell, low, high, safety)


def visit(*points, **features):
    """Return indivisible work: go to each point in turn."""
    return Work(tuple(Stroke((point,), **features) for point in points), divisible=False, rule="visit")


def road(*points, cuts=(), **features):
    """Return work along one polyline."""
    stroke = Stroke(points, cuts=cuts, reversible=True, **features)
    return Work((stroke,), divisible=True, rule="road")


def photo(at):
    """Return a photo at an arc length."""
    return ActionAt(at, "photo")


def task(name, **features):
    """Return a task that is not a control task."""
    return Task(name, Part(((MISSION, "PointTask"), (MISSION, "Task")), {}), **features)


def control(name, kind):
    """Return a Fork or Join."""
    return Task(name, Part(((MISSION, kind), (MISSION, "ControlTask"), (MISSION, "Task")), {}))


def scene(robots, works, *, after=(), controls=(), tasks=None, areas=(), **features):
    """Return an expanded scene.

    Args:
        robots: of the team.
        works: by task: a Work for all robots, or by robot.
        after: dependencies, as (before, after) or (before, after, condition).
        controls: control tasks.
        tasks: by name, for tasks with more than a name.
        areas: of the context.
        features: of the Scene.
    """
    given = tasks or {}
    listed = [given.get(name, task(name)) for name in works]
    pairs = {}
    for name, work in works.items():
        by_robot = work if isinstance(work, dict) else {each.name: work for each in robots}
        pairs.update({(name, who): each for who, each in by_robot.items()})
    return Scene(
        "scene",
        Frame("EPSG:4326", 42.0, 13.0),
        (*listed, *controls),
        tuple(Dependency(*names) for names in after),
        tuple(robots),
        areas=tuple(areas),
        works=pairs,
        timed=features.get("minimum_separation") is not None,
        **features,
    )


def field_work(whole, shell, holes=(), *, altitude=20.0, width=20.0, length=0.0):
    """Return the work over a polygon for the first robot of a scene."""
    action = "photo" if length else None
    return work_over(
        whole,
        whole.robots[0],
        shell,
        Sweep(altitude=altitude, width=width, rule="cover", length=length, action=action),
        holes,
    )


def with_kinematics(each, **features):
    """Return a robot with other kinematics."""
    return replace(each, kinematics=replace(each.kinematics, **features))
