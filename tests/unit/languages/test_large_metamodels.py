"""Metamodels so large or so deep that it shows."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest

from mmrs_core.errors import PluginError
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.metamodels.loading import DEEPEST_INHERITANCE
from mmrs_core.languages.registry import MetamodelSource, core_registry

HEAD = (
    '<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="big" nsURI="urn:test:big" nsPrefix="big">'
)


@pytest.fixture
def registry_of(tmp_path):
    """Return a function that gives the registry with a metamodel of some classes."""

    def make(*classes: str):
        file = tmp_path / "big.ecore"
        file.write_text(f"{HEAD}{''.join(classes)}</ecore:EPackage>")
        return core_registry().extended([MetamodelSource("urn:test:big", file)])

    return make


def classed(name, above="", features=()):
    given = "".join(
        f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{each}"'
        ' eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EInt"/>'
        for each in features
    )
    supertypes = f' eSuperTypes="#//{above}"' if above else ""
    return f'<eClassifiers xsi:type="ecore:EClass" name="{name}"{supertypes}>{given}</eClassifiers>'


def chain(length):
    return [classed("C0"), *(classed(f"C{index}", f"C{index - 1}") for index in range(1, length))]


def has_classes(metaclass):
    slot = Metaclass.__dict__["implementation"]
    try:
        slot.__get__(metaclass)
    except AttributeError:
        return False
    return True


def test_only_the_classes_that_are_asked_for_are_made(registry_of):
    big = registry_of(*chain(3), classed("Other"))
    big.create("urn:test:big", "C1")
    made = {kind.name for kind in big.package("urn:test:big").metaclasses if has_classes(kind)}
    assert made == {"C0", "C1"}


def test_threads_that_ask_at_once_get_the_same_class(registry_of):
    kinds = registry_of(*chain(60)).package("urn:test:big").metaclasses
    together = Barrier(4)

    def ask(_):
        together.wait()
        return [kind.interface for kind in kinds]

    with ThreadPoolExecutor(4) as pool:
        first, *others = pool.map(ask, range(4))
    assert all(other == first for other in others)


@pytest.mark.parametrize("turned", [False, True])
def test_the_deepest_inheritance_is_usable_in_any_order(registry_of, turned):
    classes = chain(DEEPEST_INHERITANCE)
    big = registry_of(*(reversed(classes) if turned else classes))
    last = big.metaclass("urn:test:big", f"C{DEEPEST_INHERITANCE - 1}")
    assert len(last.ancestry) == DEEPEST_INHERITANCE
    assert isinstance(last.interface(), big.metaclass("urn:test:big", "C0").interface)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("length", [DEEPEST_INHERITANCE + 1, 5000])
def test_deeper_inheritance_is_refused(registry_of, turned, length):
    classes = chain(length)
    with pytest.raises(PluginError, match="inherits through more than 100 others"):
        registry_of(*(reversed(classes) if turned else classes))


def test_classes_that_inherit_in_countless_ways_are_refused(registry_of):
    crossed = [classed(f"C{index}", f"C{index - 2} #//C{index - 1}") for index in range(2, 40)]
    with pytest.raises(PluginError, match="inherits in more than 20000 ways"):
        registry_of(classed("C0"), classed("C1", "C0"), *crossed)


def test_packages_that_nest_deeper_than_pyecore_goes_are_refused_with_the_file(registry_of):
    inner = "".join(f'<eSubpackages name="p{index}" nsURI="urn:p{index}">' for index in range(300))
    with pytest.raises(PluginError, match=r"big\.ecore: pyecore cannot load this: Excessive depth"):
        registry_of(inner + "</eSubpackages>" * 300)


def test_features_that_multiply_by_inheritance_are_refused(registry_of):
    top = classed("Top", features=[f"f{index}" for index in range(1000)])
    with pytest.raises(PluginError, match="more than 500000 features"):
        registry_of(top, *(classed(f"C{index}", "Top") for index in range(600)))
