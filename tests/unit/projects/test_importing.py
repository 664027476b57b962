"""Drawings become projects that say of everything where it came from."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from mmrs_core.diagnostics import Place, has_errors
from mmrs_core.drawings.drawing import Geometry, HeightReference, LeftOut, MapFeature, Role
from mmrs_core.errors import UnreadableError, UsageError
from mmrs_core.pipeline import expand, ground, plan, read_models, valid_models
from mmrs_core.plugins import load_plugins
from mmrs_core.projects.choosing import assignment_of, read_mapping
from mmrs_core.projects.importing import ImportOptions, ImportRefusedError, imported
from mmrs_core.projects.notes import empty_project
from mmrs_core.projects.team import robot_wanted, types_for

CONTRIBUTIONS = load_plugins().contributions
LATITUDE, LONGITUDE = 42.35, 13.39
METRE = 1 / 111_200
ROBOT = robot_wanted("Kestrel=Yard drone", "--robot")
TYPE_FILE = Path(__file__).parents[3] / "examples" / "drone-and-rover" / "robots" / "yard-drone.xmi"
TYPES = types_for((ROBOT,), [TYPE_FILE], CONTRIBUTIONS)


def at(east, north):
    return LATITUDE + north * METRE, LONGITUDE + east * METRE / np.cos(np.radians(LATITUDE))


def drawn(name, *points, heights=None, reference=HeightReference.GROUND, line=1, **more):
    geometry = {1: Geometry.POINT, 2: Geometry.LINE}.get(len(points), Geometry.AREA)
    own = {} if heights is None else {"heights": (np.array(heights, float),), "reference": reference}
    more = {"geometry": geometry, "place": Place("farm.kml", line)} | own | more
    return MapFeature(rings=(np.array([at(*point) for point in points]),), name=name, **more)


def square(name, east=60.0, north=60.0, side=50.0, **more):
    corners = [(0, 0), (side, 0), (side, side), (0, side)]
    return drawn(name, *((east + x, north + y) for x, y in corners), **more)


HOME = drawn("Home", (0, 0), line=99)
OPTIONS = ImportOptions(robots=(ROBOT,), types=TYPES, title="farm")


def choices(*texts):
    return replace(OPTIONS, choices=tuple(assignment_of(text, f"--as '{text}'") for text in texts))


def made(*features, options=OPTIONS, folder=Path("farm"), **more):
    return imported((*features, HOME), (), options, CONTRIBUTIONS, folder, **more)


def outcome(feature, options=OPTIONS):
    return made(feature, options=options).outcomes[0]


def saved(result):
    for file, data in result.files.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


def models_of(result, folder):
    saved(result)
    return valid_models(folder, CONTRIBUTIONS)[0]


@pytest.mark.parametrize(
    ("feature", "became", "by"),
    [
        (square("meadow"), "PhotoGridTask", "it is an area"),
        (drawn("fence", (20, 0), (60, 0)), "RoadTask", "it is a line"),
        (drawn("trough", (20, 0)), "ObserveTask", "it is a point"),
        (drawn("", (20, 0), radius=20.0), "PhotoGridTask", "it is an area"),
        (square("No-fly zone"), "forbidden area", "its name"),
        (square("barn", folders=("Obstacles", "mine")), "obstacle", "its folder"),
        (square("rally point"), "emergency area", "its name"),
        (square("Nofly home"), "forbidden area", "its name"),
        (square("homestead"), "PhotoGridTask", "it is an area"),
        (square("home field"), "PhotoGridTask", "it is an area"),
        (square("x", role=Role.SURVEY), "PhotoGridTask", "it is a survey"),
        (square("x", role=Role.OBSTACLE), "obstacle", "it is an obstacle"),
        (square("x", role=Role.FORBIDDEN), "forbidden area", "it is a forbidden area"),
        (
            square("x", properties={"type": "MeasureTask", "actionName": "a"}),
            "MeasureTask",
            "its property type",
        ),
        (square("x", role=Role.ELEMENT, properties={"type": "Terrain"}), "Terrain", "its property type"),
        (square("x", properties={"type": "Landmark"}), "PhotoGridTask", "it is an area"),
        (drawn("", (20, 0), role=Role.RALLY_POINT), "emergency area", "it is a rally point"),
        (drawn("", (20, 0), heights=[9], role=Role.WAYPOINT), "GoToTask", "it is a waypoint"),
        (drawn("", (20, 0), (40, 0), role=Role.WAYPOINT), "RoadTask", "they are waypoints"),
    ],
    ids=lambda each: getattr(each, "name", each),
)
def test_features_become_what_their_role_words_and_shape_say(feature, became, by):
    found = outcome(feature)
    assert (found.became, found.by, found.reason) == (became, by, "")


@pytest.mark.parametrize(
    ("feature", "reason"),
    [
        (square("fence", role=Role.INCLUSION), "kept out of areas, not inside them"),
        (drawn("flown", (0, 0), (9, 9), role=Role.TRACK), "--as 'flown'=task makes a task of it"),
        (
            drawn("flown", (0, 0), (9, 9), role=Role.TRACK, folders=("logs", "tracks")),
            "--as 'tracks/flown'=task makes",
        ),
        (
            square("x", role=Role.ELEMENT, properties={"type": "PanelGroup"}),
            "no PanelGroup is drawn as an area: it is a part of one",
        ),
        (drawn("x", (5, 5), radius=1e6), "radius 1e+06 m: expected one above 0 and below 100000 m"),
        (drawn("x", (5, 5), radius=np.inf), "radius inf m: expected"),
        (drawn("Kite", (5, 5), role=Role.CHOSEN_RALLY_POINT), "it was chosen from the emergency areas"),
        (square("x", role=Role.ELEMENT), "a context element of no type that is installed"),
        (drawn("home", (20, 0)), "no robot begins there; --robot NAME=TYPE adds one that does"),
        (
            replace(square("x"), rings=(np.array([(95.0, 0), (9, 0), (9, 9)]),)),
            "latitude 95, longitude 0 is not",
        ),
        (drawn("x", (5, 5), (5, 5), (5, 5), (6, 6)), "2 different positions; areas have 3 or more"),
        (square("emergency", folders=()), ""),
    ],
    ids=lambda each: getattr(each, "name", None),
)
def test_what_is_left_says_why_and_what_to_do(feature, reason):
    options = replace(OPTIONS, robots=(replace(ROBOT, position=(LATITUDE, LONGITUDE)),))
    assert (
        reason
        in imported((feature, square("f", 300)), (), options, CONTRIBUTIONS, Path("x")).outcomes[0].reason
    )


def test_a_choice_sets_attributes_of_any_installed_type_and_the_last_that_fits_counts():
    options = choices(
        "*=GoToTask", "Mead*=PhotoGridTask:gridResolution=5,altitude=25", "fields/*=Terrain:slope=12"
    )
    meadow, pit = square("meadow"), square("pit", 200, folders=("farm", "Fields"))
    result = made(meadow, pit, drawn("gate", (20, 0)), options=options)
    assert [each.became for each in result.outcomes] == ["PhotoGridTask", "Terrain", "GoToTask", "home"]
    text = result.files[Path("farm/mission.xmi")].decode()
    assert 'frontOverlap="0.7" sideOverlap="0.6" altitude="25.0" gridResolution="5.0"' in text
    assert 'slope="12.0"' in result.files[Path("farm/context.xmi")].decode()


def test_a_choice_for_all_leaves_areas_to_keep_clear_of_alone():
    assert made(square("No-fly"), square("x", 300), options=choices("*=ignore", "x=task")).outcomes[0].became


def test_a_choice_that_makes_a_task_of_what_is_to_be_kept_clear_is_noted():
    note = "not the forbidden area that it would be otherwise (its name)"
    assert outcome(square("No-fly zone"), choices("No*=task")).notes[0] == note


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("X=PhotoGrid", "did you mean PhotoGridTask?"),
        ("X=task", "no feature has such a name"),
        ("Home=PhotoGridTask", "none of the features with such a name can become PhotoGridTask"),
        ("meadow=PhotoGridTask:groundresolution=1", "did you mean groundResolution?"),
        ("meadow=PhotoGridTask:groundResolution=fine", "groundResolution=fine: "),
        ("meadow=PhotoGridTask:groundResolution=nan", "groundResolution=nan: "),
        ("meadow=DepthHoldSurveyTask", "needs depth: Depth of the lines below the surface, in metres."),
        ("meadow", "expected PATTERN=TYPE"),
        ("meadow=task:3", "'3': expected NAME=VALUE"),
    ],
)
def test_a_wrong_choice_is_refused_with_what_is_right(text, words):
    with pytest.raises(UsageError) as refused:
        made(square("meadow"), options=choices(text))
    assert words in " ".join((str(refused.value), *refused.value.elements))


def test_a_mapping_file_holds_choices_and_robots(tmp_path):
    file = tmp_path / "farm.toml"
    file.write_text(
        '[as]\n"Field*" = "task:altitude=20"\nnothing = "ignore"\n[robots]\nKestrel = "Yard drone@Home"\n'
    )
    found = read_mapping(file)
    options = replace(
        OPTIONS, choices=found.choices, robots=(robot_wanted(f"Kestrel={found.robots['Kestrel']}", ""),)
    )
    result = made(square("field 1"), options=options)
    assert 'altitude="20.0"' in result.files[Path("farm/mission.xmi")].decode()
    assert result.notes[0].endswith(
        "'nothing': no feature has such a name, or an option that is given later takes them all"
    )


@pytest.mark.parametrize("text", ["[as", "[ass]\na='b'", "[as]\na=1", "as='b'"])
def test_a_mapping_file_with_anything_else_is_refused(tmp_path, text):
    (tmp_path / "farm.toml").write_text(text)
    with pytest.raises(UnreadableError, match=r"farm\.toml: "):
        read_mapping(tmp_path / "farm.toml")


def test_a_project_is_commented_valid_and_planned_and_the_same_bytes_again(tmp_path):
    features = (
        square("Meadow", line=7, folders=("Fields",)),
        square("No fly", 60, 120, 30),
        drawn("mast", (30, 30), properties={"height": 12, "radius": 2}),
    )
    options = choices("mast=obstacle")
    result = made(*features, options=options, folder=tmp_path)
    assert not has_errors(result.diagnostics)
    assert result.files == made(*features, options=options, folder=tmp_path).files
    models = models_of(result, tmp_path)
    assert "  <!-- farm.kml, line 7: Fields / Meadow -->\n" in (tmp_path / "mission.xmi").read_text()
    assert (tmp_path / "robots" / "yard-drone.xmi").read_bytes() == TYPE_FILE.read_bytes()
    assert models.context.obstacles[0].maxHeight == 12.0
    assert plan(expand(ground(models), CONTRIBUTIONS)).robots


@pytest.mark.parametrize(
    ("home", "feature", "reference", "altitude"),
    [
        (HOME, drawn("p", (20, 0), heights=[12.0]), "ORIGIN", 12.0),
        (HOME, drawn("p", (20, 0), heights=[0.0]), "ORIGIN", None),
        (HOME, drawn("p", (20, 0), heights=[640.0], reference=HeightReference.SEA_LEVEL), "ORIGIN", None),
        (
            drawn("home", (0, 0), heights=[630.0], reference=HeightReference.SEA_LEVEL),
            drawn("p", (20, 0), heights=[642.0], reference=HeightReference.SEA_LEVEL),
            "MSL",
            642.0,
        ),
        (
            drawn("home", (0, 0), heights=[630.0], reference=HeightReference.ELLIPSOID),
            drawn("p", (20, 0), heights=[12.0], reference=HeightReference.HOME),
            "ELLIPSOID",
            642.0,
        ),
    ],
)
def test_heights_are_settled_against_the_home(tmp_path, home, feature, reference, altitude):
    result = imported((feature, home), (), OPTIONS, CONTRIBUTIONS, tmp_path)
    mission = models_of(result, tmp_path).mission
    assert (mission.altitudeReference, mission.tasks[0].point.altitude) == (reference, altitude)
    assert mission.tasks[0].altitude == (30.0 if altitude is None else None)
    left = "heights above mean sea level are left out: that of the origin is not known"
    assert (left in result.outcomes[0].notes) is bool(feature.heights[0][0] == 640.0)


def test_an_area_with_heights_is_covered_at_that_height(tmp_path):
    result = made(square("f", heights=[45.0] * 4), folder=tmp_path)
    assert models_of(result, tmp_path).mission.tasks[0].altitude == 45.0


def test_tasks_begin_off_areas_that_are_closed(tmp_path):
    result = made(square("field"), square("forbidden", 40, 40, 15), folder=tmp_path)
    begin = models_of(result, tmp_path).mission.tasks[0].initialPosition
    assert (begin.latitude, begin.longitude) != pytest.approx(at(60, 60))


def test_holes_of_tasks_stay_and_those_of_forbidden_areas_are_closed(tmp_path):
    inner = square("", 70, 70, 10).rings
    field, zone = square("field"), square("forbidden", 300, 60)
    hole = square("", 310, 70, 10).rings
    result = made(
        replace(field, rings=field.rings + inner), replace(zone, rings=zone.rings + hole), folder=tmp_path
    )
    assert len(models_of(result, tmp_path).mission.tasks[0].holes[0].points) == 4
    assert result.outcomes[1].notes == ("a forbidden area has no holes: these are closed, too",)


def test_waypoints_keep_their_order(tmp_path):
    way = [drawn(str(n), (20 * n, 0), role=Role.WAYPOINT) for n in (1, 2, 3)]
    mission = models_of(made(*way, folder=tmp_path), tmp_path).mission
    assert [(each.from_.name, each.to.name) for each in mission.taskDependencies] == [("1", "2"), ("2", "3")]


NAMES = [
    '"><!-- x --><tasks/>',
    "../../etc/passwd",
    "a\nb\x00\x1b[2J\u202e",
    "x" * 100_000,
    "",
    "  ",
    "twice",
    "twice",
]


def test_names_of_any_kind_are_readable_unique_and_do_no_harm(tmp_path):
    features = [drawn(name, (20 * n, 0), place=Place("--><x>.kml", 1)) for n, name in enumerate(NAMES, 1)]
    result = made(*features, folder=tmp_path)
    names = [each.name for each in models_of(result, tmp_path).mission.tasks]
    shown = [
        '"><!-- x --><tasks/>',
        "../../etc/passwd",
        "a b [2J",
        "x" * 80,
        "observe",
        "observe 2",
        "twice",
        "twice 2",
    ]
    assert names == shown == [each.called for each in result.outcomes[:-1]]
    assert all(file.resolve().is_relative_to(tmp_path.resolve()) for file in result.files)


def test_an_obstacle_that_cannot_be_imported_is_refused_and_not_forgotten():
    with pytest.raises(UsageError) as refused:
        made(drawn("obstacle", (20, 0), line=3))
    advice = "--as 'obstacle'=obstacle:radius=METRES gives it one; --as 'obstacle'=ignore leaves it out"
    words = f"farm.kml:3: obstacle 'obstacle': a point has no extent; {advice}"
    assert refused.value.elements == (words,)


def test_an_obstacle_whose_shape_could_not_be_read_is_not_forgotten_either():
    mast = LeftOut("row 'mast'", "latitude 'x'", Place("a.csv", 4), drawn("mast", (0, 0)))
    options = choices("mast=obstacle:radius=5")
    with pytest.raises(UsageError) as refused:
        imported((HOME,), (mast,), options, CONTRIBUTIONS, Path("x"))
    assert refused.value.elements == (
        "a.csv:4: obstacle row 'mast': latitude 'x'; --as 'mast'=ignore leaves it out",
    )
    assert imported((HOME,), (mast,), choices("mast=ignore"), CONTRIBUTIONS, Path("x")).files


def test_areas_of_too_many_positions_are_left_until_they_are_simplified():
    angles = np.linspace(0, 2 * np.pi, 20_000, endpoint=False)
    circle = drawn("c", *zip(200 + 100 * np.cos(angles), 200 + 100 * np.sin(angles), strict=True))
    assert outcome(circle).reason.startswith("20000 positions, more than 10000: --simplify METRES")
    found = outcome(circle, replace(OPTIONS, simplify=0.1))
    assert found.became == "PhotoGridTask"
    assert found.notes[0].startswith("simplified from 20000 to ")


def test_a_hole_of_one_position_is_removed_before_anything_is_simplified():
    field, point = square("field"), np.array([at(70, 70)] * 3)
    found = outcome(replace(field, rings=(*field.rings, point)), replace(OPTIONS, simplify=0.0))
    assert found.notes == ("2 repeated positions removed", "a hole without extent removed")


def test_faults_of_what_was_drawn_are_at_its_place():
    bow = drawn("bow", (60, 60), (90, 90), (90, 60), (60, 90), line=12)
    fault = made(bow).diagnostics[0]
    assert (fault.place.file, fault.place.line) == ("farm.kml", 12)
    assert "crosses or touches itself" in fault.message


@pytest.mark.parametrize(
    ("robot", "words"),
    [
        ("K=Yard drone@Hom", "no point is called 'Hom'; did you mean Home?"),
        ("K=Yard drone@91,3", "91,3 is not on the Earth"),
        ("K=", "expected NAME=TYPE"),
        ("K=Yard dron", "did you mean Yard drone?"),
    ],
)
def test_a_wrong_robot_is_refused_with_what_is_right(robot, words):
    def attempt():
        wanted = robot_wanted(robot, "--robot")
        made(
            options=replace(OPTIONS, robots=(wanted,), types=types_for((wanted,), [TYPE_FILE], CONTRIBUTIONS))
        )

    with pytest.raises(UsageError, match=words):
        attempt()


def test_a_robot_without_a_home_says_how_to_give_it_one():
    with pytest.raises(UsageError, match=r"--robot 'Kestrel=Yard drone@LATITUDE,LONGITUDE' gives one"):
        imported((square("f"),), (), OPTIONS, CONTRIBUTIONS, Path("x"))


def test_a_project_is_added_to_and_what_people_wrote_stays(tmp_path):
    saved(made(square("Meadow"), folder=tmp_path))
    mission = tmp_path / "mission.xmi"
    text = (
        mission.read_text()
        .replace("</tasks>", "</tasks> <!-- mine -->")
        .replace("</mission:Mission>", "<!-- end -->\n</mission:Mission>")
    )
    mission.write_text(text)
    more = (square("Meadow", 300), square("obstacle", 200), square("pit", 400), square("copy"))
    options = choices("pit=Terrain")
    options = replace(options, robots=(robot_wanted("Second=Yard drone@42.35,13.3905", ""),))
    result = imported(
        more, (LeftOut("an overlay", "it is a picture"),), options, CONTRIBUTIONS, tmp_path, into=True
    )
    assert [each.reason for each in result.outcomes] == [
        "",
        "",
        "",
        "the same is there already: Meadow",
        "it is a picture",
    ]
    models = models_of(result, tmp_path)
    assert [each.name for each in models.mission.tasks] == ["Meadow", "Meadow 2"]
    assert [each.name for each in models.mission.team.robots] == ["Kestrel", "Second"]
    kept = [line for line in text.splitlines() if "mission:Mission xmi" not in line]
    after = iter(mission.read_text().splitlines())
    assert all(line in after for line in kept)  # in their order
    again = replace(choices("pit=Terrain"), robots=())
    assert not imported(more, (), again, CONTRIBUTIONS, tmp_path, into=True).files


@pytest.mark.parametrize("height", [None, 700.0])
def test_a_project_without_a_place_gets_that_of_the_drawing_at_once_or_later(tmp_path, height):
    heights = {} if height is None else {"heights": [height], "reference": HeightReference.SEA_LEVEL}
    features = (drawn("Home", (0, 0), **heights), square("Meadow"), square("obstacle", 200))
    for folder, orders in ((tmp_path / "one", [OPTIONS]), (tmp_path / "two", [ADDING, OPTIONS])):
        saved(empty_project(folder, "farm", CONTRIBUTIONS))
        for options in orders:
            result = imported(features, (), options, CONTRIBUTIONS, folder, into=True)
            models = read_models(saved(result) or folder, CONTRIBUTIONS)[0]
        assert (
            "the project had no place on the Earth; it gets the home of Kestrel: 42.35, 13.39" in result.notes
        )
        assert not has_errors(result.diagnostics)
        assert [each.name for each in valid_models(folder, CONTRIBUTIONS)[0].mission.tasks] == ["Meadow"]
        assert models.mission.team.robots[0].home.altitude == (height if len(orders) == 1 else None)
        assert models.mission.altitudeReference == ("MSL" if height and len(orders) == 1 else "ORIGIN")


def test_what_is_added_has_the_line_endings_of_its_file(tmp_path):
    saved(made(square("Meadow"), folder=tmp_path))
    for file in tmp_path.glob("*.xmi"):
        file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    more = (square("Pasture", 300), square("obstacle", 200))
    saved(imported(more, (), ADDING, CONTRIBUTIONS, tmp_path, into=True))
    for file in tmp_path.glob("*.xmi"):
        data = file.read_bytes()
        assert (b"Pasture" in data) is not (b"obstacle" in data)
        assert data.count(b"\r\n") == data.count(b"\n")


def test_an_area_is_the_same_from_any_corner_and_either_way_round_but_a_line_is_not(tmp_path):
    corners, road = [(60, 60), (110, 60), (110, 110), (60, 110)], [(20, 0), (20, 40)]
    saved(made(drawn("pit", *corners), drawn("Track", *road), folder=tmp_path))
    again = replace(OPTIONS, robots=())
    more = [
        drawn("turned", *corners[::-1]),
        drawn("begun elsewhere", *corners[2:], *corners[:2]),
        drawn("crossed", *(corners[each] for each in (0, 2, 1, 3))),
        drawn("Track back", *road[::-1]),
    ]
    outcomes = imported(more, (), again, CONTRIBUTIONS, tmp_path, into=True).outcomes
    reasons = {each.name: each.reason for each in outcomes}
    same = "the same is there already: pit"
    assert reasons == {"turned": same, "begun elsewhere": same, "crossed": "", "Track back": ""}


def test_what_differs_from_the_same_shape_in_a_project_is_reported_and_a_higher_obstacle_is_a_fault(tmp_path):
    def features(mast, field, lane):
        road = drawn("lane", (20, 0), (20, 40), heights=[lane, lane])
        return square("obstacle", heights=[mast] * 4), square("field", 200, heights=[field] * 4), road

    saved(made(*features(20.0, 40.0, 20.0), folder=tmp_path))
    again = replace(OPTIONS, robots=())
    result = imported(features(15.0, 70.0, 60.0), (), again, CONTRIBUTIONS, tmp_path, into=True)
    assert [each.reason for each in result.outcomes] == [
        "its shape is there already: obstacle, with maxHeight 20.0 instead of 15.0; change it there",
        "its shape is there already: field, with altitude 40.0 instead of 70.0; change it there",
        "its shape is there already: lane, with other heights; change it there",
    ]
    assert not result.files
    with pytest.raises(ImportRefusedError) as refused:
        imported(features(60.0, 40.0, 20.0), (), again, CONTRIBUTIONS, tmp_path, into=True)
    assert "maxHeight 20.0 instead of 60.0" in str(refused.value.elements)


@pytest.mark.parametrize("tolerance", [3.0, 10.0])
def test_a_simplified_obstacle_holds_all_that_was_drawn(tmp_path, tolerance):
    corners = [(60, 60), (110, 60), (112, 85), (110, 110), (60, 110), (57, 80)]
    options = replace(OPTIONS, simplify=tolerance)
    result = made(drawn("obstacle", *corners), square("field", 200), options=options, folder=tmp_path)
    (pit,) = models_of(result, tmp_path).context.obstacles
    ring = [(each.latitude, each.longitude) for each in pit.shell]
    assert len(ring) < len(corners) + 1
    assert shapely.Polygon(ring).covers(shapely.Polygon([at(*each) for each in corners]))


def test_heights_that_a_mission_cannot_state_are_its_tasks_own_or_left_out(tmp_path):
    saved(made(square("Meadow"), folder=tmp_path))
    mission = tmp_path / "mission.xmi"
    mission.write_text(mission.read_text().replace(' altitudeReference="ORIGIN"', ""))
    points = (drawn("a", (20, 0), heights=[12.0]), drawn("b", (30, 0), heights=[12.0]))
    result = imported(
        points, (), replace(choices("b=GoToTask"), robots=()), CONTRIBUTIONS, tmp_path, into=True
    )
    saved(result)
    tasks = read_models(tmp_path, CONTRIBUTIONS)[0].mission.tasks
    assert (tasks[1].altitude, tasks[1].point.altitude, tasks[2].point.altitude) == (12.0, None, None)
    assert result.outcomes[1].notes == ("its height is left out: that of the origin is not known",)


def test_positions_are_in_the_crs_of_the_mission(tmp_path):
    saved(made(square("Meadow"), folder=tmp_path))
    mission = tmp_path / "mission.xmi"
    mission.write_text(mission.read_text().replace('name="farm"', 'name="farm" crs="EPSG:4230"'))
    result = imported((drawn("a", (20, 0)),), (), ADDING, CONTRIBUTIONS, tmp_path, into=True)
    point = models_of(result, tmp_path).mission.tasks[1].point
    assert 50 < abs(point.latitude - at(20, 0)[0]) / METRE < 200  # ED50 and WGS84 differ by so many metres


def test_a_mission_in_json_is_added_to(tmp_path):
    saved(made(square("Meadow"), folder=tmp_path))
    from mmrs_core.cli import run

    assert run(["convert", str(tmp_path / "mission.xmi"), str(tmp_path / "mission.json")]) == 0
    (tmp_path / "mission.xmi").unlink()
    result = imported((square("Pasture", 300),), (), ADDING, CONTRIBUTIONS, tmp_path, into=True)
    assert [each.name for each in models_of(result, tmp_path).mission.tasks] == ["Meadow", "Pasture"]


ADDING = replace(OPTIONS, robots=())


PIPE = drawn("main pipe", (0, 50), (90, 50), properties={"type": "Pipeline"})
SPARE = drawn("spare pipe", (0, 70), (90, 70), properties={"type": "Pipeline"})


@pytest.mark.parametrize(
    ("pipes", "choice", "led_to"),
    [
        ([PIPE], "look=FollowPipelineTask", "main pipe"),
        ([PIPE, SPARE], "look=FollowPipelineTask:pipeline=spare pipe,height=2", "spare pipe"),
    ],
)
def test_tasks_without_a_shape_lead_to_what_has_one(pipes, choice, led_to):
    result = made(*pipes, drawn("look", (5, 5)), options=choices(choice))
    assert result.outcomes[len(pipes)].became == "FollowPipelineTask"
    (task,) = result.models.mission.tasks
    assert task.pipeline.name == led_to


@pytest.mark.parametrize(
    ("pipes", "choice", "fault"),
    [
        ([], "look=FollowPipelineTask", "FollowPipelineTask needs pipeline: "),
        ([PIPE, SPARE], "look=FollowPipelineTask", "FollowPipelineTask needs pipeline: "),
        (
            [PIPE],
            "look=FollowPipelineTask:pipeline=pip",
            "pipeline: there is main pipe, and none has the name 'pip'",
        ),
        ([PIPE, PIPE], "look=FollowPipelineTask:pipeline=none", "none has the name 'none'"),
    ],
)
def test_what_a_task_is_to_lead_to_has_to_be_there(pipes, choice, fault):
    with pytest.raises(ImportRefusedError) as refused:
        made(*pipes, drawn("look", (5, 5)), options=choices(choice))
    assert fault in str(refused.value.elements)


def test_an_exported_task_whose_element_is_missing_is_left_out():
    look = drawn("look", (5, 5), role=Role.TASK, properties={"type": "FollowPipelineTask", "pipeline": "x"})
    assert "none has the name 'x'; write the task in the model" in outcome(look).reason


def test_elements_in_a_task_come_back_from_properties():
    properties = {
        "type": "MeasureTask",
        "actionName": "Sound",
        "parameters[1].key": "gain",
        "parameters[1].value": "3",
        "parameters[0].key": "frequency",
        "parameters[0].value": 200,
        "parameters[0].unit": "Hz",
    }
    measuring = drawn("soundings", (5, 5), (9, 9), (30, 5), role=Role.TASK, properties=properties)
    result = made(measuring)
    assert "its property parameters[0].unit is left out" in result.outcomes[0].notes
    (task,) = result.models.mission.tasks
    assert [(each.key, each.value) for each in task.parameters] == [("frequency", "200"), ("gain", "3")]


def test_settings_that_a_task_does_not_have_are_in_the_report():
    survey = square("survey 1", role=Role.SURVEY, properties={"angle": 45, "sideOverlap": 0.7, "camera": "X"})
    assert "PhotoGridTask has no angle, camera" in outcome(survey).notes


def test_tasks_of_one_name_that_lead_elsewhere_are_not_the_same(tmp_path):
    def look(pipe):
        return drawn(
            "look", (5, 5), role=Role.TASK, properties={"type": "FollowPipelineTask", "pipeline": pipe}
        )

    first = made(PIPE, SPARE, look("main pipe"), look("spare pipe"), folder=tmp_path)
    assert [task.pipeline.name for task in first.models.mission.tasks] == ["main pipe", "spare pipe"]
    saved(first)
    again = made(look("main pipe"), look("spare pipe"), folder=tmp_path, into=True).outcomes
    assert [each.reason for each in again[:2]] == [
        "the same is there already",
        "the same is there already: look 2",
    ]
    lower = replace(look("main pipe"), properties={**look("main pipe").properties, "height": 9})
    (found,) = made(lower, folder=tmp_path, into=True).outcomes[:1]
    assert "of this name is there already, with height 1.5 instead of 9.0; change it there" in found.reason
