"""pyecoregen makes the stubs: it changes nothing in pyecore, and is asked for only where it is needed."""

import subprocess
import sys
from pathlib import Path

import pytest
from multigen.generator import Generator
from pyecore import ecore
from pyecore.resources import global_registry
from pyecoregen.ecore import EcoreTask

from mmrs_core.cli import run
from mmrs_core.errors import InternalError
from mmrs_core.generation.stubs import generator
from mmrs_core.generation.stubs.write import write_stubs
from mmrs_core.languages.metamodels.gathering import registry_of_files

HERE = Path(__file__).parent
MODELS = HERE.parents[2] / "fixtures" / "models"


def stubs_of(file, folder):
    registry, ns_uris = registry_of_files([file], ())
    return write_stubs(registry, ns_uris, folder)


def test_the_generator_and_its_task_are_those_of_pyecoregen():
    assert issubclass(generator.StubTask, EcoreTask)
    assert issubclass(generator.StubGenerator, Generator)
    assert generator.StubTask.element_type is ecore.EPackage


@pytest.mark.parametrize("file", [HERE / "awkward.ecore", MODELS / "suite.ecore"], ids=["awkward", "suite"])
def test_pyecore_is_afterwards_as_it_was_before(file, tmp_path):
    def state():
        kinds = (ecore.EObject, ecore.ENamedElement, ecore.EClass, ecore.EPackage, ecore.Metasubinstance)
        return [dict(vars(kind)) for kind in kinds], dict(global_registry), ecore.EClass.name, ecore.name

    before = state()
    stubs_of(file, tmp_path)
    assert state() == before


def test_pyecore_answers_the_names_of_the_metamodel_while_stubs_are_made(tmp_path, monkeypatch):
    seen = []
    registry, ns_uris = registry_of_files([MODELS / "zoo.ecore"], ())
    odd = registry.epackage(ns_uris[0]).getEClassifier("Odd")
    path_of = generator.StubTask.relative_path_for_element

    def watched(task, element):
        seen.append([feature.name for feature in odd.eStructuralFeatures][:2])
        return path_of(task, element)

    monkeypatch.setattr(generator.StubTask, "relative_path_for_element", watched)
    write_stubs(registry, ns_uris, tmp_path)
    assert seen
    assert all(names == ["from", "class"] for names in seen)


def test_a_fault_in_the_second_stub_leaves_no_first(tmp_path, monkeypatch):
    view = generator.module_view

    def broken(package, modules):
        return {} if package.name == "wing" else view(package, modules)

    monkeypatch.setattr(generator, "module_view", broken)
    with pytest.raises(InternalError, match=r"module\.pyi\.jinja"):
        stubs_of(MODELS / "zoo.ecore", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_package_inside_another_gets_its_stub_alone_where_it_alone_is_asked_for(tmp_path):
    registry, _ = registry_of_files([MODELS / "suite.ecore"], ())
    written = write_stubs(registry, ["urn:test:suite:inner"], tmp_path)
    assert written[0] == tmp_path / "inner.pyi"
    assert sorted(tmp_path.iterdir()) == sorted(written)


def test_pyecoregen_is_imported_for_stubs_only():
    code = (
        "import sys, mmrs_core.generation.stubs.write, mmrs_core.cli.metamodel, mmrs_core.builtin;"
        "print([each for each in ('pyecoregen', 'multigen', 'pyecore') if each in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said == "[]\n"


@pytest.fixture
def without_pyecoregen(monkeypatch):
    monkeypatch.delitem(sys.modules, generator.__name__)
    monkeypatch.setitem(sys.modules, "pyecoregen", None)
    monkeypatch.setitem(sys.modules, "pyecoregen.ecore", None)


@pytest.mark.usefixtures("without_pyecoregen")
def test_without_pyecoregen_the_extra_is_named_and_nothing_written(tmp_path, capsys):
    made = tmp_path / "made"
    assert run(["--no-plugins", "metamodel", "stubs", str(MODELS / "zoo.ecore"), "-o", str(made)]) == 1
    said = capsys.readouterr()
    assert said.err == (
        'mmrs: pyecoregen: not installed, but stubs are made with it; pip install "mmrs-core[extend]"\n'
    )
    assert said.out == ""
    assert not made.exists()


@pytest.mark.usefixtures("without_pyecoregen")
def test_without_pyecoregen_a_new_plugin_is_not_begun(tmp_path, capsys):
    made = tmp_path / "made"
    assert run(["--no-plugins", "plugin", "new", "roof-wash", "-o", str(made)]) == 1
    assert 'pip install "mmrs-core[extend]"' in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
