"""From models to a scene."""

from __future__ import annotations

from math import hypot, inf

import pytest

from mmrs_core.diagnostics import Place
from mmrs_core.errors import InvalidModelError
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.element import Element
from mmrs_core.languages.grounding.scenes import area_of, ground, ground_of, part_of, robot_type_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import core_registry
from mmrs_core.scene import AreaUse, Part, Policy


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    from mmrs_core.languages.registry import MetamodelSource, registry_with

    ecore = tmp_path_factory.mktemp("metamodels") / "visit.ecore"
    ecore.write_text(
        """<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="visit" nsURI="urn:test:visit" nsPrefix="visit">
  <eClassifiers xsi:type="ecore:EClass" name="Buoy" eSuperTypes="urn:mmrs:context:1.0#//ContextElement">
    <eStructuralFeatures xsi:type="ecore:EReference" name="at"
        eType="ecore:EClass urn:mmrs:mission:1.0#//Coordinate" containment="true"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Visit" eSuperTypes="urn:mmrs:mission:1.0#//PointTask">
    <eStructuralFeatures xsi:type="ecore:EReference" name="buoy" eType="#//Buoy"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="via"
        eType="ecore:EClass urn:mmrs:mission:1.0#//Coordinate"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Sweep" eSuperTypes="urn:mmrs:mission:1.0#//PolygonTask"/>
</ecore:EPackage>
"""
    )
    return registry_with([MetamodelSource("urn:test:visit", ecore)])


def geo(latitude=42.37, longitude=13.35, **heights) -> Element:
    return mission.GeoCoordinate(latitude=latitude, longitude=longitude, **heights)


def relative(x=0.0, y=0.0, z=0.0, **more) -> Element:
    return mission.RelativeCoordinate(x=x, y=y, z=z, **more)


def quad(**more) -> Element:
    features = {
        "name": "quad",
        "size": robot.Size(width=1.0, length=2.0, height=2.0, weight=1.5),
        "movementCapabilities": [
            robot.MovementCapability(
                payloadWeight=0.0, lifetime=1200.0, speed=robot.Interval(min=1.0, max=10.0)
            )
        ],
    }
    return robot.Robot(**{**features, **more})


def simple(registry, *homes, point=None, **features) -> Element:
    robots = [mission.Robot(name=f"r{n}", type="quad", home=home) for n, home in enumerate(homes)]
    visit = registry.create("urn:test:visit", "Visit", name="visit", point=point or relative(1.0, 2.0, 3.0))
    return mission.Mission(name="m", team=mission.Team(robots=robots), **{"tasks": [visit], **features})


def scene(made, place=None, **types):
    return ground(ModelSet(made, place, types or {"quad": quad()}, ()))


def point_of(made, place=None):
    return scene(made, place).tasks[0].part.attributes["point"]


def faults(made, place=None, **types) -> list[str]:
    with pytest.raises(InvalidModelError) as caught:
        scene(made, place, **types)
    return [fault.message for fault in caught.value.diagnostics]


def test_home_of_the_first_robot_is_the_origin_where_the_mission_names_none(registry):
    found = scene(simple(registry, geo(altitude=700.0), geo(42.371, altitude=710.0)))
    assert found.robots[0].home == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert found.robots[1].home == pytest.approx((0.0, 111.08, 10.0), abs=0.01)
    assert (found.frame.latitude, found.frame.altitude) == (42.37, 700.0)


def test_origin_of_the_mission_goes_before_homes(registry):
    found = scene(simple(registry, geo(42.371), origin=geo()))
    assert found.robots[0].home == pytest.approx((0.0, 111.08, 0.0), abs=0.01)


def test_coordinate_without_height_is_at_the_height_of_the_origin(registry):
    assert point_of(simple(registry, geo(altitude=700.0), point=geo()))[2] == 0.0


@pytest.mark.parametrize("reference", ["ELLIPSOID", "MSL"])
def test_altitude_is_counted_from_that_of_the_origin(registry, reference):
    made = simple(registry, geo(altitude=700.0), point=geo(altitude=725.5), altitudeReference=reference)
    assert point_of(made)[2] == 25.5


def test_altitude_above_the_origin_is_taken_as_it_is(registry):
    made = simple(registry, geo(), point=geo(altitude=25.5), altitudeReference="ORIGIN")
    assert point_of(made)[2] == 25.5
    assert scene(made).frame.altitude == 0.0


def test_depth_is_counted_from_the_surface(registry):
    place = context.Context(surfaceHeight=4.0)
    assert point_of(simple(registry, geo(), point=geo(depth=10.0)), place)[2] == -6.0


def test_altitude_needs_an_origin_with_one(registry):
    assert "the origin has none" in faults(simple(registry, geo(), point=geo(altitude=5.0)))[0]


def test_altitude_and_depth_together_are_refused(registry):
    made = simple(registry, geo(altitude=0.0), point=geo(altitude=5.0, depth=5.0))
    assert "both an altitude and a depth" in faults(made)[0]


def test_origin_above_itself_is_refused(registry):
    assert "must be 0" in faults(simple(registry, geo(altitude=3.0), altitudeReference="ORIGIN"))[0]


def test_origin_at_a_depth_that_contradicts_the_surface_is_refused(registry):
    assert "depth of 3 m" in faults(simple(registry, geo(depth=3.0)))[0]


def test_relative_coordinates_count_from_the_origin(registry):
    assert point_of(simple(registry, geo(altitude=700.0))) == (1.0, 2.0, 3.0)


def test_relative_coordinates_count_from_their_reference_through_a_chain(registry):
    first = geo(altitude=700.0)
    second = relative(10.0, 0.0, 1.0, reference=first)
    assert point_of(simple(registry, first, second, point=relative(1, 1, 1, reference=second))) == (11, 1, 2)


def test_relative_coordinates_of_a_context_count_from_its_own_origin(registry):
    corners = [relative(0, 0), relative(10, 0), relative(10, 10)]
    place = context.Context(origin=geo(42.371), forbiddenAreas=[context.Area(shell=corners)])
    area = scene(simple(registry, geo()), place).areas[0]
    assert area.shell[2] == pytest.approx((10.0, 121.08), abs=0.01)


def test_origin_of_a_context_may_count_from_that_of_the_mission(registry):
    corners = [relative(0, 0), relative(10, 0), relative(10, 10)]
    place = context.Context(origin=relative(100, 0, 7), obstacles=[context.Obstacle(shell=corners)])
    assert scene(simple(registry, geo()), place).areas[0].shell[0] == (100.0, 0.0)


def test_relative_coordinates_in_a_circle_are_refused(registry):
    one, two = relative(1.0), relative(2.0)
    one.reference, two.reference = two, one
    found = faults(simple(registry, geo(), one, point=two))
    assert "circle" in found[0]


def test_coordinate_beside_a_circle_says_what_it_counts_from(registry):
    one, two = relative(1.0), relative(2.0)
    one.reference, two.reference = two, two
    found = faults(simple(registry, geo(), one, point=two))
    assert sorted("circle" in each for each in found) == [False, True]


def test_relative_origin_makes_a_local_mission(registry):
    found = scene(simple(registry, relative(5.0, 6.0), origin=relative()))
    assert found.frame.is_local
    assert found.robots[0].home == (5.0, 6.0, 0.0)


def test_relative_home_alone_counts_from_the_origin_of_a_local_mission(registry):
    found = scene(simple(registry, relative(5.0, 6.0)))
    assert found.frame.is_local
    assert found.robots[0].home == (5.0, 6.0, 0.0)


def test_relative_origin_elsewhere_than_at_the_origin_is_refused(registry):
    assert "x = y = z = 0" in faults(simple(registry, relative(), origin=relative(1.0)))[0]


def test_geographic_coordinates_in_a_local_mission_are_refused(registry):
    assert "local one" in faults(simple(registry, relative(), point=geo()))[0]


def test_unknown_crs_is_refused(registry):
    assert "EPSG:1" in faults(simple(registry, geo(), crs="EPSG:1"))[0]


def test_context_in_another_crs_lands_where_the_mission_sees_it(registry):
    # ED50 to WGS 84: the datum shift moves the same numbers by more than 100 m
    corners = [geo(42.37, 13.35), geo(42.371, 13.35), geo(42.371, 13.351)]
    place = context.Context(crs="EPSG:4230", forbiddenAreas=[context.Area(shell=corners)])
    shifted = scene(simple(registry, geo()), place).areas[0].shell[0]
    assert 80 < hypot(*shifted) < 250


def test_latitude_beyond_the_pole_is_refused(registry):
    assert "-90 to 90" in faults(simple(registry, geo(), point=geo(91.0)))[0]


def test_coordinate_that_cannot_be_projected_is_refused_by_name(registry):
    found = faults(simple(registry, geo(0.0, 0.0), point=geo(0.0, 90.0)))
    assert found[0].startswith("/tasks[0]/point cannot be placed")


def test_all_faults_are_reported_at_once(registry):
    made = simple(registry, geo(), geo(91.0))
    made.team.robots[1].type = "nobody"
    found = faults(made)
    assert len(found) == 2
    assert any("-90 to 90" in each for each in found)


def test_unknown_robot_type_is_refused_with_the_known_ones(registry):
    made = simple(registry, geo())
    made.team.robots[0].type = "Quad"
    with pytest.raises(InvalidModelError) as caught:
        scene(made)
    assert caught.value.diagnostics[0].hint == "known are: quad"


def test_missing_values_are_refused_before_they_are_missed(registry):
    made = simple(registry, geo())
    made.team.robots[0].home = None
    made.tasks[0].point = mission.GeoCoordinate(latitude=1.0)
    found = faults(made)
    assert "/team/robots[0] has 0 home, 1 are needed" in found
    assert "/tasks[0]/point has 0 longitude, 1 are needed" in found


def test_clearance_is_half_the_diagonal_and_the_position_error(registry):
    found = scene(simple(registry, geo(), positionError=0.5)).robots[0]
    assert found.type.half_diagonal == 1.5
    assert found.clearance == 2.0


def test_robot_carries_what_the_mission_says_of_it(registry):
    made = simple(registry, geo())
    made.team.robots[0].payload = 0.3
    made.team.robots[0].returnHome = False
    made.team.robots[0].travelMode = "SAFE"
    found = scene(made).robots[0]
    assert (found.payload, found.return_home, found.travel_mode, found.kind) == (0.3, False, "SAFE", "")
    assert found.kinematics is None


def test_elements_without_a_name_get_a_stable_one(registry):
    made = simple(registry, geo(), geo())
    made.tasks = [mission.Fork(), mission.Join(name="tasks[2]"), mission.Fork()]
    made.team.robots[1].name = None
    found = scene(made)
    assert [task.name for task in found.tasks] == ["tasks[0]", "tasks[2]", "tasks[2] (2)"]
    assert [each.name for each in found.robots] == ["r0", "robots[1]"]


def test_dependencies_name_the_tasks(registry):
    made = simple(registry, geo())
    fork = mission.Fork()
    made.tasks.append(fork)
    made.taskDependencies = [mission.TaskDependency(from_=fork, to=made.tasks[0], condition="dry")]
    found = scene(made).dependencies[0]
    assert (found.before, found.after, found.condition) == ("tasks[1]", "visit", "dry")


def test_dependency_on_a_task_of_nobody_is_refused(registry):
    made = simple(registry, geo())
    made.taskDependencies = [mission.TaskDependency(from_=mission.Fork(), to=made.tasks[0])]
    assert "no task of the mission" in faults(made)[0]


def test_task_carries_its_wishes(registry):
    made = simple(registry, geo())
    visit = made.tasks[0]
    visit.robotsWanted, visit.priority, visit.deadline, visit.maxDuration = 2, 3, 60.0, 30.0
    visit.earliestStart, visit.requiredDevices, visit.requiredActions = 10.0, ["cam"], ["TakePicture"]
    found = scene(made).tasks[0]
    assert (found.wanted, found.priority, found.earliest, found.deadline, found.longest) == (2, 3, 10, 60, 30)
    assert (found.devices, found.actions) == (("cam",), ("TakePicture",))


def test_areas_keep_their_use_heights_and_distances(registry):
    def corners():
        return [relative(0, 0), relative(10, 0), relative(10, 10)]

    place = context.Context(
        forbiddenAreas=[context.Area(name="field", shell=corners(), safetyDistance=5.0)],
        obstacles=[context.Obstacle(shell=corners(), maxHeight=12.0)],
        emergencyAreas=[context.Area(shell=corners())],
    )
    found = scene(simple(registry, geo()), place).areas
    assert [each.name for each in found] == ["field", "obstacles[0]", "emergencyAreas[0]"]
    assert [each.use for each in found] == [AreaUse.FORBIDDEN, AreaUse.OBSTACLE, AreaUse.EMERGENCY]
    assert [(each.low, each.high) for each in found] == [(-inf, inf), (-inf, 12.0), (-inf, inf)]
    assert found[0].safety_distance == 5.0


def test_rings_lose_vertices_that_only_repeat(registry):
    corners = [relative(0, 0), relative(0, 0), relative(10, 0), relative(10, 10), relative(0, 0)]
    place = context.Context(forbiddenAreas=[context.Area(shell=corners)])
    area = scene(simple(registry, geo()), place).areas[0]
    assert area.shell == ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0))
    assert area.part.attributes["shell"] == ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0))


def test_holes_are_parts_with_grounded_points(registry):
    corners = [relative(0, 0), relative(90, 0), relative(90, 90)]
    hole = mission.Ring(points=[relative(60, 10), relative(80, 10), relative(80, 30)])
    sweep = registry.create(
        "urn:test:visit", "Sweep", shell=corners, holes=[hole], initialPosition=relative(0, 0)
    )
    (found,) = scene(simple(registry, geo(), tasks=[sweep])).tasks[0].part.attributes["holes"]
    assert isinstance(found, Part)
    assert found.attributes["points"] == ((60.0, 10.0, 0.0), (80.0, 10.0, 0.0), (80.0, 30.0, 0.0))


def test_references_become_positions_or_names(registry):
    made = simple(registry, geo())
    buoy = registry.create("urn:test:visit", "Buoy", name="B7", at=relative(5, 5))
    made.tasks[0].buoy, made.tasks[0].via = buoy, buoy.at
    found = scene(made, context.Context(elements=[buoy]))
    assert found.tasks[0].part.attributes["buoy"] == "B7"
    assert found.tasks[0].part.attributes["via"] == (5.0, 5.0, 0.0)
    assert found.elements[0].attributes["at"] == (5.0, 5.0, 0.0)


def test_part_carries_its_ancestry_most_specific_first(registry):
    found = scene(simple(registry, geo())).tasks[0].part
    assert found.metaclasses[:2] == (("urn:test:visit", "Visit"), ("urn:mmrs:mission:1.0", "PointTask"))
    assert found.place == Place(path="/tasks[0]")


def test_environment_holds_only_what_is_known(registry):
    place = context.Context(environment=context.Environment(windSpeed=3.0))
    assert scene(simple(registry, geo()), place).environment == {"windSpeed": 3.0}


def test_mission_figures_reach_the_scene(registry):
    made = simple(registry, geo(), reserve=0.0, transitAltitude=30.0, minimumSeparation=5.0)
    made.acceptedUnknowns = ["clearance"]
    made.policies = [robot.Policy(event="LINK_LOST", response="RETURN", after=5.0)]
    found = scene(made)
    assert (found.reserve, found.transit_altitude, found.minimum_separation) == (0.0, 30.0, 5.0)
    assert found.accepted_unknowns == ("clearance",)
    assert found.policies == (Policy("LINK_LOST", "RETURN", 5.0),)


def test_robot_type_sorts_capabilities_and_converts_batteries():
    made = quad(
        maxPayload=1.0,
        batteries=[robot.Battery(capacity=5000.0, voltage=22.2, rechargeTime=600.0)],
        movementCapabilities=[
            robot.MovementCapability(payloadWeight=kg, lifetime=900.0, speed=robot.Interval(min=0.0, max=8.0))
            for kg in (1.0, 0.5)
        ],
        devices=[
            robot.Device(
                id="cam",
                properties=[robot.Property(name="focal.length", value="8.8")],
                supportedActions=[
                    robot.SupportedAction(
                        name="TakePicture", duration=1.5, parameters=[robot.Parameter(key="zoom")]
                    )
                ],
            )
        ],
    )
    found = robot_type_of(made)
    assert [each.payload for each in found.capabilities] == [0.5, 1.0]
    assert found.batteries[0].energy == pytest.approx(5.0 * 22.2 * 3600)
    action = found.devices["cam"].actions["TakePicture"]
    assert (action.duration, action.parameters) == (1.5, ("zoom",))
    assert found.devices["cam"].properties == {"focal.length": "8.8"}


@pytest.mark.parametrize("feature", ["size", "movementCapabilities"])
def test_robot_type_without_what_planning_needs_is_refused(feature):
    made = quad()
    setattr(made, feature, None)
    with pytest.raises(InvalidModelError, match=feature):
        robot_type_of(made)


def test_area_outside_a_context_has_no_use():
    lonely = context.Area(shell=[])
    with pytest.raises(ValueError, match="neither a forbidden"):
        area_of(lonely, ground_of(None, None))


def test_part_of_a_coordinate_without_a_position_is_refused():
    lonely = mission.Robot(name="r", home=relative())
    with pytest.raises(ValueError, match="no position"):
        part_of(lonely, ground_of(None, None))


def test_ground_of_half_a_mission_places_what_it_can():
    made = mission.Mission(team=mission.Team(robots=[mission.Robot(home=geo()), mission.Robot()]))
    made.tasks = [core_registry().create("urn:mmrs:mission:1.0", "Fork")]
    assert list(ground_of(made, None).positions) == [made.team.robots[0].home]


def test_literal_that_does_not_exist_is_refused(registry):
    made = simple(registry, geo())
    made.team.robots[0].travelMode = "RECKLESS"
    assert faults(made) == ["/team/robots[0] has the travelMode 'RECKLESS', which is none"]


def test_context_is_laid_beside_a_behaviour(registry):
    home = behaviour.GeoCoordinate(latitude=42.37, longitude=13.35)
    made = behaviour.Behaviour(
        targets=[behaviour.RelativeCoordinate(x=3.0, y=4.0), home],
        robots=[behaviour.Robot(id="r1"), behaviour.Robot(id="r2", home=home)],
        surfaceHeight=2.0,
    )
    place = context.Context(origin=geo(42.371), surfaceHeight=9.0, forbiddenAreas=[])
    laid = ground_of(made, place)
    assert laid.positions[home] == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert laid.positions[made.targets[0]] == (3.0, 4.0, 0.0)
    assert laid.positions[place.origin] == pytest.approx((0.0, 111.08, 0.0), abs=0.01)
    assert laid.frame.surface == 2.0


@pytest.mark.parametrize("latitude", [-77.8, 0.0, 42.37, 69.6])
@pytest.mark.parametrize(("north", "east"), [(0.03, 0.0), (0.0, 0.05), (-0.02, 0.04)])
def test_distances_are_those_on_the_ellipsoid(registry, latitude, north, east):
    from pyproj import Geod

    far = geo(latitude + north, 13.35 + east)
    x, y, _ = point_of(simple(registry, geo(latitude, 13.35), point=far))
    *_, metres = Geod(ellps="WGS84").inv(13.35, latitude, 13.35 + east, latitude + north)
    assert hypot(x, y) == pytest.approx(metres, abs=0.02)
