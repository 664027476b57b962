from __future__ import annotations

import pytest

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.metaclass import Enumeration
from mmrs_core.languages.metamodels.export import export_metamodels

pytestmark = pytest.mark.peer


def test_emf_finds_no_fault_in_the_metamodels_as_they_stand(referee, metamodels):
    verdict = referee(*metamodels)
    assert verdict.faults == []
    assert sum(line.startswith("JUDGED") for line in verdict.lines) == len(metamodels)


def test_emf_finds_no_fault_in_the_exported_metamodels(referee, registry, tmp_path):
    files = [path for path in export_metamodels(registry, tmp_path) if path.suffix == ".ecore"]
    assert referee(*files).faults == []


def test_a_faulty_metamodel_is_told(referee, metamodels, tmp_path):
    text = metamodels[0].read_text().replace('name="Robot"', 'name="Interval"')
    (tmp_path / "bad.ecore").write_text(text)
    assert not referee(tmp_path / "bad.ecore").accepted


def test_our_tables_say_what_emf_says(referee, registry, metamodels, zoo_file):
    verdict = referee(*metamodels, zoo_file)
    told = ("PACKAGE", "CLASS", "SUPER", "FEATURE", "LITERAL")
    theirs = sorted(line for line in verdict.lines if line.startswith(told))
    assert sorted(description(registry)) == theirs
    assert len(theirs) > 500


def test_a_package_made_with_pyecore_is_exported_as_emf_likes_it(referee, core_paint, tmp_path):
    files = [path for path in export_metamodels(core_paint, tmp_path) if path.suffix == ".ecore"]
    assert referee(*files).faults == []


@pytest.fixture
def core_paint():
    from pyecore import ecore

    from mmrs_core.languages import mission
    from mmrs_core.languages.element import metaclass_of
    from mmrs_core.languages.registry import MetamodelSource, registry_with

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


def description(registry):
    """Yield what the referee prints of metamodels, from our tables."""
    for package in registry.packages:
        yield f"PACKAGE {package.ns_uri} {package.name} {package.prefix}"
        for enumeration in package.enumerations:
            for literal in enumeration.literals:
                yield f"LITERAL {name(enumeration)} {literal.name} {literal.value} {literal.literal}"
        for metaclass in package.metaclasses:
            yield f"CLASS {name(metaclass)} abstract={str(metaclass.abstract).lower()}"
            for above in metaclass.supertypes:
                yield f"SUPER {name(metaclass)} {name(above)}"
            for feature in metaclass.features:
                yield f"FEATURE {name(metaclass)} {described(feature)}"


def described(feature):
    opposite = feature.opposite and f"{name(feature.opposite.owner)}/{feature.opposite.name}"
    default = feature.default
    if feature.unsettable and default is None and isinstance(feature.type, DataType):
        default = feature.type.primitive_default  # where EMF has a zero, an unset number is None here
    if default is not None and isinstance(feature.type, DataType | Enumeration):
        default = feature.type.render(default)
    flags = {
        "containment": feature.containment,
        "unsettable": feature.unsettable,
        "unique": feature.unique,
        "id": feature.is_id,
        "transient": not feature.stored,
    }
    return (
        f"{feature.name} type={name(feature.type)} bounds={feature.lower}..{feature.upper} "
        + " ".join(f"{flag}={str(value).lower()}" for flag, value in flags.items())
        + f" opposite={opposite or ''} default={default if default is not None else ''}"
    )


def name(kind):
    return f"{kind.ns_uri}#{kind.name}"
