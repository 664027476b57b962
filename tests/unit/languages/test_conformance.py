import pytest

from mmrs_core.languages import behaviour, mission
from mmrs_core.languages.codes import CODES
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.model import Model

ZOO = "urn:test:zoo"


def faults(registry, *roots):
    return check_conformance(Model("memory", roots), registry)


def codes(registry, *roots):
    return [fault.code for fault in faults(registry, *roots)]


@pytest.fixture
def fine(core):
    """A mission without fault."""
    home = mission.GeoCoordinate(latitude=42.0, longitude=13.0)
    team = mission.Team(robots=[mission.Robot(name="r", type="t", home=home)])
    return mission.Mission(name="m", team=team, tasks=[mission.Fork(name="f")])


def test_a_model_without_fault_has_no_diagnostics(core, fine):
    assert codes(core, fine) == []


def test_a_missing_number_is_named_with_what_it_means(core, fine):
    fine.team.robots[0].home.latitude = None
    (fault,) = faults(core, fine)
    assert (fault.code, fault.message) == ("ECO001", "GeoCoordinate: latitude is missing")
    assert fault.hint == "geographic latitude, in degrees, north positive"
    assert fault.place.path == "/team/robots[0]/home"


def test_a_missing_element_and_an_empty_list_are_faults(core, fine):
    fine.team.robots[0].home = None
    fine.tasks = []
    assert [fault.message for fault in faults(core, fine)] == [
        "Mission 'm': tasks has none, needs at least 1",
        "Robot 'r': home is missing",
    ]


def test_an_attribute_with_a_default_is_never_missing(core, fine):
    assert not fine.crs.endswith("3857")
    fine.altitudeReference = None
    assert codes(core, fine) == []


def test_too_few_and_too_many_values_are_faults(core, zoo):
    area = mission.Ring(points=[mission.GeoCoordinate(latitude=1.0, longitude=2.0)])
    assert codes(core, area) == ["ECO002"]
    assert codes(zoo, zoo.create(ZOO, "Lion", name="l", weights=[1.0] * 3)) == []
    assert codes(zoo, zoo.create(ZOO, "Lion", name="l", weights=[1.0] * 4)) == ["ECO002"]


@pytest.mark.parametrize(
    ("features", "code"),
    [
        ({"teeth": "30"}, "ECO003"),
        ({"teeth": True}, "ECO003"),
        ({"teeth": 30.0}, "ECO003"),
        ({"teeth": 2**31}, "ECO003"),
        ({"cage": 128}, "ECO003"),
        ({"weight": "1"}, "ECO003"),
        ({"tags": ["a", 1]}, "ECO003"),
        ({"tame": 1}, "ECO003"),
        ({"mood": "is-calm"}, "ECO004"),
        ({"moods": ["ANGRY", "CALM", "SAD"]}, "ECO004"),
        ({"weight": float("nan")}, "ECO009"),
        ({"weights": [1.0, float("inf")]}, "ECO009"),
        ({"tags": ["a", "b", "a"]}, "ECO006"),
        ({"weight": 5}, None),
        ({"weights": [1.0, 1.0]}, None),
    ],
)
def test_values_are_checked_against_their_types(zoo, features, code):
    assert codes(zoo, zoo.create(ZOO, "Lion", name="l", **features)) == ([code] if code else [])


def test_a_wrong_literal_comes_with_the_nearest_one(core, fine):
    fine.altitudeReference = "ELIPSOID"
    (fault,) = faults(core, fine)
    assert fault.message == "Mission 'm': altitudeReference is 'ELIPSOID', not one of ELLIPSOID, MSL, ORIGIN"
    assert fault.hint == "did you mean ELLIPSOID?"


def test_an_element_of_the_wrong_class_is_a_fault(core, fine):
    fine.tasks.append(behaviour.Start(name="s"))
    assert codes(core, fine) == ["ECO005"]
    move = behaviour.GoTo(name="g", target="home", distance=0.0)
    assert codes(core, move) == ["ECO005"]


def test_a_reference_to_an_element_in_no_model_is_a_fault(core, fine):
    stray = mission.Fork(name="stray")
    fine.taskDependencies = [mission.TaskDependency(from_=fine.tasks[0], to=stray)]
    assert [fault.message for fault in faults(core, fine)] == [
        "TaskDependency: to refers to Fork 'stray', which stands in no model"
    ]


def test_an_element_that_two_contain_is_a_fault(core, fine):
    list.append(mission.Mission(name="thief").tasks, fine.tasks[0])
    assert codes(core, fine) == []
    thief = mission.Mission(name="thief", team=mission.Team(robots=[mission.Robot(type="t", home=None)]))
    thief.tasks.put(fine.tasks[0])
    assert "ECO007" in codes(core, thief)


def test_the_same_reference_twice_is_a_fault(zoo):
    lion = zoo.create(ZOO, "Lion", name="l")
    assert codes(zoo, zoo.create(ZOO, "Zoo", animals=[lion], favourites=[lion, lion])) == ["ECO006"]


def test_an_end_that_does_not_refer_back_is_a_fault(zoo):
    one, other = zoo.create(ZOO, "Lion", name="1"), zoo.create(ZOO, "Lion", name="2")
    one.mate = other
    type(other)._mmrs_slots["mateOf"].__delete__(other)
    assert codes(zoo, zoo.create(ZOO, "Zoo", animals=[one, other])) == ["ECO011"]


def test_an_identifier_used_twice_is_a_fault(zoo):
    keepers = [zoo.create(ZOO, "Keeper", badge="k") for _ in range(2)]
    assert codes(zoo, zoo.create(ZOO, "Zoo", keepers=keepers)) == ["ECO012"]


def test_values_that_are_no_values_at_all_are_faults_like_others(zoo):
    keeper, lion = zoo.create(ZOO, "Keeper", badge="k"), zoo.create(ZOO, "Lion", name="l", tags=["a"])
    keeper.badge, lion.tags[:] = [], [[], {}]
    faults = codes(zoo, zoo.create(ZOO, "Zoo", keepers=[keeper], animals=[lion]))
    assert set(faults) == {"ECO003"}
    assert len(faults) == 3


def test_an_element_of_another_registry_is_a_fault(core, zoo):
    assert codes(core, zoo.create(ZOO, "Zoo")) == ["ECO010"]


def test_what_reading_reported_is_not_reported_again(core):
    from mmrs_core.languages.reading import read_text

    text = b"""<m:GeoCoordinate xmlns:m="urn:mmrs:mission:1.0" latitude="north" longitude="1.0"/>"""
    model = read_text(text, "x.xmi", core)
    assert [fault.code for fault in model.diagnostics] == ["XMI005"]
    assert check_conformance(model, core) == ()


def test_every_code_has_a_meaning_and_every_meaning_a_code():
    import re
    from pathlib import Path

    import mmrs_flyaq

    from mmrs_core import grounding, languages

    folders = [Path(package.__file__).parent for package in (languages, grounding, mmrs_flyaq)]
    sources = [file for folder in folders for file in folder.rglob("*.py")]
    text = "".join(source.read_text() for source in sources if source.name != "codes.py")
    assert set(re.findall(r'"((?:XMI|ECO|PRJ|MIG|GND|FIL)\d{3})"', text)) == set(CODES) - {"LOG001"}
