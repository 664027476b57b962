"""Nothing follows from a value that cannot be read: it is reported, and no constraint takes its default."""

from pathlib import Path

import pytest

from mmrs_core.diagnostics import Severity
from mmrs_core.languages.element import descendants
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import to_json
from mmrs_core.pipeline import check_models, read_models

EXAMPLES = Path(__file__).parents[4] / "examples"
PARK = EXAMPLES / "carbon-dioxide"
DAM = EXAMPLES / "mixed-team"
POOL = EXAMPLES / "pool"
QUAD = "robots/quad-650.xmi"


def faults(folder, contributions, **changes):
    """Return the faults of a project some of whose files say something else, by (code, message)."""
    unsaved = {(folder / name).resolve(): text.encode() for name, text in changes.items()}
    models, found = read_models(folder, contributions, unsaved=unsaved)
    every = (*found, *check_models(models, contributions))
    return [(each.code, each.message, each.hint) for each in every if each.severity is not Severity.NOTE]


def changed(folder, name, old, new):
    text = (folder / name).read_text(encoding="utf-8")
    assert old in text
    return {name: text.replace(old, new, 1)}


@pytest.mark.parametrize(
    ("folder", "name", "old", "new", "code"),
    [
        (PARK, "mission.xmi", ' altitude="', ' altitude="high ', "XMI005"),
        (PARK, "mission.xmi", ' gridResolution="', ' gridResolution="fine ', "XMI005"),
        (PARK, "mission.xmi", 'event="BATTERY_LOW"', 'event="LOW_BATTERY"', "XMI005"),
        (PARK, "mission.xmi", '<home xsi:type="mission:GeoCoordinate"', "<home", "XMI003"),
        (PARK, "mission.xmi", '<tasks xsi:type="mission:Fork"', "<tasks", "XMI003"),
        (PARK, "mission.xmi", '<tasks xsi:type="mission:Fork"', '<tasks xsi:type="mission:Robot"', "XMI008"),
        (DAM, "mission.xmi", '<tasks xsi:type="mission:Fork" name="if', '<tasks name="if', "XMI003"),
        (
            DAM,
            "mission.xmi",
            '<tasks xsi:type="mission:Fork" name="if',
            '<tasks xsi:type="x" name="if',
            "XMI014",
        ),
        (DAM, "mission.xmi", '<tasks xsi:type="mission:Join" name="done', '<tasks name="done', "XMI003"),
        (DAM, "mission.xmi", "survey:RoadTask", "mission:Robot", "XMI008"),
        (PARK, QUAD, ' gps="true"', ' gps="yes"', "XMI005"),
        (PARK, QUAD, ' payloadWeight="', ' payloadWeight="kg ', "XMI005"),
        (POOL, "context.xmi", ' maxHeight="', ' maxHeight="m ', "XMI005"),
        (POOL, "robots/pool-auv.xmi", "<freedomDegree>SURGE<", "<freedomDegree>SURGING<", "XMI005"),
    ],
)
def test_what_cannot_be_read_is_the_only_fault(contributions, folder, name, old, new, code):
    found = faults(folder, contributions, **changed(folder, name, old, new))
    assert [each[0] for each in found] == [code]


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ('"BATTERY_LOW"', '"LOW_BATTERY"', "XMI005"),
        ('"gridResolution": ', '"gridResolution": "fine", "speed": ', "XMI005"),
        ('"$type": "mission:Fork",', "", "XMI003"),
        ('"$type": "mission:Fork",', '"$type": "mission:Robot",', "XMI008"),
        ('"$type": "survey:PhotoGridTask",', '"$type": "mission:Robot",', "XMI008"),
    ],
)
def test_what_cannot_be_read_of_json_is_the_only_fault(contributions, tmp_path, old, new, code):
    registry = contributions.languages
    text = to_json(read_model(PARK / "mission.xmi", registry).roots, registry).decode()
    assert old in text
    file = tmp_path / "mission.json"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    models, found = read_models(
        file, contributions, context=PARK / "context.xmi", robots=[PARK / "robots" / "quad-650.xmi"]
    )
    every = (*found, *check_models(models, contributions))
    assert [each.code for each in every if each.severity is not Severity.NOTE] == [code]


def test_a_reference_into_what_cannot_be_read_is_no_fault(contributions):
    text = (DAM / "mission.xmi").read_text(encoding="utf-8")
    assert "//@team/@robots.3/@home" in text
    robot = text.replace("<robots ", '<robots xsi:type="mission:Fork" ')
    assert {each[0] for each in faults(DAM, contributions, **{"mission.xmi": robot})} == {"XMI008"}


def test_a_misspelt_literal_comes_with_the_one_it_is_nearest_to(contributions):
    change = changed(PARK, "mission.xmi", 'event="BATTERY_LOW"', 'event="LOW_BATTERY"')
    ((_, message, hint),) = faults(PARK, contributions, **change)
    assert message.startswith("event: 'LOW_BATTERY': not a literal of")
    assert hint == "did you mean BATTERY_LOW?"


def test_a_fault_that_has_nothing_to_do_with_it_is_still_reported(contributions):
    text = changed(PARK, "mission.xmi", ' altitude="', ' altitude="high ')["mission.xmi"]
    text = text.replace('type="Quad 650"', 'type="Quad 651"', 1)
    found = faults(PARK, contributions, **{"mission.xmi": text})
    assert {"XMI005", "MML004"} <= {each[0] for each in found}


def test_elements_are_of_their_own_classes_again_after_the_check(contributions):
    change = changed(PARK, "mission.xmi", ' altitude="', ' altitude="high ')
    unsaved = {(PARK / "mission.xmi").resolve(): change["mission.xmi"].encode()}
    models, _ = read_models(PARK, contributions, unsaved=unsaved)
    before = [type(each) for each in descendants(models.mission)]
    check_models(models, contributions)
    assert [type(each) for each in descendants(models.mission)] == before
