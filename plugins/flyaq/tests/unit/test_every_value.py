"""Every value of a source stands in what is made of it, or in the report: counted by who knows no rules."""

import pytest
from mmrs_flyaq.rules.mapping_file import read_mapping
from source_values import missing, values_of


@pytest.fixture
def unsaid():
    """Return a function that gives the values of a file that a migration neither carried over nor told."""

    def find(file, migration):
        made = [output.element for output in migration.outputs]
        return missing(file, made, [finding.subject for finding in migration.findings])

    return find


@pytest.mark.parametrize(
    "name",
    [
        "orchard-mission.json",
        "orchard-context.json",
        "round.json",
        "round.xmi",
        "drones.json",
        "Heron.xmi",
        "workspace/Finch.xmi",
    ],
)
def test_no_value_of_flyaq_is_dropped_silently(migrated, flyaq, unsaid, name):
    assert unsaid(flyaq / name, migrated(flyaq / name)) == []


@pytest.mark.parametrize(
    ("name", "by"),
    [
        ("voyage.json", "harbour"),
        ("tug.xmi", "harbour"),
        ("chart.xmi", "harbour"),
        ("harvest.json", "meadow"),
        ("round.xmi", "meadow"),
    ],
)
def test_no_value_of_another_dialect_is_dropped_silently(migrated, dialects, registry, unsaid, name, by):
    found = migrated(dialects / name, by=read_mapping(dialects / f"{by}.toml", registry))
    assert unsaid(dialects / name, found) == []


def test_what_no_metamodel_knows_is_told_to_its_last_value(migrated, written, unsaid):
    deep = '{"a": {"b": [{"c": {"d": "deep"}}, {"c": {"d": 4.5}}], "name": "x"}, "name": "y"}'
    text = f'{{"eClass": "http://www.flyaq.it/context#//Context", "weather": [{deep}, {deep}]}}'
    file = written("odd.json", text)
    assert values_of(file)["deep"] == 2
    assert unsaid(file, migrated(file)) == []


def test_a_value_that_is_dropped_is_found(migrated, flyaq):
    found = migrated(flyaq / "Heron.xmi")
    made = [output.element for output in found.outputs]
    told = [finding.subject for finding in found.findings]
    assert missing(flyaq / "Heron.xmi", made, [line for line in told if "cellType" not in line]) == ["LiPo"]
