import copy

import pytest

from mmrs_core.languages import behaviour, mission, robot
from mmrs_core.languages.element import (
    Element,
    container_of,
    containing_feature,
    contents,
    descendants,
    get,
    is_kind,
    is_set,
    metaclass_of,
    path_of,
    place_of,
)

ZOO = "urn:test:zoo"


def test_calling_an_interface_makes_an_element_of_it():
    move = behaviour.GoTo(name="g", distance=0.0)
    assert isinstance(move, behaviour.GoTo)
    assert isinstance(move, behaviour.Move)
    assert isinstance(move, Element)
    assert not isinstance(move, behaviour.Start)


def test_a_subclass_from_a_plug_in_is_an_instance_of_the_core_interface(everything):
    move = everything.create("urn:mmrs:multicopter:1.0", "GoTo", name="g")
    assert isinstance(move, behaviour.GoTo)
    assert metaclass_of(move).ancestry[:2] == (
        ("urn:mmrs:multicopter:1.0", "GoTo"),
        ("urn:mmrs:behaviour:1.0", "GoTo"),
    )


def test_two_metaclasses_of_one_name_are_told_apart():
    assert behaviour.Robot is not mission.Robot is not robot.Robot
    assert is_kind(mission.Robot(), "urn:mmrs:mission:1.0", "Robot")
    assert not is_kind(mission.Robot(), "urn:mmrs:robot:1.0", "Robot")


def test_an_abstract_class_cannot_be_made():
    with pytest.raises(ValueError, match=r"^Move: abstract"):
        behaviour.Move()


def test_a_misspelt_feature_is_refused_when_made_read_and_written():
    with pytest.raises(ValueError, match=r"^nmae: no feature of Mission; did you mean name\?"):
        mission.Mission(nmae="x")
    made = mission.Mission()
    with pytest.raises(AttributeError, match=r"^nmae: no feature of Mission; did you mean name\?"):
        made.nmae  # noqa: B018
    with pytest.raises(AttributeError):
        made.nmae = "x"


def test_an_unset_number_is_none_and_a_set_zero_is_zero():
    place = mission.GeoCoordinate(latitude=0.0)
    assert place.latitude == 0.0
    assert place.longitude is None
    assert is_set(place, "latitude")
    assert not is_set(place, "longitude")


def test_assigning_none_unsets():
    place = mission.GeoCoordinate(latitude=1.0, depth=2.0)
    place.latitude = None
    del place.depth
    assert not is_set(place, "latitude")
    assert place.depth is None


def test_an_unset_attribute_holds_its_default():
    made = mission.Mission()
    assert (made.crs, made.altitudeReference, made.reserve) == ("EPSG:4326", "ELLIPSOID", 0.2)
    assert not is_set(made, "crs")
    made.crs = "EPSG:4326"
    assert not is_set(made, "crs")
    made.crs = "EPSG:3857"
    assert is_set(made, "crs")


def test_none_for_a_primitive_with_a_default_is_the_default():
    made = mission.Mission(reserve=0.5)
    made.reserve = None
    assert made.reserve == 0.2


def test_a_keyword_is_reached_with_a_trailing_underscore():
    one, other = mission.Fork(name="a"), mission.Join(name="b")
    dependency = mission.TaskDependency(from_=one, to=other)
    assert dependency.from_ is one
    assert get(dependency, "from") is one


def test_any_word_can_be_the_name_of_a_feature(zoo, read_zoo):
    words = ("eClass", "eResource", "notify", "listeners", "dyn_inst", "_isset", "mro", "self", "cls")
    odd = zoo.create(ZOO, "Odd", **{word: f"{word}!" for word in words}, class_="c", _init___="i", href="h")
    assert [getattr(odd, word) for word in words] == [f"{word}!" for word in words]
    text = " ".join(f'{word}="{word}!"' for word in (*words, "class", "from", "href", "__init__"))
    model = read_zoo(f'<animals xsi:type="zoo:Odd" name="o" {text}/>')
    assert model.diagnostics == ()
    read = model.roots[0].animals[0]
    assert (read.class_, read.from_, read.href, read._init___) == ("class!", "from!", "href!", "__init__!")


def test_a_class_may_have_several_supertypes(zoo):
    otter = zoo.create(ZOO, "Otter", name="o", depth=3.0)
    assert is_kind(otter, ZOO, "Animal")
    assert is_kind(otter, ZOO, "Swimmer")
    assert [feature.name for feature in metaclass_of(otter).features][-1] == "depth"


def test_features_come_in_the_order_of_emf(everything):
    names = [feature.name for feature in everything.metaclass("urn:mmrs:multicopter:1.0", "GoTo").features]
    assert names[0] == "name"
    assert names[-1] == "trajectory"


def test_containers_contents_and_paths_agree():
    place = mission.GeoCoordinate(latitude=1.0, longitude=2.0)
    member = mission.Robot(name="r", home=place)
    team = mission.Team(robots=[mission.Robot(name="q"), member])
    made = mission.Mission(name="m", team=team)
    assert container_of(place) is member
    assert containing_feature(place).name == "home"
    assert list(contents(made)) == [team]
    assert list(descendants(made)) == [team, team.robots[0], member, place]
    assert path_of(place) == "/team/robots[1]/home"
    assert container_of(made) is None
    assert path_of(made) == "/"


def test_an_element_made_in_memory_has_a_place_without_a_file():
    place = place_of(mission.Fork(name="f"))
    assert (place.file, place.line, place.path) == ("", 0, "/")


def test_an_element_has_no_dictionary():
    assert not hasattr(mission.Fork(), "__dict__")


def test_copying_is_left_to_whoever_knows_where_the_copy_belongs():
    with pytest.raises(TypeError, match="Fork"):
        copy.deepcopy(mission.Fork(name="f"))


def test_an_unknown_class_or_package_is_an_error_with_the_nearest_name(core):
    with pytest.raises(
        ValueError, match=r"^Misson: no class of urn:mmrs:mission:1.0; did you mean Mission\?"
    ):
        core.metaclass("urn:mmrs:mission:1.0", "Misson")
    with pytest.raises(ValueError, match=r"^urn:mmrs:mision:1.0: no such metamodel; did you mean"):
        core.metaclass("urn:mmrs:mision:1.0", "Mission")
    with pytest.raises(AttributeError, match=r"did you mean Mission\?"):
        mission.Misson  # noqa: B018


def test_modules_list_what_they_offer():
    assert {"Mission", "Task", "NS_URI"} <= set(dir(mission))
    assert robot.TravelMode.names == ("SAFE", "NORMAL", "AGGRESSIVE")
