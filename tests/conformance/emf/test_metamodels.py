import pytest
from emf_description import metamodel_lines
from pyecore import ecore

from mmrs_core.languages import mission
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.metamodels.export import export_metamodels
from mmrs_core.languages.registry import MetamodelSource, registry_with

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]


def test_emf_finds_no_fault_in_the_metamodels_as_they_stand(referee, every_metamodel):
    with referee.knowing(*every_metamodel) as verdict:
        assert verdict.faults == []
        assert verdict.all("JUDGED") == [file.name for file in every_metamodel]


def test_emf_finds_no_fault_in_the_exported_metamodels(referee, registry, every_metamodel, tmp_path):
    files = exported(registry, tmp_path)
    assert len(files) == len(every_metamodel)
    with referee.knowing(*files) as verdict:
        assert verdict.faults == []


def test_the_exported_metamodels_say_what_the_installed_ones_say(referee, registry, tmp_path):
    before = sorted(referee.ask("describe").lines)
    with referee.knowing(*exported(registry, tmp_path)):
        assert sorted(referee.ask("describe").lines) == before


def test_exported_metamodels_need_no_registration(referee, registry, tmp_path):
    for file in exported(registry, tmp_path):
        with referee.knowing(file) as verdict:
            assert verdict.faults == [], file.name


def test_a_faulty_metamodel_is_told(referee, metamodels, tmp_path):
    text = metamodels[0].read_text().replace('name="Robot"', 'name="Interval"')
    (tmp_path / "bad.ecore").write_text(text)
    with referee.knowing(tmp_path / "bad.ecore") as verdict:
        assert not verdict.accepted


def test_our_tables_say_what_emf_says(referee, registry):
    told = ("PACKAGE", "CLASS", "SUPER", "FEATURE", "LITERAL", "DATATYPE")
    theirs = sorted(line for line in referee.ask("describe").lines if line.startswith(told))
    assert sorted(metamodel_lines(registry)) == theirs
    assert len(theirs) > 1300


def test_a_package_made_with_pyecore_is_exported_as_emf_likes_it(referee, paint, tmp_path):
    with referee.knowing(*exported(paint, tmp_path)) as verdict:
        assert verdict.faults == []
        theirs = sorted(referee.ask("describe").lines)
    assert sorted(metamodel_lines(paint)) == theirs


def exported(registry, folder):
    return [path for path in export_metamodels(registry, folder) if path.suffix == ".ecore"]


@pytest.fixture
def paint():
    package = ecore.EPackage("paint", nsURI="urn:t:paint", nsPrefix="paint")
    colour = ecore.EEnum("Colour", literals=["RED", "BLUE"])
    task = ecore.EClass("PaintTask", superclass=(metaclass_of(mission.PointTask).eclass,))
    task.eStructuralFeatures.append(ecore.EAttribute("colour", colour, default_value=colour.BLUE))
    task.eStructuralFeatures.append(ecore.EAttribute("coats", ecore.EInt, lower=1, upper=-1))
    task.eStructuralFeatures.append(ecore.EReference("after", task, upper=-1))
    task.eStructuralFeatures.append(ecore.EReference("before", task, upper=-1))
    task.findEStructuralFeature("after").eOpposite = task.findEStructuralFeature("before")
    package.eClassifiers.extend([colour, task])
    return registry_with([MetamodelSource("urn:t:paint", package, "paint")])
