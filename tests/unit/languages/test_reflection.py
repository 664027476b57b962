"""Elements answer what pyecore's objects answer, to those who read them with pyecore's API."""

import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace

import pytest
from pyecore import ecore
from pyecore.resources import URI, Resource, ResourceSet
from pyecore_reading import SNIPPETS

from mmrs_core.languages import behaviour, mission
from mmrs_core.languages.ecore_api.bridge import to_pyecore
from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model, read_text

ROOT = Path(__file__).parents[3]
ZOO = "urn:test:zoo"
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
FILES = {
    "mission": "solar-park/mission.xmi",
    "context": "solar-park/context.xmi",
    "robot": "mixed-team/robots/inspection-auv.xmi",
    "behaviour": "handwritten/behaviour.xmi",
}


@pytest.fixture(scope="module")
def packages(everything):
    return {package.ns_uri: everything.epackage(package.ns_uri) for package in everything.packages}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The examples without comments, which pyecore's own reader refuses."""
    folder = tmp_path_factory.mktemp("examples")
    for name in FILES.values():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        text = (ROOT / "examples" / name).read_text(encoding="utf-8")
        (folder / name).write_text(COMMENT.sub("", text), encoding="utf-8")
    return {kind: folder / name for kind, name in FILES.items()}


@pytest.fixture(scope="module")
def ours(files, packages, everything):
    roots = {kind: read_model(file, everything).roots[0] for kind, file in files.items()}
    return SimpleNamespace(**roots, packages=packages)


@pytest.fixture(scope="module")
def theirs(files, packages):
    resources = ResourceSet()
    resources.metamodel_registry.update(packages)
    roots = {kind: resources.get_resource(URI(str(file))).contents[0] for kind, file in files.items()}
    return SimpleNamespace(**roots, packages=packages)


def plain(value):
    """Return a result without objects: elements by class and place, dictionaries and sets in order."""
    if isinstance(value, (Element, ecore.EObject)):
        return value.eClass.name, value.eURIFragment()
    if isinstance(value, Mapping):
        return sorted((key, plain(each)) for key, each in value.items())
    if isinstance(value, (set, frozenset)):
        return sorted(map(plain, value))
    return [plain(each) for each in value] if isinstance(value, (list, tuple)) else value


@pytest.mark.parametrize("snippet", SNIPPETS, ids=[snippet.__name__ for snippet in SNIPPETS])
def test_reading_code_gives_the_same_for_elements_and_for_objects_that_pyecore_read(snippet, ours, theirs):
    expected = plain(snippet(theirs))
    assert expected not in (None, [], [[]])
    assert plain(snippet(ours)) == expected


def test_there_are_forty_snippets():
    assert len(SNIPPETS) >= 40


def test_the_class_of_an_element_is_that_of_its_package_and_of_its_python_class(everything):
    eclass = everything.epackage("urn:mmrs:multicopter:1.0").getEClassifier("Drone")
    drone = everything.create("urn:mmrs:multicopter:1.0", "Drone")
    assert drone.eClass is type(drone).eClass is eclass
    assert behaviour.GoTo().eClass is behaviour.GoTo.eClass
    with pytest.raises(ValueError, match=r"^urn:nobody: no such metamodel"):
        everything.epackage("urn:nobody")


def test_elements_alone_do_not_import_pyecore():
    text = "import sys, mmrs_core.languages.element; assert not {'pyecore', 'lxml'} & set(sys.modules)"
    assert subprocess.run([sys.executable, "-c", text], check=False).returncode == 0


def test_values_are_set_by_name_or_feature_and_taken_away_again():
    task = mission.Fork(name="t")
    task.eSet(mission.Fork.eClass.findEStructuralFeature("name"), "u")
    task.eSet("robotsWanted", 3)
    assert (task.name, task.eGet("robotsWanted"), task.eIsSet("robotsWanted")) == ("u", 3, True)
    for _ in range(2):
        task.eUnset("robotsWanted")
        task.eUnset("name")
    assert (task.name, task.eIsSet("name"), task.eIsSet("robotsWanted")) == (None, False, False)


def test_setting_a_reference_by_its_name_keeps_both_ends(read_zoo):
    zoo = read_zoo('<animals xsi:type="zoo:Lion" name="l"/><keepers badge="B"/>').roots[0]
    zoo.animals[0].eSet("keptBy", [zoo.keepers[0]])
    assert zoo.keepers[0].keeps == [zoo.animals[0]]
    zoo.animals[0].eUnset("keptBy")
    assert zoo.keepers[0].keeps == []
    zoo.animals[0].eUnset("zoo")
    assert (zoo.animals, zoo.eContents) == ([], [zoo.keepers[0]])


def test_a_value_counts_as_set_even_where_it_is_the_default(lion):
    said, unsaid = lion('teeth="30" age="0"'), lion("")
    assert [said.eIsSet(name) for name in ("teeth", "age", "tags", "motto")] == [True, True, False, False]
    assert [unsaid.eIsSet(name) for name in ("teeth", "age", "name")] == [False, False, True]


def test_none_counts_as_set_where_files_state_it(lion):
    silent = lion("", '<motto xsi:nil="true"/>')
    assert (silent.motto, silent.eIsSet("motto")) == (None, True)
    silent.eUnset("motto")
    assert (silent.motto, silent.eIsSet("motto")) == ("roar", False)


def test_literals_of_pyecore_become_their_names(zoo):
    mood = zoo.epackage(ZOO).getEClassifier("Mood")
    lion = zoo.create(ZOO, "Lion")
    lion.eSet("mood", mood.getEEnumLiteral("ANGRY"))
    lion.eSet("moods", [mood.getEEnumLiteral("CALM"), "HUNGRY"])
    assert (lion.mood, lion.moods) == ("ANGRY", ["CALM", "HUNGRY"])
    other = zoo.epackage(ZOO).getEClassifier("Lion")(moods=[mood.getEEnumLiteral("ANGRY")])
    lion.eSet("moods", other.moods)
    lion.eSet("mood", None)
    assert (lion.mood, lion.moods) == ("CALM", ["ANGRY"])
    with pytest.raises(ValueError, match="takes a list"):
        lion.eSet("moods", "ANGRY")


def test_what_is_no_feature_is_refused():
    with pytest.raises(AttributeError, match=r"^nmae: no feature of Mission; did you mean name\?"):
        mission.Mission().eGet("nmae")
    with pytest.raises(TypeError, match=r"^7: neither the name of a feature nor a feature"):
        mission.Mission().eSet(7, "x")


def test_features_that_have_the_name_of_a_method_go_first(zoo, read_zoo):
    animal = read_zoo('<animals xsi:type="zoo:Odd" name="o" eClass="c" eResource="r"/>').roots[0].animals[0]
    assert (animal.eClass, animal.eResource, animal.eGet("eClass")) == ("c", "r", "c")
    assert metaclass_of(animal).eclass is zoo.epackage(ZOO).getEClassifier("Odd")
    assert (animal.eContainer().name, animal.eURIFragment()) == ("z", "//@animals.0")


def test_fragments_tell_the_root_where_there_are_several(zoo, zoo_text):
    text = b'<xmi:XMI xmlns:xmi="http://www.omg.org/XMI">%s%s</xmi:XMI>'
    lions = zoo_text('<animals xsi:type="zoo:Lion" name="l"/><guest xsi:type="zoo:Lion" name="g"/>')
    model = read_text(text % (zoo_text(""), lions), "z.xmi", zoo)
    assert [each.eURIFragment() for each in model.elements()] == ["/0", "/1", "/1/@animals.0", "/1/@guest"]
    resource = Resource(URI("z.xmi"))
    resource.extend(to_pyecore(model, zoo))
    theirs = [each.eURIFragment() for each in resource.contents[1].eContents]
    assert sorted(theirs) == ["/1/@animals.0", "/1/@guest"]


def test_what_stands_in_no_file_has_no_resource(tmp_path, zoo, zoo_text, lion):
    assert lion("").eResource is None
    (tmp_path / "z.xmi").write_bytes(zoo_text('<animals xsi:type="zoo:Lion" name="l"/>'))
    model = read_model(tmp_path / "z.xmi", zoo)
    animal = model.roots[0].animals[0]
    assert animal.eResource.uri.normalize() == str(tmp_path / "z.xmi")
    assert animal.eResource.contents == list(model.roots)
    model.roots[0].animals.clear()
    assert (animal.eResource, animal.eURIFragment()) == (None, "/")
    model.roots[0].guest = zoo.create(ZOO, "Lion", name="new")
    assert model.roots[0].guest.eResource is model.roots[0].eResource


def test_elements_whose_metamodel_is_missing_tell_where_they_are(read_zoo):
    root = read_zoo('<animals xmlns:o="urn:other" xsi:type="o:Cat"/>', 'star="//@animals.0/@kitten"').roots[0]
    (cat,) = root.eContents
    assert (cat.eContainer(), cat.eURIFragment()) == (root, "//@animals.0")
    assert root.star.eURIFragment() == "//@animals.0/@kitten"
    assert not hasattr(cat, "eClass")
    with pytest.raises(ValueError, match="metamodel is not installed"):
        cat.eGet("name")


def test_what_is_said_to_differ_from_pyecore_differs(zoo, read_zoo):
    """The page for those who know pyecore tells of these."""
    model = read_zoo(
        '<animals xsi:type="zoo:Lion" name="l" mood="is-hungry">'
        '<cubs xsi:type="zoo:Lion" name="c"/></animals>'
        '<animals xsi:type="zoo:Otter" name="o"/>'
    )
    (theirs,) = to_pyecore(model, zoo)
    lion, otter = model.roots[0].animals
    assert (lion.mood, theirs.animals[0].mood.name) == ("HUNGRY", "HUNGRY")
    assert (otter.depth, theirs.animals[1].depth) == (None, 0.0)
    assert [each.name for each in model.roots[0].eAllContents()] == ["l", "c", "o"]
    assert [each.name for each in theirs.eAllContents()] == ["l", "o", "c"]
    assert isinstance(theirs.animals[0], lion.eClass)
    assert not isinstance(lion, lion.eClass)
    with pytest.raises(AttributeError):
        lion.__getattribute__("teeth")
    lion.teeth = "many"
    with pytest.raises(ecore.BadValueError):
        theirs.animals[0].teeth = "many"
    theirs.animals[0].teeth = None
    assert theirs.animals[0].eIsSet("teeth")
    theirs.animals[0].tags.append("t")
    theirs.animals[0].tags.clear()
    assert theirs.animals[0].eIsSet("tags")


def test_a_value_that_is_the_default_survives_the_way_to_pyecore_and_back(zoo, lion):
    (made,) = to_pyecore(Model("m", (lion('teeth="30"'),)), zoo)
    assert made.eIsSet("teeth")
    assert not made.eIsSet("hungry")


def test_every_feature_of_every_class_is_understood(everything, zoo):
    for package in (*everything.packages, *zoo.packages):
        for metaclass in package.metaclasses:
            features = metaclass.eclass.eAllStructuralFeatures()
            assert {feature.name for feature in features} == set(metaclass.by_name)
            if not metaclass.abstract:
                element = metaclass.interface()
                for feature in features:  # of Element, since features of these names go first
                    assert Element.eGet(element, feature) == getattr(
                        element, metaclass.by_name[feature.name].attribute
                    )
                    assert not Element.eIsSet(element, feature)
