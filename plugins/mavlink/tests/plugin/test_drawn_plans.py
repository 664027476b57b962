import json
import re
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.drawings.drawing import Geometry, HeightReference, Role
from mmrs_core.errors import UnreadableError
from mmrs_mavlink.plugin.plans.drawn_lists import read_list, recognise_list
from mmrs_mavlink.plugin.plans.drawn_plans import read_plan, recognise_plan

FIELD = [[47.0, 8.0], [47.0, 8.01], [47.01, 8.01]]


def item(command: int, *params: float | None, frame: int = 3) -> dict:
    return {
        "type": "SimpleItem",
        "command": command,
        "frame": frame,
        "params": [*params],
        "autoContinue": True,
    }


def survey(kind: str, **shape: object) -> dict:
    return {"type": "ComplexItem", "complexItemType": kind, "version": 5, "angle": 30, **shape}


def plan(*items: dict, **more: object) -> bytes:
    mission = {"version": 2, "plannedHomePosition": [47.0, 8.0, 400.0], "items": [*items]}
    return json.dumps({"fileType": "Plan", "version": 1, "mission": mission, **more}, indent=1).encode()


PLAN = plan(
    item(22, 0, 0, 0, None, 47.0, 8.0, 20),
    item(178, 1, 5, -1, 0, 0, 0, 0, frame=2),
    item(16, 0, 0, 0, None, 47.001, 8.0, 30),
    item(201, 0, 0, 0, 0, 47.5, 8.0, 0),
    item(16, 5, 0, 0, None, 47.002, 8.0, 40),
    survey(
        "survey", polygon=FIELD, TransectStyleComplexItem={"CameraCalc": {"SideOverlap": 60}, "version": 1}
    ),
    survey("CorridorScan", polyline=FIELD, CorridorWidth=50),
    survey("StructureScan", polygon=FIELD, Layers=2),
    survey("fwLandingPattern"),
    geoFence={
        "version": 2,
        "polygons": [{"polygon": FIELD, "inclusion": False, "version": 1}],
        "circles": [{"circle": {"center": [47.0, 8.0], "radius": 200.5}, "inclusion": True, "version": 1}],
    },
    rallyPoints={"version": 2, "points": [[47.0, 8.0, 50.0]]},
)


def test_taking_off_and_landing_are_no_waypoints_of_their_own():
    drawing = read_plan(plan(item(22, 0, 0, 0, None, 47.0, 8.0, 20), survey("survey", polygon=FIELD)), "a")
    assert [feature.role for feature in drawing.features] == [Role.HOME, Role.SURVEY]
    assert [left.reason for left in drawing.left_out] == ["robots take off, return and land without a task"]


def test_a_plan_becomes_areas_paths_fences_and_points():
    home, path, area, corridor, structure, fence, circle, rally = read_plan(PLAN, "a.plan").features
    assert (home.role, home.rings[0].tolist(), home.heights[0].tolist()) == (
        Role.HOME,
        [[47.0, 8.0]],
        [400.0],
    )
    assert (area.role, area.rings[0].tolist()) == (Role.SURVEY, FIELD)
    assert (area.properties["swathAngle"], area.properties["sideOverlap"]) == (30, 0.6)
    assert (corridor.role, corridor.geometry, corridor.properties["width"]) == (
        Role.CORRIDOR,
        Geometry.LINE,
        50,
    )
    assert structure.role is Role.STRUCTURE
    assert (path.role, path.reference, path.heights[0].tolist()) == (
        Role.WAYPOINT,
        HeightReference.HOME,
        [30, 40],
    )
    assert (fence.role, circle.role, circle.radius) == (Role.FORBIDDEN, Role.INCLUSION, 200.5)
    assert (rally.role, rally.reference) == (Role.RALLY_POINT, HeightReference.HOME)


@pytest.mark.parametrize(
    ("settings", "attributes"),
    [
        ({"entryLocation": 0, "Refly90Degrees": True}, {"startCorner": "NORTH_WEST", "crossHatch": True}),
        ({"entryLocation": 0, "angle": 80}, {"startCorner": "NORTH_EAST", "swathAngle": 80}),
        ({"entryLocation": 3, "angle": 170}, {"startCorner": "SOUTH_EAST", "swathAngle": 170}),
        ({"flyAlternateTransects": False, "HoverAndCapture": True}, {"capture": "AT_STOPS"}),
        ({"EntryPoint": 3, "TurnAroundDistance": 9}, {"inverted": True, "turnaroundDistance": 9}),
        ({"EntryPoint": 1, "entryLocation": "top"}, {}),
    ],
)
def test_settings_of_a_survey_become_attributes(settings, attributes):
    transects = {"TransectStyleComplexItem": {"angle": 0, **settings}}
    _, area = read_plan(plan({**survey("survey", polygon=FIELD), **transects}), "a.plan").features
    assert area.properties == {"swathAngle": 0, **attributes}


def test_a_structure_scan_has_layers_around_it():
    settings = {"ScanBottomAlt": 4, "Layers": 3, "StartFromTop": True, "StructureHeight": 15}
    camera = {"DistanceToSurface": 20, "AdjustedFootprintFrontal": 6, "FrontalOverlap": 70, "SideOverlap": 60}
    scan = survey("StructureScan", polygon=FIELD, CameraCalc=camera, **settings)
    _, structure = read_plan(plan(scan), "a.plan").features
    assert structure.properties == {
        "StructureHeight": 15,
        "distance": 20,
        "sideOverlap": 0.7,
        "frontOverlap": 0.6,
        "layers": 3,
        "startFromTop": True,
        "altitude": 7,
        "topAltitude": 19,
    }


def test_items_that_are_no_shape_are_left_out():
    left_out = {each.what: each.reason for each in read_plan(PLAN, "a.plan").left_out}
    assert left_out == {
        "item 1": "robots take off, return and land without a task",
        "item 2": "command 178 (DO_CHANGE_SPEED) does not move a vehicle to a place",
        "item 4": "command 201 (DO_SET_ROI) does not move a vehicle to a place",
        "waiting at item 5": "what a robot does there is a task of its own",
        "item 9": "'fwLandingPattern' is not a kind of item that is read",
    }
    assert all(each.place.line > 1 for each in read_plan(PLAN, "a.plan").left_out)


def test_waypoints_are_a_path_between_surveys_and_a_point_where_there_is_one():
    first, second = item(16, 0, 0, 0, 0, 47, 8, 9), item(16, 0, 0, 0, 0, 47, 8.1, 9)
    data = plan(first, second, survey("survey", polygon=FIELD), second, second)
    drawing = read_plan(data, "a.plan")
    assert [(each.geometry, each.name) for each in drawing.features[1:]] == [
        (Geometry.LINE, "waypoints 1 to 2"),
        (Geometry.AREA, "survey 3"),
        (Geometry.POINT, "waypoint 4"),
    ]
    assert [each.reason for each in drawing.left_out] == ["at the same position as waypoint 4"]


MIXED = [
    item(16, 0, 0, 0, 0, 47 + 0.01 * n, 8, up, frame=frame)
    for n, (up, frame) in enumerate([(30, 3), (440, 0), (35, 10), (460, 5)])
]


def test_waypoints_with_heights_in_several_frames_are_one_line_above_home():
    drawing = read_plan(plan(*MIXED), "a.plan")
    _, path = drawing.features
    assert (path.geometry, path.reference) == (Geometry.LINE, HeightReference.HOME)
    assert path.heights[0].tolist() == [30, 40, 35, 60]
    assert [(each.what, each.reason) for each in drawing.left_out] == [
        (
            "frames of items 2, 3, 4",
            "their heights above mean sea level and above the ground are counted from home instead",
        )
    ]


def test_waypoints_are_runs_of_one_frame_where_the_height_of_home_is_not_known():
    data = plan(*MIXED[:2], MIXED[3], MIXED[2]).replace(b"400.0", b"null")
    drawing = read_plan(data, "a.plan")
    assert [(each.geometry, each.name, each.reference.value) for each in drawing.features] == [
        (Geometry.POINT, "planned home", "no height"),
        (Geometry.POINT, "waypoint 1", "the home position"),
        (Geometry.LINE, "waypoints 2 to 3", "mean sea level"),
        (Geometry.POINT, "waypoint 4", "the ground"),
    ]
    assert [(each.what, each.reason) for each in drawing.left_out] == [
        ("line from item 1 to item 2", "their heights are in frames 3 and 0, and that of home is not known"),
        ("line from item 3 to item 4", "their heights are in frames 5 and 10, and that of home is not known"),
    ]


def test_waypoints_that_mmrs_planned_are_no_tasks():
    data = plan(item(16, 0, 0, 0, 0, 47, 8, 9), item(16, 0, 0, 0, 0, 47, 8.1, 9), groundStation="MMRS")
    assert read_plan(data, "a.plan").features[1].role is Role.PATH


@pytest.mark.parametrize("key", ["mission", "geoFence", "rallyPoints"])
def test_a_part_that_is_no_object_is_refused(key):
    data = json.dumps({"fileType": "Plan", "version": 1, key: [1]}).encode()
    with pytest.raises(UnreadableError, match=f"^a:1: '{key}' is not an object"):
        read_plan(data, "a")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b'{"fileType": "Fence"}', r"^a\.plan:1: no plan of QGroundControl"),
        (b'{"fileType": "Plan", "version": 9}', r"^a\.plan:1: plans of version 9 are not read"),
        (plan({"type": "SimpleItem"}), r"^a\.plan:\d+: item 1: a command and seven parameters are expected"),
        (plan(survey("survey", polygon=7)), r"^a\.plan:\d+: 'polygon' is not an array"),
        (plan(survey("survey", polygon=[[None, 8]])), r"^a\.plan:\d+: .* null of position 1 is not a number"),
        (plan(item(16, 0, 0, 0, 0, 100, 8, 5)), r"^a\.plan:\d+: waypoint 1: .* is not on the Earth"),
        (
            plan(geoFence={"circles": [{"circle": {"center": [47, 8], "radius": -1}}]}),
            "its radius is not a length",
        ),
    ],
)
def test_what_is_no_plan_is_refused_with_its_line(data, message):
    with pytest.raises(UnreadableError, match=message):
        read_plan(data, "a.plan")


def listed(*rows: str) -> bytes:
    return "\r\n".join(["QGC WPL 110", *(row.replace(" ", "\t") for row in rows)]).encode()


HOME = "0 1 0 16 0 0 0 0 47.0 8.0 400 1"


def test_a_list_of_waypoints_begins_with_home():
    data = listed(
        HOME, "1 0 3 22 0 0 0 0 0 0 20 1", "2 0 3 16 0 0 0 0 47.0 8.0 20 1", "3 0 3 16 0 0 0 0 47.1 8.0 30 1"
    )
    drawing = read_list(data, "a.waypoints")
    home, path = drawing.features
    assert (home.role, home.heights[0].tolist(), home.place.line) == (Role.HOME, [400], 2)
    assert (path.role, path.name, path.rings[0].tolist()) == (
        Role.WAYPOINT,
        "waypoints 2 to 3",
        [[47.0, 8.0], [47.1, 8.0]],
    )
    assert [each.what for each in drawing.left_out] == ["item 1"]
    assert recognise_list(data, "a.txt")
    assert recognise_plan(PLAN, "a.json")


def test_lists_of_fences_and_rally_points_are_shapes():
    corners = [
        f"{n} 0 0 5002 3 0 0 0 {latitude} {longitude} 0 1" for n, (latitude, longitude) in enumerate(FIELD)
    ]
    fence, rally = read_list(listed(*corners, "3 0 3 5100 0 0 0 0 47 8 50 1"), "a.waypoints").features
    assert (fence.role, fence.rings[0].tolist()) == (Role.FORBIDDEN, FIELD)
    assert (rally.role, rally.heights[0].tolist()) == (Role.RALLY_POINT, [50])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"QGC WPL 120\n", r"^a\.waypoints:1: the first line is not 'QGC WPL 110'"),
        (listed("0 1 0 16"), r"^a\.waypoints:2: 4 values instead of 12"),
        (listed("0 1 0 x 0 0 0 0 47 8 400 1"), r"^a\.waypoints:2: 'x' is not a number"),
        (listed("0 1 0 1e999 0 0 0 0 47 8 400 1"), r"^a\.waypoints:2: 1e999 cannot be the number of an item"),
        (listed(HOME, "1 0 3 16 0 0 0 0 8.0 47.0 20 1"), r"^a\.waypoints:3: .* seem to be swapped"),
        (listed("0 0 0 5002 3 0 0 0 47 8 0 1"), r"^a\.waypoints:2: .* 3 corners of it are expected"),
    ],
)
def test_what_is_no_list_is_refused_with_its_line(data, message):
    with pytest.raises(UnreadableError, match=message):
        read_list(data, "a.waypoints")


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=8) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=8,
)
KEYS = ("command", "frame", "params", "type", "complexItemType", "polygon", "polyline", "CameraCalc")


@settings(deadline=None)
@given(data=st.data())
def test_of_any_plan_every_item_is_in_the_account_or_it_is_refused(data):
    items = json.loads(PLAN)["mission"]["items"]
    for each in data.draw(st.lists(st.sampled_from(items), max_size=4)):
        each[data.draw(st.sampled_from(KEYS))] = data.draw(VALUES)
    more = {data.draw(st.sampled_from(("geoFence", "rallyPoints"))): data.draw(VALUES)}
    with suppress(UnreadableError):
        drawing = read_plan(plan(*items, **data.draw(st.sampled_from(({}, more)))), "a.plan")
        assert drawing.features or drawing.left_out


@settings(deadline=None)
@given(
    rows=st.lists(
        st.tuples(
            st.sampled_from((16, 22, 19, 31, 177, 201, 5002, 5003, 5100, -1)),
            st.sampled_from((0, 3, 10, 99)),
            st.floats() | st.integers(-200, 200),
            st.floats(-1, 1),
        ),
        max_size=8,
    )
)
def test_of_any_list_every_row_is_in_the_account_or_it_is_refused(rows):
    data = listed(
        HOME, *(f"{at} 0 {row[1]} {row[0]} 3 0 0 0 {row[2]} {row[3]} 9 1" for at, row in enumerate(rows, 1))
    )
    with suppress(UnreadableError):
        drawing = read_list(data, "a.waypoints")
        lost = [re.findall(r"^items? (\d+)(?: to (\d+))?", each.what) for each in drawing.left_out]
        count = sum(int(last or first) - int(first) + 1 for found in lost for first, last in found)
        shown = sum(len(each.rings[0]) for each in drawing.features) - 1
        whole = sum(each.lost is not None for each in drawing.left_out)
        assert shown + count + 3 * whole >= len(rows)


@settings(deadline=None)
@given(
    data=st.binary(max_size=80),
    begin=st.sampled_from((b"QGC WPL 110\n", b'{"fileType": "Plan", "version": 1, ', b"")),
)
def test_of_any_bytes_a_drawing_comes_or_a_clear_error(data, begin):
    for read in (read_list, read_plan):
        with suppress(UnreadableError):
            read(begin + data, "a")


@pytest.mark.parametrize(
    ("calc", "reference", "altitude"),
    [
        ({"DistanceToSurface": 60, "DistanceMode": 2}, HeightReference.SEA_LEVEL, None),
        ({"DistanceToSurface": 60, "DistanceToSurfaceRelative": False}, HeightReference.SEA_LEVEL, None),
        ({"DistanceToSurface": 60, "DistanceMode": 1}, HeightReference.NONE, 60.0),
        ({"DistanceToSurface": 60, "DistanceToSurfaceRelative": True}, HeightReference.NONE, 60.0),
    ],
)
def test_a_survey_above_mean_sea_level_has_heights_instead_of_an_altitude(calc, reference, altitude):
    data = plan(survey("survey", polygon=FIELD, TransectStyleComplexItem={"CameraCalc": calc}))
    field = read_plan(data, "a").features[-1]
    assert (field.reference, field.properties.get("altitude")) == (reference, altitude)
    assert [ring.tolist() for ring in field.heights] == ([[60.0] * len(FIELD)] if altitude is None else [])
