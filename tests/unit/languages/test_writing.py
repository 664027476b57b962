import os
import stat
from dataclasses import replace

import pytest

from mmrs_core.languages import behaviour, mission, writing
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_xmi, write_model

ZOO = "urn:test:zoo"


def test_a_model_is_written_in_the_form_of_emf(core):
    place = behaviour.RelativeCoordinate(x=1.0, y=0.0)
    robot = behaviour.Robot(id="r", home=place, moves=[behaviour.GoTo(name="g", target=place, speed=0.5)])
    made = behaviour.Behaviour(name="b", robots=[robot], targets=[place])
    assert (
        to_xmi([made], core).decode()
        == """\
<?xml version="1.0" encoding="UTF-8"?>
<behaviour:Behaviour xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" \
xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:behaviour="urn:mmrs:behaviour:1.0" name="b">
  <robots id="r" home="//@targets.0">
    <moves xsi:type="behaviour:GoTo" name="g" target="//@targets.0" speed="0.5"/>
  </robots>
  <targets xsi:type="behaviour:RelativeCoordinate" x="1.0" y="0.0"/>
</behaviour:Behaviour>
"""
    )


def test_a_type_is_written_only_where_it_is_needed(core):
    text = to_xmi([mission.Mission(team=mission.Team(robots=[mission.Robot(type="t")]))], core)
    assert b"xsi" not in text


def test_several_roots_are_wrapped(zoo):
    lions = [zoo.create(ZOO, "Lion", name=name) for name in "ab"]
    lions[0].mate = lions[1]
    text = to_xmi(lions, zoo)
    assert b'<zoo:Lion name="a" mate="/1"/>' in text
    again = read_text(text, "again", zoo)
    assert again.diagnostics == ()
    assert again.roots[0].mate is again.roots[1]


def test_no_root_at_all_is_a_document_too(zoo):
    assert read_text(to_xmi([], zoo), "none", zoo).roots == ()


def test_the_schema_location_says_where_the_used_metamodels_lie(everything):
    land = everything.create("urn:mmrs:multicopter:1.0", "Land", name="l")
    robot = behaviour.Robot(id="r", moves=[land])
    places = {
        "urn:mmrs:behaviour:1.0": "../m/behaviour.ecore",
        "urn:mmrs:multicopter:1.0": "../m/multicopter.ecore",
        "urn:mmrs:auv:1.1": "../m/auv.ecore",
    }
    text = to_xmi([behaviour.Behaviour(robots=[robot])], everything, schema_location=places).decode()
    located = "urn:mmrs:behaviour:1.0 ../m/behaviour.ecore urn:mmrs:multicopter:1.0 ../m/multicopter.ecore"
    assert f'xsi:schemaLocation="{located}"' in text


def test_two_packages_of_one_prefix_are_told_apart(core):
    from mmrs_core.languages.registry import Registry

    registry = Registry(replace(package, prefix="same") for package in core.everything)
    roots = [mission.Fork(name="f"), behaviour.Start(name="s")]
    text = to_xmi(roots, registry)
    assert b"<same:Fork" in text
    assert b"<same_1:Start" in text
    again = read_text(text, "again", registry)
    assert isinstance(again.roots[1], behaviour.Start)


@pytest.mark.parametrize(
    "text", ["<&>\"'", "a\nb\tc\rd", "  x  ", "ä€😀", "]]>", "", "{{7*7}}", "\x85\u2028"]
)
def test_every_text_that_xml_can_hold_survives(zoo, text):
    lion = zoo.create(ZOO, "Lion", name=text, tags=[text], motto=text)
    again = read_text(to_xmi([lion], zoo), "again", zoo).roots[0]
    assert (again.name, again.motto) == (text, text)
    assert again.tags == [text]


@pytest.mark.parametrize("text", ["\x00", "a\x1b", "\ud800", "\uffff"])
def test_what_xml_cannot_hold_is_refused_with_its_place(zoo, text):
    zoo_ = zoo.create(ZOO, "Zoo", animals=[zoo.create(ZOO, "Lion", tags=[text])])
    with pytest.raises(ValueError, match=r"^/animals\[0\]: tags: holds U\+"):
        to_xmi([zoo_], zoo)


@pytest.mark.parametrize(
    "features",
    [{"mood": "is-calm"}, {"mood": "NOPE"}, {"teeth": "5"}, {"teeth": True}, {"weight": "1"}, {"name": 5}],
)
def test_a_value_of_the_wrong_type_is_refused(zoo, features):
    with pytest.raises(ValueError, match=rf"^/: {next(iter(features))}: "):
        to_xmi([zoo.create(ZOO, "Lion", **features)], zoo)


def test_a_reference_to_an_element_in_no_file_is_refused(zoo):
    stray = zoo.create(ZOO, "Lion", name="stray")
    with pytest.raises(ValueError, match=r"^/: star: refers to <Lion 'stray' at />, which stands in no file"):
        to_xmi([zoo.create(ZOO, "Zoo", star=stray)], zoo)


def test_writing_is_all_or_nothing(core, tmp_path, monkeypatch):
    path = tmp_path / "m.xmi"
    path.write_text("before")

    def full(handle):
        raise OSError(28, "no space left on device")

    monkeypatch.setattr(writing.os, "fsync", full)
    with pytest.raises(OSError, match="no space"):
        write_model([mission.Mission(name="m")], path, core)
    assert path.read_text() == "before"
    assert [file.name for file in tmp_path.iterdir()] == ["m.xmi"]


def test_nothing_is_written_of_a_model_that_cannot_be_written(core, tmp_path):
    with pytest.raises(ValueError, match="name"):
        write_model([mission.Mission(name=5)], tmp_path / "m.xmi", core)
    assert list(tmp_path.iterdir()) == []


def test_a_written_file_has_ordinary_permissions_and_keeps_those_it_had(core, tmp_path):
    path = tmp_path / "m.xmi"
    mask = os.umask(0o022)
    try:
        write_model([mission.Mission()], path, core)
    finally:
        os.umask(mask)
    assert stat.S_IMODE(path.stat().st_mode) == 0o644
    path.chmod(0o600)
    write_model([mission.Mission()], path, core)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_symbolic_link_stays_one(core, tmp_path):
    (tmp_path / "real.xmi").write_text("before")
    (tmp_path / "link.xmi").symlink_to("real.xmi")
    write_model([mission.Mission(name="m")], tmp_path / "link.xmi", core)
    assert (tmp_path / "link.xmi").is_symlink()
    assert 'name="m"' in (tmp_path / "real.xmi").read_text()
