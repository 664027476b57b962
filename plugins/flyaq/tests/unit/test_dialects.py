"""A dialect that nobody foresaw is another file, and no code."""

import pytest
from mmrs_flyaq.rules.mapping_file import read_mapping

from mmrs_core.errors import UnreadableError


@pytest.fixture
def voyage(migrated, dialects, registry):
    by = read_mapping(dialects / "harbour.toml", registry)
    return migrated(*(dialects / name for name in ("voyage.json", "tug.xmi", "chart.xmi")), by=by)


def test_an_invented_dialect_becomes_a_project(voyage):
    assert [str(output.path) for output in voyage.outputs] == [
        "robots/tug.xmi",
        "context.xmi",
        "behaviour.xmi",
    ]


def test_its_moves_become_those_of_the_core(voyage, model):
    (robot,) = model(voyage, "behaviour.xmi").robots
    assert [type(move).__name__ for move in robot.moves] == ["Start", "GoTo", "HoldPosition", "Stop"]
    assert (robot.moves[1].speed, robot.moves[2].duration) == (3.0, 120.0)
    assert [each.to.name for each in robot.moveTransitions] == [None, None, "made fast"]


def test_its_units_are_converted(voyage, model):
    tug = model(voyage, "tug.xmi")
    assert (tug.size.weight, tug.movementCapabilities[0].speed.max) == (30_000.0, pytest.approx(5.144))


def test_a_path_makes_what_is_missing_on_its_way(voyage, model):
    (hull,) = model(voyage, "tug.xmi").devices
    assert (hull.id, hull.properties[0].name, hull.properties[0].value) == ("hull", "draught", "1.8")


def test_constants_of_the_mapping_are_told(voyage, told):
    assert told(voyage, "DEFAULTED: size.height is 1.0 for all of this class: Hull")


@pytest.fixture
def meadow(dialects, registry):
    return read_mapping(dialects / "meadow.toml", registry)


@pytest.fixture
def harvest(migrated, dialects, meadow):
    return migrated(dialects / "harvest.json", by=meadow)


def test_places_that_are_attributes_of_their_owner_become_coordinates(harvest, model):
    one, two = model(harvest, "mission.xmi").team.robots
    assert [type(each.home).__name__ for each in (one, two)] == ["GeoCoordinate"] * 2
    assert (one.home.latitude, one.home.longitude) == (48.001, 9.001)
    look = model(harvest, "mission.xmi").tasks[0]
    assert (look.point.latitude, look.point.altitude) == (48.003, pytest.approx(30.48))


def test_a_place_that_is_half_given_gets_the_rest_and_that_is_told(harvest, model, told):
    assert model(harvest, "mission.xmi").team.robots[1].home.longitude == 0.0
    assert told(harvest, "DEFAULTED: lon is not given: 0.0: lon of Machine")


def test_elements_may_go_into_one_that_is_made_on_their_way(harvest, model):
    assert [each.name for each in model(harvest, "mission.xmi").team.robots] == ["lark", "lark_2"]


def test_an_element_that_is_not_given_may_be_made(harvest, model, told):
    position = model(harvest, "mission.xmi").tasks[1].initialPosition
    assert (position.latitude, position.longitude) == (48.0, 9.0)
    assert told(harvest, "DEFAULTED: gate is not given: GeoCoordinate (latitude 48.0; longitude 9.0)")


def test_a_factor_that_nobody_explains_is_told(harvest, told):
    assert told(harvest, "CHANGED: is multiplied by 0.3048: feet 100 of Look")


def test_places_that_are_only_referred_to_get_a_place_of_their_own(migrated, dialects, meadow, model):
    behaviour = model(migrated(dialects / "round.xmi", by=meadow), "behaviour.xmi")
    (robot,) = behaviour.robots
    assert list(behaviour.targets) == [robot.home, robot.moves[1].target]
    assert (robot.home.latitude, robot.moves[1].target.longitude) == (48.0, 9.002)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"home:GeoCoordinate.latitude", abs', '"home.latitude", abs', "'home.latitude': Coordinate is abst"),
        (', hoist = "targets" }', " }", "home of Robot contains no elements"),
        (
            'make = { to = "mission:GeoCoordinate"',
            'make = { to = "mission:Team"',
            "set: latitude: no feature of Team",
        ),
        ("latitude = 48.0", 'latitude = "north"', "gate: make: set: latitude: 'north': not a"),
        (
            'make = { to = "mission:GeoCoordinate", set = { latitude = 48.0, longitude = 9.0 } }',
            'make = { to = "mission:Team" }',
            "gate: make: to: Team is no Coordinate, which initialPosition takes",
        ),
        ("{ latitude = 48.0", "{ lat = 48.0", "gate: make: set: lat: no feature of GeoCoordinate"),
        (
            "mission:GeoCoordinate.longitude",
            "farm:GeoCoordinate.longitude",
            "'farm' is none of the languages",
        ),
    ],
)
def test_a_place_that_cannot_be_made_is_refused_with_its_line(written, dialects, registry, old, new, message):
    text = (dialects / "meadow.toml").read_text(encoding="utf-8")
    assert old in text
    line = text.partition(old)[0].count("\n") + 1
    with pytest.raises(UnreadableError, match=rf"m\.toml:{line}: ") as fault:
        read_mapping(written("m.toml", text.replace(old, new, 1)), registry)
    assert message in str(fault.value)
