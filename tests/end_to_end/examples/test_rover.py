"""What a rover does on ground that it shares with a drone that flies over it."""

import json
from dataclasses import replace
from itertools import pairwise

import pytest
import shapely

from mmrs_core import pipeline
from mmrs_core.cli.simulation import write_logs
from mmrs_core.contributions.checks import Status
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Serve

pytestmark = pytest.mark.together("examples")


@pytest.fixture(scope="module")
def yard(taken):
    return taken("drone-and-rover")


def shape_of(scene, name):
    """Return the element of a context by name, as a polygon."""
    (part,) = [each for each in scene.elements if each.attributes["name"] == name]
    return shapely.Polygon([point[:2] for point in part.attributes["shell"]])


def way_of(run, robot):
    return shapely.LineString([sample.position[:2] for sample in run.tracks[robot]])


@pytest.mark.parametrize("name", ["fire-water basin", "embankment"])
def test_the_drone_flies_over_what_the_rover_goes_round(yard, name):
    run, shape = yard.run, shape_of(yard.scene, name)
    rover = yard.scene.robot("Badger")
    assert way_of(run, "Kestrel").intersects(shape)
    # Half a diagonal of 0.78 m, 0.4 m of position error and 1.2 m to turn in.
    assert way_of(run, "Badger").distance(shape) >= rover.clearance - 1e-3 > 2.3


def test_the_rover_wades_through_water_that_is_shallow_enough(yard):
    assert way_of(yard.run, "Badger").intersects(shape_of(yard.scene, "puddle"))
    assert "puddle" not in {area.name for area in yard.scene.areas}


def test_only_the_rover_samples_and_only_the_drone_photographs(yard):
    done = {(action.name, robot.id) for robot in yard.program.robots for move in robot.moves
            for action in (*move.before, *move.after) if action.device}  # fmt: skip
    assert done == {("TakePicture", "Kestrel"), ("TriggerByDistance", "Kestrel"), ("SampleGas", "Badger")}


def test_a_task_in_the_air_is_refused_by_the_rover_with_the_reason(yard):
    assert yard.scene.refusals["overview", "Badger"] == "has no device for action 'TakePicture'"
    assert yard.scene.refusals["hot spot", "Badger"].startswith("stays on its level at 0.00 m")


def test_the_rover_never_leaves_the_ground(yard):
    assert {sample.position[2] for sample in yard.run.tracks["Badger"]} == {0.0}
    assert not any(move.kind in ("TakeOff", "Land") for move in program_of(yard, "Badger").moves)


def test_the_rover_stops_where_it_turns(yard):
    transitions = program_of(yard, "Badger").transitions
    assert not any(transition.fluid for transition in transitions.values())


def program_of(yard, name):
    (found,) = [robot for robot in yard.program.robots if robot.id == name]
    return found


def test_shunting_takes_time_in_the_simulation(yard):
    track = yard.run.tracks["Badger"]
    turns = [b.time - a.time for a, b in pairwise(track) if a.position == b.position]
    assert max(turns) > 3.0


def test_a_check_finds_a_way_through_the_basin(yard, contributions):
    (basin,) = [area for area in yard.place.areas if area.name == "fire-water basin"]
    flooded = replace(basin, shell=tuple((east, north + 20.0) for east, north in basin.shell))
    place = replace(yard.place, areas=(flooded,))
    violated = [
        verdict
        for verdict in pipeline.verify(yard.program, place, contributions)
        if verdict.status is Status.VIOLATED
    ]
    assert {(verdict.property, verdict.robot, verdict.area) for verdict in violated} == {
        ("clearance", "Badger", "fire-water basin")
    }


def test_a_place_under_deep_water_is_refused_by_name(folder_of, contributions, tmp_path):
    text = (folder_of("drone-and-rover") / "context.xmi").read_text(encoding="utf-8")
    place = tmp_path / "context.xmi"
    deeper = text.replace('waterDepth="0.1"', 'waterDepth="0.3"').replace('y="38.0"', 'y="90.0"')
    place.write_text(deeper, encoding="utf-8")
    models, _ = pipeline.valid_models(folder_of("drone-and-rover"), contributions, context=place)
    with pytest.raises(InfeasibleError) as raised:
        pipeline.expand(pipeline.ground(models), contributions)
    assert "Badger: point 4 comes 2.38 m too near to 'puddle'" in str(raised.value.reasons)


def test_the_rovers_plan_for_a_ground_station_has_no_take_off_and_fences_the_basin(yard, contributions):
    files = pipeline.render(yard.program, yard.place, "qgc-plan", contributions, allow_lossy=True)
    plans = {file.path: json.loads(file.content) for file in files if file.path.endswith(".plan")}
    rover, drone = plans["Badger.plan"], plans["Kestrel.plan"]
    assert (rover["mission"]["vehicleType"], drone["mission"]["vehicleType"]) == (10, 2)
    commands = {item["command"] for item in rover["mission"]["items"]}
    assert not commands & {20, 21, 22}
    assert {item["params"][6] for item in rover["mission"]["items"] if item["command"] == 16} == {0.0}
    assert (len(rover["geoFence"]["polygons"]), len(drone["geoFence"]["polygons"])) == (2, 0)


def test_the_rovers_controller_is_for_an_ardupilot_rover(yard, contributions):
    files = pipeline.render(yard.program, yard.place, "mavlink-python", contributions)
    (program,) = [file.content.decode() for file in files if file.path == "robot_Badger.py"]
    assert 'vehicle="rover"' in program
    assert "TakeOff" not in program


def test_the_simulation_logs_each_photo_also_those_by_distance(yard, contributions, tmp_path):
    write_logs(yard.run, yard.program, tmp_path, yard.place.types, contributions)
    entries = [json.loads(line) for line in (tmp_path / "Kestrel.blackbox.ndjson").read_text().splitlines()]
    photos = [each for each in entries if each["kind"] == "photo"]
    commanded = sum(record.label == "act" and record.robot == "Kestrel" for record in yard.run.records)
    planned = sum(
        len(step.stroke.spots)
        for each in yard.plan.robots
        for step in each.steps
        if each.robot == "Kestrel" and isinstance(step, Serve)
    )
    assert len(photos) == planned > commanded
    assert [each["index"] for each in photos] == [*range(len(photos))]
    times = [each["time"] for each in entries]
    assert times == sorted(times)
