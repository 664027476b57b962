"""What becomes of the missions of 2015 and of their places."""

import json

import pytest
from shapely.geometry import LinearRing


@pytest.fixture
def orchard(migrated, flyaq):
    return migrated(flyaq / "orchard-mission.json", flyaq / "Heron.xmi", flyaq / "orchard-context.json")


@pytest.fixture
def mission(orchard, model):
    return model(orchard, "mission.xmi")


@pytest.fixture
def context(orchard, model):
    return model(orchard, "context.xmi")


@pytest.fixture
def changed(flyaq, written):
    """Return a function that writes the mission with some changes to it."""

    def change(edit):
        text = json.loads((flyaq / "orchard-mission.json").read_text())
        edit(text)
        return written("changed.json", json.dumps(text))

    return change


def test_tasks_keep_their_order_and_become_those_of_the_survey_plugin(mission):
    kinds = [(type(task).__name__, task.name) for task in mission.tasks]
    assert kinds == [
        ("PhotoGridTask", "trees"),
        ("Fork", "split"),
        ("GoToTask", "gate"),
        ("RoadTask", "lane"),
        ("Join", "meet"),
    ]


def test_dependencies_lead_between_the_same_tasks(mission):
    pairs = [(each.from_.name, each.to.name) for each in mission.taskDependencies]
    assert pairs[:3] == [("trees", "split"), ("split", "gate"), ("split", "lane")]


def test_numbers_written_as_texts_are_numbers(mission):
    grid = mission.tasks[0]
    assert (grid.gridResolution, grid.altitude, grid.shell[0].latitude) == (10.0, 40.0, 46.001)


def test_a_border_that_repeats_its_first_vertex_loses_the_repetition(orchard, mission, told):
    assert len(mission.tasks[0].shell) == 4
    assert told(
        orchard, "repeats the vertex beside it, so it is left out: shell Coordinate (latitude 46.0010;"
    )


def test_a_point_may_be_a_list_of_one(mission):
    assert (mission.tasks[2].point.latitude, mission.tasks[2].point.altitude) == (46.0008, 20.0)


def test_of_several_points_the_first_is_taken_and_the_rest_told(migrated, model, told, changed):
    found = migrated(changed(lambda text: text["tasks"][2]["point"].append({"latitude": 1, "longitude": 2})))
    assert model(found, "mission.xmi").tasks[2].point.latitude == 46.0008
    assert told(found, "LOST: point takes one only, the first")


def test_altitudes_count_from_the_first_home(orchard, mission, told):
    assert mission.altitudeReference == "ORIGIN"
    assert mission.team.robots[0].home.altitude is None
    assert told(orchard, "CHANGED: altitudes were metres above the place of take-off")
    assert told(orchard, "altitude 3 of Coordinate")


def test_a_drone_without_a_name_is_named_after_its_type(orchard, mission, told):
    assert [robot.name for robot in mission.team.robots] == ["heron_1", "Heron_2"]
    assert told(orchard, "DEFAULTED: name is not given: Heron_2")


def test_names_that_are_taken_get_a_number(migrated, model, told, changed):
    def same_name(text):
        for drone in text["swarm"]["drones"]:
            drone["name"] = "heron"

    found = migrated(changed(same_name))
    assert [robot.name for robot in model(found, "mission.xmi").team.robots] == ["heron", "heron_2"]
    assert told(found, "'heron' is taken already, so this one is called 'heron_2'")


def test_a_fork_that_nothing_leads_to_is_left_out(migrated, model, told, changed):
    found = migrated(changed(lambda text: text["taskDependencies"].clear()))
    assert [task.name for task in model(found, "mission.xmi").tasks] == ["trees", "gate", "lane"]
    assert len(told(found, "so it controls nothing")) == 2


def test_a_dependency_on_nothing_is_told(migrated, told, changed):
    found = migrated(changed(lambda text: text["taskDependencies"][0]["from"].update({"$ref": "//@tasks.9"})))
    assert told(found, "LOST: leads to nothing in this file: from //@tasks.9")


def test_a_task_of_an_unknown_extension_is_told_and_left_out(migrated, model, told, changed):
    found = migrated(changed(lambda text: text["tasks"][3].update({"eClass": "mission://SwimTask"})))
    assert "lane" not in [task.name for task in model(found, "mission.xmi").tasks]
    assert told(found, "LOST: the mapping has no rule for this class: SwimTask 'lane'")
    assert told(found, "leads to SwimTask 'lane', which is not carried over")


def test_a_robot_type_that_nobody_knows_is_told(migrated, flyaq, told):
    assert told(
        migrated(flyaq / "orchard-mission.json"),
        "no robot type 'Heron' is known: migrate the file that describes it, too, or write robots/Heron.xmi",
    )


def test_a_robot_type_may_be_said_to_be_another(migrated, model, flyaq, told):
    files = (flyaq / "orchard-mission.json", flyaq / "drones.json")
    found = migrated(*files, types={"Heron": "Wren"})
    assert {robot.type for robot in model(found, "mission.xmi").team.robots} == {"Wren"}
    assert told(found, "the robot type 'Heron' is taken for 'Wren'")


def test_forbidden_areas_keep_their_distance_and_lose_the_altitudes_of_their_vertices(orchard, context, told):
    (stable,) = context.forbiddenAreas
    assert (stable.name, stable.safetyDistance, len(stable.shell)) == ("stable", 5.0, 3)
    assert told(orchard, "altitude 7 of Coordinate")


def test_an_obstacle_without_an_area_is_drawn_around_its_vertices(orchard, context, told):
    pole = context.obstacles[0]
    assert len(pole.shell) == 4
    north = max(vertex.latitude for vertex in pole.shell)
    assert (north - 46.004) * 111_320 == pytest.approx(1.0, abs=0.01)
    assert told(orchard, "so one is drawn 1 m around its vertices: draw it again: shell (46.004, 11.004)")


def test_a_greatest_height_of_zero_is_unlimited(orchard, context, told):
    assert context.obstacles[0].maxHeight is None
    assert told(orchard, "0 was what the editor put where no height was known: taken as unlimited")


def test_a_smallest_height_above_the_greatest_is_left_out(orchard, context, told):
    assert (context.obstacles[1].minHeight, context.obstacles[1].maxHeight) == (None, 9.0)
    assert told(orchard, "DOUBTFUL: is not below maxHeight, so only that is carried over: minHeight 12")


def test_what_no_metamodel_declares_is_told(orchard, told):
    assert told(orchard, "LOST: the metamodel has no such feature: season autumn of Context 'orchard place'")


def test_a_coordinate_system_that_is_not_given_is_that_of_2015(orchard, mission, context, told):
    assert (mission.crs, context.crs) == ("wgs84", "wgs84")
    assert len(told(orchard, "crs is not given: wgs84")) == 2


def test_every_finding_knows_its_line(orchard, flyaq):
    lines = {file.name: file.read_text().count("\n") for file in flyaq.iterdir() if file.is_file()}
    for finding in orchard.findings:
        assert 0 < finding.place.line <= lines[finding.place.file.rpartition("/")[2]]


@pytest.mark.parametrize(("task", "first"), [(0, "shell"), (3, "points")])
def test_an_initial_position_that_is_not_given_is_the_first_vertex(
    migrated, model, told, changed, task, first
):
    found = migrated(changed(lambda text: text["tasks"][task].pop("initialPosition")))
    made = model(found, "mission.xmi").tasks[task]
    vertex = getattr(made, first)[0]
    assert made.initialPosition is not vertex
    assert (made.initialPosition.latitude, made.initialPosition.longitude) == (
        vertex.latitude,
        vertex.longitude,
    )
    assert told(found, f"DEFAULTED: initialPosition is not given: the first of {first} is taken")


@pytest.mark.parametrize("altitude", [None, 0, "0.0"])
def test_a_point_without_an_altitude_is_flown_to_at_2_m_as_in_2015(migrated, model, told, changed, altitude):
    found = migrated(changed(lambda text: text["tasks"][2]["point"][0].update({"altitude": altitude})))
    assert model(found, "mission.xmi").tasks[2].point.altitude == 2.0
    assert told(found, "DEFAULTED: no height is known where it is missing or 0; the 2015 platform")


def test_a_point_that_is_not_on_the_earth_keeps_a_border_as_it_was(migrated, model, flyaq, written):
    text = json.loads((flyaq / "orchard-context.json").read_text())
    shell = text["obstacles"][0]["shell"]
    shell[0]["latitude"] = 4600
    found = model(migrated(written("odd.json", json.dumps(text))), "context.xmi")
    assert [vertex.latitude for vertex in found.obstacles[0].shell] == [4600.0, 46.004]


def test_an_obstacle_whose_border_crosses_itself_becomes_the_hull_of_it(
    migrated, model, told, flyaq, written
):
    text = json.loads((flyaq / "orchard-context.json").read_text())
    bow = ((46.0, 11.0), (46.001, 11.001), (46.0, 11.001), (46.001, 11.0))
    for area in (*text["obstacles"], *text["noFlyAreas"]):
        area["shell"] = [{"latitude": north, "longitude": east} for north, east in bow]
    text["emergencyAreas"] = [{"name": "lawn", "shell": text["obstacles"][0]["shell"]}]
    found = migrated(written("bow.json", json.dumps(text)))
    place = model(found, "context.xmi")
    for area in (*place.obstacles, *place.forbiddenAreas):
        assert {(each.latitude, each.longitude) for each in area.shell} == set(bow)
        assert LinearRing([(each.latitude, each.longitude) for each in area.shell]).is_simple
    assert [(each.latitude, each.longitude) for each in place.emergencyAreas[0].shell] == list(bow)
    assert len(told(found, "the border crosses or touches itself, so the hull of its vertices is taken")) == 3


@pytest.mark.parametrize("latitude", ["NaN", "1e308", "-Infinity", "4600"])
def test_vertices_that_are_not_on_the_earth_are_kept_as_they_are(migrated, model, flyaq, written, latitude):
    text = json.loads((flyaq / "orchard-context.json").read_text())
    for vertex in text["obstacles"][0]["shell"]:
        vertex["latitude"] = latitude
    found = migrated(written("odd.json", json.dumps(text)))
    assert len(model(found, "context.xmi").obstacles[0].shell) == 1
