"""A small scene with its plan: two drones, one field, one road, a tower and a forbidden area."""

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.scene import (
    ActionAt,
    Area,
    AreaUse,
    Await,
    Battery,
    Capability,
    Coverage,
    Frame,
    Kinematics,
    Launch,
    Part,
    Plan,
    Recover,
    Robot,
    RobotPlan,
    RobotType,
    Scene,
    Serve,
    Signal,
    Stroke,
    Task,
    Transit,
    Work,
)

SHELL = ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (100.0, 60.0, 0.0), (0.0, 60.0, 0.0))
SWATH = Stroke(((10.0, 5.0, 20.0), (10.0, 55.0, 20.0)), (ActionAt(0.0, "Sample"), ActionAt(25.0, "Sample")))
ROAD = Stroke(((120.0, 0.0, 15.0), (160.0, 60.0, 15.0)))
GRID = MapSymbol(("urn:mmrs:survey:1.0", "PhotoGridTask"), "photo grid", "#c2571a", "G", ("altitude",))
SYMBOLS = {GRID.metaclass: GRID}
HOMES = {"Alba": (-20.0, 0.0, 0.0), "Brezza": (-20.0, 10.0, 0.0)}


def scene_named(names: dict[str, str]) -> Scene:
    field, road = names.get("field", "field"), names.get("road", "road")
    part = Part((("urn:mmrs:multicopter:1.0", "Drone"), ("urn:mmrs:robot:1.0", "Robot")), {})
    kind = RobotType(
        "quad",
        part.metaclasses,
        (),
        0.6,
        1.0,
        (Capability(1.0, 1800.0, (0.0, 15.0)),),
        (Battery(5e5, None),),
        {},
        part,
    )
    kinematics = Kinematics(10.0, 0.0, 15.0, 3.0, 2.0, floor=1.0, ceiling=120.0, launches=True)
    robots = tuple(
        Robot(names.get(name, name), kind, home, True, 0.0, "NORMAL", 0.8, "drone", kinematics)
        for name, home in HOMES.items()
    )
    coverage = Coverage(tuple(p[:2] for p in SHELL), (), (), 20.0, 12.0)
    return Scene(
        name=names.get("mission", "two drones"),
        frame=Frame("EPSG:4326", 42.37, 13.35),
        tasks=(
            _task(field, "PhotoGridTask", shell=SHELL),
            _task("fork", "Fork"),
            _task(road, "RoadTask", points=ROAD.points),
        ),
        dependencies=(),
        robots=robots,
        areas=(
            Area(
                names.get("tower", "tower"),
                AreaUse.OBSTACLE,
                ((60, 20), (70, 20), (70, 30), (60, 30)),
                0,
                35,
                4,
            ),
            Area("school", AreaUse.FORBIDDEN, ((120, 30), (135, 30), (135, 45)), safety_distance=5),
            Area(
                "meadow", AreaUse.EMERGENCY, ((-60, 20), (-40, 20), (-40, 50), (-60, 50)), safety_distance=2
            ),
        ),
        works={(field, names.get("Alba", "Alba")): Work((SWATH,), True, "grid", coverage=coverage)},
    )


def _task(name: str, kind: str, **attributes) -> Task:
    return Task(name, Part((("urn:mmrs:survey:1.0", kind),), attributes))


def plan_named(names: dict[str, str]) -> Plan:
    field, road = names.get("field", "field"), names.get("road", "road")
    alba, brezza = names.get("Alba", "Alba"), names.get("Brezza", "Brezza")
    first = (
        Launch(0.0, 7.0, field, HOMES["Alba"], 20.0),
        Transit(7.0, 11.0, field, ((-20.0, 0.0, 20.0), SWATH.points[0])),
        Serve(11.0, 31.0, field, SWATH, 5.0, "grid", True, True),
        Signal(31.0, 31.0, field, "done", (brezza,)),
        Transit(31.0, 40.0, "", (SWATH.points[-1], (-20.0, 0.0, 20.0))),
        Recover(40.0, 50.0, "", (-20.0, 0.0, 20.0), 0.0),
    )
    second = (
        Launch(0.0, 5.0, road, HOMES["Brezza"], 15.0),
        Transit(5.0, 20.0, road, ((-20.0, 10.0, 15.0), ROAD.points[0])),
        Await(20.0, 31.0, road, ("done",)),
        Serve(31.0, 45.0, road, ROAD, 5.0, "road", True, True),
        Transit(45.0, 65.0, "", (ROAD.points[-1], (-20.0, 10.0, 15.0))),
        Recover(65.0, 72.5, "", (-20.0, 10.0, 15.0), 0.0),
    )
    return Plan(
        (RobotPlan(alba, first, 170.0, 50.0, 36000.0, 1), RobotPlan(brezza, second, 470.0, 72.5, None, 1)),
        72.5,
        {field: 11.0, "fork": 31.0, road: 31.0},
        {field: 31.0, "fork": 31.0, road: 45.0},
        ("terrain is taken as flat",),
    )
