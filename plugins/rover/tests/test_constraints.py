from itertools import pairwise

import pytest
from mmrs_rover import plugin
from mmrs_rover.constraints import CONSTRAINTS
from mmrs_rover.names import ROVER, TERRAIN

from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import context as ctx
from mmrs_core.languages import mission as mml
from mmrs_core.testing.conformance import Case, ConstraintConformance
from mmrs_core.testing.models import breaches, sample_mission, sample_tasks, sample_visit

ROBOT_LANGUAGE = "urn:mmrs:robot:1.0"


def place(east, north):
    return mml.RelativeCoordinate(x=float(east), y=float(north))


def rover(registry, **features):
    measures = {"width": 0.6, "length": 0.8, "height": 0.6, "weight": 40.0}
    size = registry.create(ROBOT_LANGUAGE, "Size", **measures)
    return registry.create(
        *ROVER, **{"name": "Rover", "drive": "WHEELS", "turningRadius": 1.0, "size": size, **features}
    )


def terrain(registry, **features):
    shell = [place(0, 0), place(10, 0), place(10, 10), place(0, 10)]
    return registry.create(*TERRAIN, **{"name": "pond", "shell": shell, "waterDepth": 1.0, **features})


def place_with(*elements):
    return ctx.Context(name="field", elements=list(elements))


def mission(registry, home=(20.0, 0.0), up=0.0, kind="Rover"):
    return sample_mission(sample_visit(registry, 30.0, 0.0, up), robot_type=kind, home=(*home, 0.0))


def driving(*places, fluid=True):
    """Return a behaviour of a rover that goes from (0, 0) through places, each passed without a stop."""
    home, *targets = [
        bl.RelativeCoordinate(x=float(east), y=float(north)) for east, north in ((0, 0), *places)
    ]
    goes = [bl.GoTo(name=f"p{index}", target=target) for index, target in enumerate(targets)]
    moves = [bl.Start(name="start"), *goes, bl.Stop(name="stop")]
    flows = [
        bl.MoveTransition(from_=one, to=two, fluid=fluid and one in goes[:-1]) for one, two in pairwise(moves)
    ]
    robot = bl.Robot(id="Badger", typeName="Rover", home=home, moves=moves, moveTransitions=flows)
    return bl.Behaviour(name="drive", robots=[robot], targets=[home, *targets])


CASES = {
    "ROV001": Case(lambda r: [rover(r, turningRadius=None)], lambda r: [rover(r, turningRadius=0.0)]),
    "ROV002": Case(
        lambda r: [rover(r, drive="TRACKS")], lambda r: [rover(r, drive="TRACKS", turningRadius=0.0)]
    ),
    "ROV003": Case(lambda r: [rover(r, maxSlope=-1.0)], lambda r: [rover(r, maxSlope=0.0)]),
    "ROV004": Case(lambda r: [rover(r, maxSlope=90.0)], lambda r: [rover(r, maxSlope=89.0)]),
    "ROV005": Case(lambda r: [rover(r, wadingDepth=0.6)], lambda r: [rover(r, wadingDepth=0.59)]),
    "ROV006": Case(lambda r: [rover(r, groundClearance=0.6)], lambda r: [rover(r, groundClearance=0.3)]),
    "ROV007": Case(
        lambda r: [place_with(terrain(r, waterDepth=0.0))], lambda r: [place_with(terrain(r, waterDepth=0.1))]
    ),
    "ROV008": Case(
        lambda r: [place_with(terrain(r, slope=91.0))], lambda r: [place_with(terrain(r, slope=90.0))]
    ),
    # Half of the diagonal is 0.58 m and the radius 1 m: it must be 1.58 m from the pond's side at 10 m.
    "ROV009": Case(
        lambda r: [rover(r), mission(r, home=(11.5, 5.0)), place_with(terrain(r))],
        lambda r: [rover(r), mission(r, home=(11.6, 5.0)), place_with(terrain(r))],
    ),
    "ROV011": Case(
        lambda r: [rover(r), driving((10, 0), (10, 1.5))], lambda r: [rover(r), driving((10, 0), (10, 2))]
    ),
    "ROV010": Case(lambda r: [rover(r), mission(r, up=0.5)], lambda r: [rover(r), mission(r, up=0.0)]),
}
BY_CODE = {constraint.code: constraint for constraint in CONSTRAINTS}


class TestConstraints(ConstraintConformance):
    plugin = plugin
    more_metamodels = (sample_tasks(),)
    cases = CASES


@pytest.mark.parametrize("metaclass", [ROVER, TERRAIN], ids=lambda name: name[1])
def test_elements_with_nothing_but_defaults_break_at_most_what_asks_for_a_figure(metaclass, registry):
    empty = registry.create(*metaclass)
    codes = {each.code for each in CONSTRAINTS if breaches(each, [empty])}
    assert codes == {"Rover": {"ROV001"}, "Terrain": {"ROV007"}}[metaclass[1]]


@pytest.mark.parametrize("name", ["turningRadius", "maxSlope", "wadingDepth", "groundClearance"])
def test_no_limit_may_be_negative(name, registry):
    found = breaches(BY_CODE["ROV003"], [rover(registry, **{name: -0.1})])
    assert [message.split()[0] for message in found] == [name]


@pytest.mark.parametrize("name", ["slope", "waterDepth", "stepHeight"])
def test_nothing_that_terrain_states_may_be_negative(name, registry):
    found = breaches(BY_CODE["ROV008"], [place_with(terrain(registry, **{name: -0.1}))])
    assert [message.split()[0] for message in found] == [name]


def test_a_home_in_water_that_the_rover_wades_through_is_allowed(registry):
    models = [
        rover(registry, wadingDepth=0.5),
        mission(registry, home=(5.0, 5.0)),
        place_with(terrain(registry, waterDepth=0.5)),
    ]
    assert breaches(BY_CODE["ROV009"], models) == []


def test_a_home_on_impassable_ground_tells_all_that_is_too_much(registry):
    bog = terrain(registry, name="bog", waterDepth=0.4, stepHeight=0.3)
    models = [rover(registry, wadingDepth=0.1), mission(registry, home=(5.0, 5.0)), place_with(bog)]
    assert breaches(BY_CODE["ROV009"], models) == [
        "home of 'Alba' is 1.58 m too near to 'bog': its waterDepth is 0.4 m, the rover's wadingDepth 0.1 m"
        " and its stepHeight is 0.3 m, the rover's groundClearance 0 m"
    ]


def test_a_task_at_an_altitude_is_off_the_ground(registry):
    made = mission(registry)
    made.tasks[0].point = mml.GeoCoordinate(latitude=42.0, longitude=13.0, altitude=30.0)
    made.origin = mml.GeoCoordinate(latitude=42.0, longitude=13.0, altitude=0.0)
    made.team.robots[0].home = mml.GeoCoordinate(latitude=42.0, longitude=13.0)
    (found,) = breaches(BY_CODE["ROV010"], [rover(registry), made])
    assert found == "task 'visit' is at 30 m, the team's rovers stay on the ground at 0 m"


def test_a_team_with_a_robot_that_is_no_rover_may_do_tasks_at_any_height(registry):
    plain = registry.create(ROBOT_LANGUAGE, "Robot", name="Kite")
    assert breaches(BY_CODE["ROV010"], [plain, mission(registry, up=50.0, kind="Kite")]) == []


def test_a_robot_that_is_no_rover_may_begin_in_water(registry):
    plain = registry.create(ROBOT_LANGUAGE, "Robot", name="Otter")
    models = [plain, mission(registry, home=(5.0, 5.0), kind="Otter"), place_with(terrain(registry))]
    assert breaches(BY_CODE["ROV009"], models) == []


def test_a_corner_that_is_too_narrow_to_pass_is_named_with_its_turn_and_its_shorter_leg(registry):
    found = breaches(BY_CODE["ROV011"], [rover(registry), driving((10, 0), (10, 1.5), (0, 1.5))])
    assert found == [
        f"end of '{move}' is passed without a stop, and a turn of 90° is too narrow between legs of 1.50 m"
        for move in ("p0", "p1")
    ]


def test_a_rover_stops_at_any_corner_and_passes_any_where_it_turns_on_the_spot(registry):
    assert breaches(BY_CODE["ROV011"], [rover(registry), driving((10, 0), (10, 1), fluid=False)]) == []
    turns = rover(registry, turningRadius=0.0)
    assert breaches(BY_CODE["ROV011"], [turns, driving((10, 0), (10, 1))]) == []
