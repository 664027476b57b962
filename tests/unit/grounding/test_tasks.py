"""Tasks of a scene, what depends on what, and what the mission says of all."""

from grounded import faults, geo, scene, simple

from mmrs_core.languages import mission, robot
from mmrs_core.scene import Policy


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
    assert "a task that is not in the mission" in faults(made)[0]


def test_task_carries_its_wishes(registry):
    made = simple(registry, geo())
    visit = made.tasks[0]
    visit.robotsWanted, visit.priority, visit.deadline, visit.maxDuration = 2, 3, 60.0, 30.0
    visit.earliestStart, visit.requiredDevices, visit.requiredActions = 10.0, ["cam"], ["TakePicture"]
    found = scene(made).tasks[0]
    assert (found.wanted, found.priority, found.earliest, found.deadline, found.longest) == (2, 3, 10, 60, 30)
    assert (found.devices, found.actions) == (("cam",), ("TakePicture",))


def test_mission_figures_reach_the_scene(registry):
    made = simple(registry, geo(), reserve=0.0, transitAltitude=30.0, minimumSeparation=5.0)
    made.acceptedUnknowns = ["clearance"]
    made.policies = [robot.Policy(event="LINK_LOST", response="RETURN", after=5.0)]
    found = scene(made)
    assert (found.reserve, found.transit_altitude, found.minimum_separation) == (0.0, 30.0, 5.0)
    assert found.accepted_unknowns == ("clearance",)
    assert found.policies == (Policy("LINK_LOST", "RETURN", 5.0),)


def test_all_faults_are_reported_at_once(registry):
    made = simple(registry, geo(), geo(91.0))
    made.team.robots[1].type = "nobody"
    found = faults(made)
    assert len(found) == 2
    assert any("-90 to 90" in each for each in found)


def test_missing_values_are_refused_before_they_are_missed(registry):
    made = simple(registry, geo())
    made.team.robots[0].home = None
    made.tasks[0].point = mission.GeoCoordinate(latitude=1.0)
    found = faults(made)
    assert "Robot 'r0' has no home" in found
    assert "GeoCoordinate tasks[0]/point has no longitude" in found
