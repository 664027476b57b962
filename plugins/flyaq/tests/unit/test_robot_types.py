"""What becomes of the drones of 2015, which are types of robot."""

import pytest
from mmrs_flyaq.building.robot_types import RobotTypes

from mmrs_core.languages.writing import to_xmi

DRONE = (
    '<d:Drone xmlns:d="http://www.flyaq.it/drone" name="Tern"><size width="1"/>'
    '<flightPerf maxSpeed="9" {}/></d:Drone>'
)


@pytest.fixture
def heron(migrated, flyaq):
    return migrated(flyaq / "Heron.xmi")


@pytest.fixture
def type_of(heron, model):
    return model(heron, "Heron.xmi")


def test_flight_times_in_minutes_become_seconds(heron, type_of, told):
    assert [each.lifetime for each in type_of.movementCapabilities] == [25 * 60, 18 * 60]
    assert told(heron, "maxFlightTime 25") == [
        "CHANGED: flight times were minutes, and are seconds here: maxFlightTime 25 of FlightPerformance"
    ]


def test_what_a_drone_does_with_payload_becomes_a_second_capability(type_of):
    light, heavy = type_of.movementCapabilities
    assert (light.payloadWeight, heavy.payloadWeight, type_of.maxPayload) == (0.0, 1.0, 1.0)
    assert (heavy.speed.min, heavy.speed.max, heavy.maxClimbRate) == (1.0, 10.0, 3.0)


@pytest.mark.parametrize("figures", ["", 'maxPayload="0" maxFlightTimeWithMaxPayload="3"', 'maxPayload="2"'])
def test_without_figures_for_a_payload_there_is_one_capability(migrated, model, written, figures):
    found = model(migrated(written("Tern.xmi", DRONE.format(figures))), "Tern.xmi")
    assert len(found.movementCapabilities) == 1


def test_a_flight_time_with_a_payload_that_is_not_known_is_told(migrated, told, written):
    found = migrated(written("Tern.xmi", DRONE.format('maxFlightTimeWithMaxPayload="3"')))
    assert told(found, "WithMaxPayload") == [
        "LOST: means nothing without maxPayload: maxFlightTimeWithMaxPayload 3 of FlightPerformance"
    ]


def test_sizes_become_metres_and_propellers_millimetres(type_of):
    assert (type_of.size.width, type_of.size.height, type_of.size.propellerSize) == (0.6, 0.25, 250.0)


@pytest.mark.parametrize("propellers", ["", 'propellers="0"'])
def test_propellers_that_are_not_known_are_doubted_aloud(migrated, model, told, written, propellers):
    text = DRONE.format("").replace('width="1"', propellers)
    found = migrated(written("Tern.xmi", text))
    assert model(found, "Tern.xmi").size.propellers == 4
    assert told(found, "DEFAULTED: the number of propellers is not known, a quadcopter is assumed: 4")


def test_temperatures_become_an_interval(type_of):
    assert (type_of.operatingTemperature.min, type_of.operatingTemperature.max) == (-10.0, 40.0)


def test_an_omitted_launch_type_is_the_first_of_its_enumeration(heron, type_of, told):
    assert type_of.launchType == "VTOL"
    assert told(heron, "launchType is not given: VTOL")


def test_devices_keep_their_actions_parameters_and_properties(type_of):
    camera = next(device for device in type_of.devices if device.name == "camera")
    (action,) = camera.supportedActions
    assert (camera.id, action.name, action.parameters[0].key) == ("camera", "TakePicture", "zoom")
    assert (camera.properties[0].name, camera.properties[0].value) == ("sensor.width", "6.3")


def test_what_the_robot_language_lacks_is_told_with_its_values(heron, told):
    assert told(heron, "LOST: the robot language has no type of cells: cellType LiPo of Battery 'pack'")


def test_processors_and_voltages_are_kept_as_properties_and_told(heron, type_of, told):
    kept = {device.id: {each.name: each.value for each in device.properties} for device in type_of.devices}
    assert kept["autopilot"] == {"architecture": "arm", "frequency": "400"}
    assert kept["airframe"] == {"maxVoltage": "16.8"}
    assert told(heron, "is kept as a property that nothing here reads: maxVoltage 16.8 of Drone 'Heron'")
    assert told(heron, "of which nothing reads the properties: Processor 'autopilot'")


def test_a_device_of_the_name_of_a_processor_gets_a_number(migrated, model, written):
    text = DRONE.format("").replace("</d:Drone>", '<processors name="x"/><memory name="x"/></d:Drone>')
    found = model(migrated(written("Tern.xmi", text)), "Tern.xmi")
    assert [device.id for device in found.devices] == ["x", "x_2"]


def test_what_is_said_once_and_stands_twice_is_told_for_both(heron, told):
    assert told(heron, "movementCapabilities[1].speed.max from maxSpeed 10 of FlightPerformance")
    assert len(told(heron, "DEFAULTED: what is said once stands for further places, too")) == 5


def test_a_value_that_is_no_number_is_told_and_left_out(migrated, model, told, written):
    found = migrated(written("Tern.xmi", DRONE.format('maxAltitude="high"')))
    assert model(found, "Tern.xmi").maxAltitude is None
    assert told(found, "LOST: 'high': not a number: maxAltitude high of FlightPerformance")


def test_a_type_that_says_less_than_another_of_its_name_is_not_written(migrated, written):
    less = written("a.xmi", DRONE.format(""))
    more = written("b.xmi", DRONE.format('maxAltitude="90"'))
    for order in ((less, more), (more, less)):
        (output,) = migrated(*order).outputs
        assert output.element.maxAltitude == 90.0
        assert set(output.sources) == {str(less), str(more)}


@pytest.mark.parametrize(("name", "count"), [("cell", 1), ("fuse", 2)])
def test_a_type_says_less_if_its_devices_are_some_of_those_of_another(migrated, written, name, count):
    text = DRONE.format("").replace("</d:Drone>", "{}</d:Drone>")
    more = '<processors name="core"/><memory name="cell"/><dataEquipment name="camera"/>'
    files = (
        written("a.xmi", text.format(f'<processors name="core"/><memory name="{name}"/>')),
        written("b.xmi", text.format(more)),
    )
    assert len(migrated(*files).outputs) == count


def test_a_number_that_is_kept_as_a_text_may_be_written_in_another_way(migrated, written):
    text = DRONE.replace("name=", 'maxVoltage="{}" name=')
    files = (written("a.xmi", text.format("16", "")), written("b.xmi", text.format("16.0", "")))
    assert len(migrated(*files).outputs) == 1
    assert len(migrated(*files, written("c.xmi", text.format("17", ""))).outputs) == 2


def test_types_of_one_name_that_contradict_each_other_get_two_names(migrated, told, written):
    one = written("a.xmi", DRONE.format('maxAltitude="80"'))
    other = written("b.xmi", DRONE.format('maxAltitude="90"'))
    found = migrated(one, other)
    assert [output.element.name for output in found.outputs] == ["Tern", "Tern-2"]
    assert told(found, "has another 'Tern', so this one is called 'Tern-2'")


def test_the_same_file_gives_the_same_bytes(migrated, flyaq, registry):
    first, second = (migrated(flyaq / "Heron.xmi").outputs[0].element for _ in range(2))
    assert to_xmi((first,), registry) == to_xmi((second,), registry)


def test_the_option_for_an_unknown_type_can_be_pasted_into_a_shell():
    _, told = RobotTypes({}, {}).resolved("Bot X", "")
    assert told.endswith("state its type by --type 'Bot X=NAME'")
