"""pyecore's ``ResourceSet`` reads and writes by our reader and writer."""

import re
from io import BytesIO, StringIO
from pathlib import Path
from shutil import copytree

import pytest
from pyecore.ecore import EObject
from pyecore.resources import URI, Resource, ResourceSet

from mmrs_core.errors import InvalidModelError, UnreadableError, UnsupportedError
from mmrs_core.languages.ecore_api.bridge import from_pyecore
from mmrs_core.languages.ecore_api.resources import resource_factory
from mmrs_core.languages.element import descendants
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import to_json, to_xmi, write_model

EXAMPLES = Path(__file__).parents[3] / "examples"
SOLAR = "urn:mmrs:solar:1.0"


class MemoryURI(URI):
    """A text that pyecore reads from and writes to, as a string or as bytes."""

    def __init__(self, text):
        super().__init__("memory.xmi")
        self.text = text

    def create_instream(self):
        self._stream = (StringIO if isinstance(self.text, str) else BytesIO)(self.text)
        return self._stream

    def create_outstream(self):
        self._stream = type(self._stream)()
        return self._stream

    def close_stream(self):
        self.text = self._stream.getvalue()


@pytest.fixture
def resources(everything):
    return resource_set(everything)


@pytest.fixture
def zoo_resources(zoo):
    return resource_set(zoo)


@pytest.fixture
def park(tmp_path):
    copytree(EXAMPLES / "solar-park", tmp_path / "park")
    return tmp_path / "park"


def resource_set(registry):
    made = ResourceSet()
    for ending in ("xmi", "json"):
        made.resource_factory[ending] = resource_factory(registry)
    return made


def test_examples_open_as_they_are_and_are_saved_as_our_writer_writes_them(tmp_path, everything):
    copytree(EXAMPLES, tmp_path, dirs_exist_ok=True)
    files = sorted(tmp_path.rglob("*.xmi"))
    assert len(files) > 25
    for file in files:
        resource = resource_set(everything).get_resource(URI(str(file)))
        assert all(isinstance(root, EObject) and root.eResource is resource for root in resource.contents)
        wanted = to_xmi(read_model(file, everything).roots, everything, file=file)
        resource.save()
        assert file.read_bytes() == wanted


def test_one_line_does_for_all_sets(monkeypatch, park, everything):
    monkeypatch.setattr(ResourceSet, "resource_factory", dict(ResourceSet.resource_factory))
    ResourceSet.resource_factory["xmi"] = resource_factory(everything)
    assert ResourceSet().get_resource(URI(str(park / "mission.xmi"))).contents[0].name == "Thermal inspection"


@pytest.mark.parametrize("first", ["mission.xmi", "context.xmi"])
def test_references_lead_into_the_other_resource_whichever_was_opened_first(first, park, resources):
    resources.get_resource(URI(str(park / first)))
    mission = resources.get_resource(URI(str(park / "mission.xmi")))
    context = resources.get_resource(URI(str(park / "context.xmi")))
    group = mission.contents[0].tasks[0].group
    assert group is context.contents[0].elements[0]
    assert group.eResource is context
    assert len(resources.resources) == 2


def test_what_pyecore_changes_is_saved_and_references_follow(park, resources, everything):
    mission = resources.get_resource(URI(str(park / "mission.xmi"))).contents[0]
    groups = resources.get_resource(URI(str(park / "context.xmi"))).contents[0].elements
    mission.name = "Changed"
    mission.tasks[1].delete()
    groups.insert(0, everything.epackage(SOLAR).getEClassifier("PanelGroup")(name="new", rows=3))
    for resource in (mission.eResource, groups[0].eResource):
        resource.save()
    again = read_model(park / "mission.xmi", everything)
    assert again.diagnostics == ()
    root = again.roots[0]
    assert (root.name, len(root.tasks), len(root.taskDependencies)) == ("Changed", 3, 3)
    assert root.tasks[0].group is again.linked[0].roots[0].elements[1]
    assert again.linked[0].roots[0].elements[0].rows == 3


def test_references_are_relative_to_where_the_model_is_saved(park, resources, everything):
    mission = resources.get_resource(URI(str(park / "mission.xmi")))
    (park / "deep").mkdir()
    for output in (URI(str(park / "deep" / "one.xmi")), str(park / "deep" / "two.xmi")):
        mission.save(output=output)
    (one, two) = ((park / "deep" / f"{name}.xmi").read_bytes() for name in ("one", "two"))
    assert one == two
    assert b'href="../context.xmi#//@elements.0"' in one
    again = resource_set(everything)
    again.resource_factory["xmi"] = resource_factory(everything, root=park)
    assert len(again.get_resource(URI(str(park / "deep" / "one.xmi"))).contents[0].tasks) == 4


def test_a_new_resource_is_written(tmp_path, resources, everything):
    kinds = everything.epackage("urn:mmrs:mission:1.0")
    made = resources.create_resource(URI(str(tmp_path / "new.xmi")))
    made.append(kinds.getEClassifier("Mission")(name="m"))
    made.save()
    assert read_model(tmp_path / "new.xmi", everything).roots[0].name == "m"


def test_faults_are_raised_with_file_and_line(tmp_path, zoo_resources, zoo_text):
    file = tmp_path / "bad.xmi"
    file.write_bytes(zoo_text('\n<animals xsi:type="zoo:Lion" name="l" teeth="many" tail="1"/>'))
    for _ in range(2):  # what was refused is not taken for open
        with pytest.raises(InvalidModelError, match=rf"^{re.escape(str(file))}:2: .*, and 1 more$") as error:
            zoo_resources.get_resource(URI(str(file)))
        assert [fault.place.line for fault in error.value.diagnostics] == [2, 2]
    assert zoo_resources.resources == {}
    with pytest.raises(UnreadableError, match=r"none\.xmi"):
        zoo_resources.get_resource(URI(str(tmp_path / "none.xmi")))


def test_a_fault_in_another_file_is_raised_as_well(park, resources):
    context = park / "context.xmi"
    context.write_text(context.read_text().replace('rows="', 'rows="many', 1))
    with pytest.raises(InvalidModelError, match=r"context\.xmi:\d+: "):
        resources.get_resource(URI(str(park / "mission.xmi")))
    assert resources.resources == {}


def test_what_is_no_error_is_in_the_notices(tmp_path, zoo_resources, zoo_text):
    file = tmp_path / "z.xmi"
    file.write_bytes(zoo_text('<xmi:Extension extender="x"/>'))
    assert [notice.code for notice in zoo_resources.get_resource(URI(str(file))).notices] == ["XMI011"]


def test_an_element_whose_plug_in_is_missing_is_refused_with_its_place(park, core):
    with pytest.raises(
        (InvalidModelError, UnsupportedError), match=r"mission\.xmi:\d+: .*urn:mmrs:solar:1\.0"
    ):
        resource_set(core).get_resource(URI(str(park / "mission.xmi")))


def test_a_reference_to_what_the_open_resource_lost_is_refused(park, resources):
    context = resources.get_resource(URI(str(park / "context.xmi")))
    context.contents[0].elements.pop()
    with pytest.raises(
        InvalidModelError, match=r"context\.xmi:\d+: PanelGroup: there is none at /elements\[1\]"
    ):
        resources.get_resource(URI(str(park / "mission.xmi")))


def test_what_is_refused_leaves_nothing_behind_in_open_resources(tmp_path, zoo_resources, zoo_text):
    lions = '<animals xsi:type="zoo:Lion" name="a"/><animals xsi:type="zoo:Lion" name="b"/>'
    (tmp_path / "far.xmi").write_bytes(zoo_text(lions))
    (tmp_path / "near.xmi").write_bytes(
        zoo_text(
            '<keepers badge="K"><keeps xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/></keepers>'
            '<star xsi:type="zoo:Lion" href="far.xmi#//@animals.1"/>'
        )
    )
    far = zoo_resources.get_resource(URI(str(tmp_path / "far.xmi"))).contents[0]
    far.animals.pop()
    with pytest.raises(InvalidModelError, match="there is none at"):
        zoo_resources.get_resource(URI(str(tmp_path / "near.xmi")))
    assert len(far.animals[0].keptBy) == 0


def test_identifiers_survive(tmp_path, zoo_resources, zoo_text, zoo):
    (tmp_path / "far.xmi").write_bytes(
        zoo_text('<animals xsi:type="zoo:Lion" xmi:id="_a" name="a"/><animals xsi:type="zoo:Lion" name="b"/>')
    )
    (tmp_path / "near.xmi").write_bytes(zoo_text('<star xsi:type="zoo:Lion" href="far.xmi#_a"/>'))
    near = zoo_resources.get_resource(URI(str(tmp_path / "near.xmi")))
    far = zoo_resources.get_resource(URI(str(tmp_path / "far.xmi")))
    assert far.resolve("_a") is near.contents[0].star or far.uuid_dict["_a"] is near.contents[0].star
    far.contents[0].animals.insert(0, far.contents[0].animals.pop())
    far.save()
    near.save()
    assert (tmp_path / "far.xmi").read_text().count("xmi:id=") == 1
    assert "far.xmi#_a" in (tmp_path / "near.xmi").read_text()
    assert read_model(tmp_path / "near.xmi", zoo).roots[0].star.name == "a"


def test_a_file_with_identifiers_gets_them_for_all_that_is_new(tmp_path, zoo_resources, zoo_text, zoo):
    file = tmp_path / "z.xmi"
    file.write_bytes(zoo_text("", 'xmi:id="_z" name="z"'))
    resource = zoo_resources.get_resource(URI(str(file)))
    resource.contents[0].guest = zoo.epackage("urn:test:zoo").getEClassifier("Lion")(name="l")
    resource.save()
    assert file.read_text().count("xmi:id=") == 2


def test_several_roots_keep_their_numbers(tmp_path, zoo_resources, zoo_text, zoo):
    both = b'<xmi:XMI xmlns:xmi="http://www.omg.org/XMI">%s%s</xmi:XMI>'
    lions = zoo_text('<animals xsi:type="zoo:Lion" name="l"/>')
    (tmp_path / "far.xmi").write_bytes(both % (zoo_text(""), lions))
    (tmp_path / "near.xmi").write_bytes(zoo_text('<star xsi:type="zoo:Lion" href="far.xmi#/1/@animals.0"/>'))
    near = zoo_resources.get_resource(URI(str(tmp_path / "near.xmi")))
    far = zoo_resources.get_resource(URI(str(tmp_path / "far.xmi")))
    assert len(far.contents) == 2
    far.contents[1].animals.insert(0, far.contents[1].animals[0].eClass(name="k"))
    far.save()
    near.save()
    assert read_model(tmp_path / "near.xmi", zoo).roots[0].star.name == "l"
    assert "far.xmi#/1/@animals.1" in (tmp_path / "near.xmi").read_text()


def test_files_in_json_work_as_well(tmp_path, zoo_resources, read_zoo, zoo):
    file = tmp_path / "z.json"
    write_model(read_zoo('<animals xsi:type="zoo:Lion" name="l"/>').roots, file, zoo)
    resource = zoo_resources.get_resource(URI(str(file)))
    resource.contents[0].animals[0].name = "m"
    resource.save()
    model = read_model(file, zoo)
    assert model.roots[0].animals[0].name == "m"
    assert file.read_bytes() == to_json(model.roots, zoo)


@pytest.mark.parametrize("kind", [str, bytes])
def test_any_uri_that_gives_streams_will_do(kind, zoo_resources, zoo_text):
    text = zoo_text('<animals xsi:type="zoo:Lion" name="l"/>')
    uri = MemoryURI(text if kind is bytes else text.decode())
    resource = zoo_resources.get_resource(uri)
    resource.contents[0].animals[0].name = "changed"
    resource.save()
    assert type(uri.text) is kind
    assert ("changed" if kind is str else b"changed") in uri.text


def test_a_uri_of_a_file_may_have_a_scheme(park, resources):
    assert resources.get_resource(URI(f"file://{park / 'context.xmi'}")).contents[0].name == "Solar park"


def test_the_network_is_not_touched(resources):
    with pytest.raises(
        UnreadableError, match=r"^http://localhost/m\.xmi: reading does not touch the network"
    ):
        resources.get_resource("http://localhost/m.xmi")


def test_options_are_refused_where_there_are_none(park, resources):
    with pytest.raises(ValueError, match=r"^faster: our reader and writer take no options"):
        resources.get_resource(URI(str(park / "context.xmi")), options={"faster": True})
    resource = resources.get_resource(URI(str(park / "context.xmi")))
    with pytest.raises(ValueError, match=r"^faster: "):
        resource.save(options={"faster": True})


@pytest.mark.parametrize("opened", [False, True])
def test_a_root_inside_an_element_of_another_file_is_refused(opened, tmp_path, zoo_resources, zoo_text):
    (tmp_path / "part.xmi").write_bytes(
        b'<zoo:Lion xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:zoo="urn:test:zoo" name="l"/>'
    )
    (tmp_path / "whole.xmi").write_bytes(zoo_text('<animals xsi:type="zoo:Lion" href="part.xmi#/"/>'))
    if opened:
        zoo_resources.get_resource(URI(str(tmp_path / "part.xmi")))
    with pytest.raises(UnsupportedError, match=r"part\.xmi:1: the root of a file inside an element"):
        zoo_resources.get_resource(URI(str(tmp_path / "whole.xmi")))


def test_what_pyecore_itself_read_keeps_its_references_between_files(tmp_path, zoo, zoo_text):
    (tmp_path / "far.xmi").write_bytes(zoo_text('<animals xsi:type="zoo:Lion" name="far"/>'))
    (tmp_path / "near.xmi").write_bytes(
        zoo_text('<favourites xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/>', 'name="z"')
    )
    plain = ResourceSet()
    for package in zoo.packages:
        plain.metamodel_registry[package.ns_uri] = zoo.epackage(package.ns_uri)
    resource = plain.get_resource(URI(str(tmp_path / "near.xmi")))
    resource.contents[0].star = resource.contents[0].favourites[0]
    model = from_pyecore(resource.contents, zoo)
    (far,) = model.linked[0].roots
    assert model.roots[0].favourites == [model.roots[0].star] == [far.animals[0]]
    assert {each.eResource.uri.last_segment for each in (far, *descendants(far))} == {"far.xmi"}
    write_model(model.roots, tmp_path / "again.xmi", zoo)
    assert read_model(tmp_path / "again.xmi", zoo).roots[0].star.name == "far"


def test_a_resource_works_without_a_set(park, everything):
    resource = resource_factory(everything)(URI(str(park / "mission.xmi")))
    assert isinstance(resource, Resource)
    resource.load()
    assert resource.contents[0].tasks[0].group.eResource.uri.last_segment == "context.xmi"


def test_a_model_of_flyaq_opens_as_what_it_becomes_and_its_file_is_not_replaced(contributions, tmp_path):
    file = tmp_path / "round.xmi"
    theirs = EXAMPLES.parent / "plugins" / "flyaq" / "tests" / "fixtures" / "flyaq"
    before = (theirs / "round.xmi").read_bytes()
    file.write_bytes(before)
    resource = resource_set(contributions.languages).get_resource(URI(str(file)))
    assert [robot.id for robot in resource.contents[0].robots] == ["scout", "follower"]
    assert "MIG003" in [notice.code for notice in resource.notices]
    with pytest.raises(UnsupportedError, match="a model of FLYAQ 2015, which is not replaced"):
        resource.save()
    assert file.read_bytes() == before
    resource.save(output=tmp_path / "ours.xmi")
    assert read_model(tmp_path / "ours.xmi", contributions.languages).importer is None
