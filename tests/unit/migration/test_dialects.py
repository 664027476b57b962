"""A dialect that nobody foresaw is another file, and no code."""

import pytest

from mmrs_core.migration.rules.mapping_file import read_mapping


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
