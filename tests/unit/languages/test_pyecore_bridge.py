from pathlib import Path

import pytest

pyecore = pytest.importorskip("pyecore.ecore")

from mmrs_core.errors import PluginError, UnsupportedError  # noqa: E402
from mmrs_core.languages import mission  # noqa: E402
from mmrs_core.languages.datatypes import ECORE  # noqa: E402
from mmrs_core.languages.ecore_api.bridge import from_pyecore, to_pyecore  # noqa: E402
from mmrs_core.languages.model import Model  # noqa: E402
from mmrs_core.languages.reading import read_model  # noqa: E402
from mmrs_core.languages.registry import MetamodelSource, core_registry, registry_with  # noqa: E402
from mmrs_core.languages.writing import to_xmi  # noqa: E402

ZOO = "urn:test:zoo"
RICH = """
<animals xsi:type="zoo:Lion" name="L" mood="is-hungry" hungry="ANGRY" age="0" teeth="30"
  keptBy="B2 B1" weight="1.5"
  born="2024-05-01T10:11:12.123+0200" chip="0aff" cage="-12" shade="red" price="1.50" speed="2.5" steps="7"
  grade="x">
  <moods>is-calm</moods><motto xsi:nil="true"/><tags>a b</tags><tags>c</tags>
  <weights>1.0</weights><weights>1.0</weights>
  <cubs xsi:type="zoo:Otter" name="cub"/>
</animals>
<animals xsi:type="zoo:Otter" name="O" mate="//@animals.0" depth="0.0"/>
<animals xsi:type="wing:Parrot" name="P"><nest eggs="2"/></animals>
<keepers badge="B1"/><keepers badge="B2" deputy="B1" keeps="//@animals.1 //@animals.0"/>
<notes key="k" value="v"/>
"""


def test_a_model_survives_the_way_to_pyecore_and_back(read_zoo, zoo):
    model = read_zoo(RICH, 'name="z" star="//@animals.0" favourites="//@animals.2 //@animals.0"')
    assert model.diagnostics == ()
    back = from_pyecore(to_pyecore(model, zoo), zoo)
    assert back.linked == ()
    assert to_xmi(back.roots, zoo) == to_xmi(model.roots, zoo)


def test_pyecore_sees_values_containers_and_opposites(read_zoo, zoo):
    (root,) = to_pyecore(read_zoo(RICH), zoo)
    lion = root.animals[0]
    assert isinstance(root, pyecore.EObject)
    assert lion.eContainer() is root
    assert lion.mood.name == "HUNGRY"
    assert lion.motto is None
    assert [keeper.badge for keeper in lion.keptBy] == ["B2", "B1"]
    assert lion.mateOf is root.animals[1]


def test_what_was_made_with_pyecore_becomes_a_model(zoo):
    lion_class = zoo.metaclass(ZOO, "Lion").eclass
    lion = lion_class(name="l", teeth=3)
    lion.tags.extend(["a", "b"])
    root = zoo.metaclass(ZOO, "Zoo").eclass(name="z", animals=[lion], star=lion)
    made = from_pyecore([root], zoo).roots[0]
    assert made.star is made.animals[0]
    assert (made.star.teeth, made.star.tags, made.star.zoo) == (3, ["a", "b"], made)


def test_the_class_of_a_core_language_is_one_object(core, everything):
    ours = core.metaclass("urn:mmrs:mission:1.0", "Mission")
    assert ours.eclass is ours.eclass
    survey = everything.metaclass("urn:mmrs:survey:1.0", "PhotoGridTask").eclass
    assert core.metaclass("urn:mmrs:mission:1.0", "SweepTask").eclass in survey.eSuperTypes


def test_other_files_come_along_but_are_not_among_the_roots(tmp_path, zoo, zoo_text):
    (tmp_path / "far.xmi").write_bytes(zoo_text('<animals xsi:type="zoo:Lion" name="far"/>'))
    (tmp_path / "near.xmi").write_bytes(zoo_text('<star xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/>'))
    model = read_model(tmp_path / "near.xmi", zoo)
    roots = to_pyecore(model, zoo)
    assert len(roots) == 1
    assert roots[0].star.name == "far"
    back = from_pyecore(roots, zoo)
    assert back.roots[0].star is back.linked[0].roots[0].animals[0]


def test_what_pyecore_cannot_hold_is_refused(read_zoo, zoo):
    strange = zoo.create(ZOO, "Odd", name="o")
    with pytest.raises(UnsupportedError, match=r"Odd\.eClass: pyecore has another attribute"):
        to_pyecore(Model("m", (strange,)), zoo)
    twice = read_zoo('<animals xsi:type="zoo:Lion" name="l"/>', 'favourites="//@animals.0 //@animals.0"')
    with pytest.raises(UnsupportedError, match=r"favourites: pyecore does not hold the same value twice"):
        to_pyecore(twice, zoo)
    described = core_registry().create(ECORE, "EClass", name="K")
    with pytest.raises(UnsupportedError, match=r"EClass: an element of Ecore itself"):
        to_pyecore(Model("m", (described,)), zoo)
    unknown = read_zoo('<animals xmlns:o="urn:other" xsi:type="o:Cat"/>')
    with pytest.raises(UnsupportedError, match=r"urn:other#Cat"):
        to_pyecore(unknown, zoo)


def test_an_object_of_a_class_that_is_not_installed_is_refused(core, zoo):
    lion = zoo.metaclass(ZOO, "Lion").eclass(name="l")
    with pytest.raises(UnsupportedError, match=r"^Lion: urn:test:zoo: no such metamodel"):
        from_pyecore([lion], core)


@pytest.fixture
def package(core):
    """A metamodel made with pyecore that extends the mission layer."""
    task = core.metaclass("urn:mmrs:mission:1.0", "PointTask").eclass
    made = pyecore.EPackage("paint", nsURI="urn:t:paint", nsPrefix="paint")
    colour = pyecore.EEnum("Colour", literals=["RED", "BLUE"])
    paint = pyecore.EClass("PaintTask", superclass=(task,))
    paint.eStructuralFeatures.append(pyecore.EAttribute("colour", colour, default_value=colour.RED))
    paint.eStructuralFeatures.append(pyecore.EAttribute("coats", pyecore.EInt, lower=1))
    paint.eStructuralFeatures.append(pyecore.EReference("after", paint))
    made.eClassifiers.extend([colour, paint])
    return made


def test_a_plug_in_may_hand_in_an_epackage(package):
    registry = registry_with([MetamodelSource("urn:t:paint", package, "paint")])
    task = registry.create("urn:t:paint", "PaintTask", name="t", coats=2)
    assert isinstance(task, mission.Task)
    assert registry.metaclass("urn:t:paint", "PaintTask").eclass is package.getEClassifier("PaintTask")
    made = mission.Mission(tasks=[task])
    back = from_pyecore(to_pyecore(Model("m", (made,)), registry), registry)
    assert to_xmi(back.roots, registry) == to_xmi([made], registry)


def test_what_is_no_epackage_is_refused(tmp_path):
    with pytest.raises(PluginError, match=r"neither the path of an \.ecore file nor a pyecore EPackage"):
        registry_with([MetamodelSource("urn:x", "x.ecore", "p")])
    with pytest.raises(PluginError, match="name or nsURI is missing"):
        registry_with([MetamodelSource("urn:x", pyecore.EPackage("x"), "p")])


def test_what_is_loaded_is_what_pyecore_itself_loads(everything):
    from pyecore.resources import URI, ResourceSet

    resources = ResourceSet()
    for package in everything.packages:
        assert isinstance(package.ecore, Path)
        loaded = resources.get_resource(URI(str(package.ecore))).contents[0]
        resources.metamodel_registry[loaded.nsURI] = loaded
        assert told(everything.epackage(package.ns_uri)) == told(loaded)
        assert everything.epackage(package.ns_uri).eResource.uri.plain == str(package.ecore)


STATED = ("name", "lowerBound", "upperBound", "unique", "ordered", "unsettable", "transient", "containment")


def told(epackage):
    """Return all that an EPackage says, as nested tuples."""

    def kind(classifier):
        return classifier.ePackage.nsURI, classifier.name

    def notes(element):
        return [(note.source, dict(note.details)) for note in element.eAnnotations]

    def feature(each):
        opposite = getattr(each, "eOpposite", None)
        other = (kind(opposite.eContainingClass), opposite.name) if opposite is not None else None
        stated = [getattr(each, name, None) for name in STATED]
        return *stated, each.defaultValueLiteral, kind(each.eType), other, notes(each)

    classes = [
        (
            each.name,
            each.abstract,
            [kind(above) for above in each.eSuperTypes],
            [feature(inner) for inner in each.eStructuralFeatures],
            notes(each),
        )
        for each in epackage.eClassifiers
        if isinstance(each, pyecore.EClass)
    ]
    values = [
        (each.name, [(literal.name, literal.value, notes(literal)) for literal in each.eLiterals])
        for each in epackage.eClassifiers
        if isinstance(each, pyecore.EEnum)
    ]
    return epackage.name, epackage.nsURI, epackage.nsPrefix, classes, values, notes(epackage)


def test_features_whose_names_python_keeps_for_classes_are_in_the_eclass(tmp_path):
    names = ("__dict__", "__class__", "__name__", "__bases__", "_staticEClass", "plain")
    text = "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EString"
    file = tmp_path / "kept.ecore"
    file.write_text(
        '<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="kept" nsURI="urn:test:kept">'
        '<eClassifiers xsi:type="ecore:EClass" name="A">'
        + "".join(
            f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{name}" eType="{text}"/>'
            for name in names
        )
        + "</eClassifiers></ecore:EPackage>"
    )
    registry = registry_with([MetamodelSource("urn:test:kept", file)])
    eclass = registry.metaclass("urn:test:kept", "A").eclass
    assert tuple(feature.name for feature in eclass.eStructuralFeatures) == names
    assert eclass(plain="as ever").plain == "as ever"


def test_supertypes_that_python_has_no_order_for_change_no_other_class():
    file = Path(__file__).parents[1] / "generation" / "stubs" / "awkward.ecore"
    registry = registry_with([MetamodelSource("urn:test:awkward", file)])
    before = dict(vars(pyecore.Metasubinstance))
    crossed = registry.metaclass("urn:test:awkward", "Two words").eclass
    assert dict(vars(pyecore.Metasubinstance)) == before
    assert {each.name for each in crossed.eAllSuperTypes()} == {"First", "Second", "Left", "Right"}
    assert crossed(int=3, second=True).int == 3


def test_classes_that_build_upon_ecore_itself_are_handed_over(tmp_path):
    body = (
        f'<eClassifiers xsi:type="ecore:EClass" name="Note" eSuperTypes="{ECORE}#//ENamedElement">'
        f'<eStructuralFeatures xsi:type="ecore:EReference" name="of" eType="ecore:EClass {ECORE}#//EClass"/>'
        "</eClassifiers>"
    )
    (tmp_path / "notes.ecore").write_text(
        '<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        f'xmlns:ecore="{ECORE}" name="notes" nsURI="urn:notes">{body}</ecore:EPackage>'
    )
    notes = registry_with([MetamodelSource("urn:notes", tmp_path / "notes.ecore", "notes")])
    eclass = notes.metaclass("urn:notes", "Note").eclass
    assert [above.name for above in eclass.eSuperTypes] == ["ENamedElement"]
    assert eclass.findEStructuralFeature("of").eType.name == "EClass"
    (note,) = to_pyecore(Model("m", (notes.create("urn:notes", "Note", name="n"),)), notes)
    assert note.name == "n"


def test_an_attribute_of_pyecore_without_a_type_is_refused():
    package = pyecore.EPackage("paint", nsURI="urn:t:paint", nsPrefix="paint")
    task = pyecore.EClass("PaintTask")
    task.eStructuralFeatures.append(pyecore.EAttribute("coats"))
    package.eClassifiers.append(task)
    with pytest.raises(PluginError, match=r"^p: urn:t:paint: PaintTask\.coats: eType is missing"):
        registry_with([MetamodelSource("urn:t:paint", package, "p")])
