"""Stubs of any metamodel: complete, without a name that hides another, and right for type checkers."""

import ast
import builtins
from pathlib import Path

import pytest
from type_checks import mypy

from mmrs_core.errors import MmrsError, PluginError
from mmrs_core.generation.stubs.view import docstring
from mmrs_core.generation.stubs.write import write_stubs
from mmrs_core.languages.metamodels.gathering import registry_of_files

HERE = Path(__file__).parent
PROJECT = HERE.parents[3]
AWKWARD = HERE / "awkward.ecore"
ZOO = PROJECT / "tests" / "fixtures" / "models" / "zoo.ecore"
SURVEY = PROJECT / "plugins" / "survey" / "mmrs_survey" / "metamodels" / "survey.ecore"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("stubs")
    for file in (AWKWARD, ZOO, SURVEY):
        registry, ns_uris = registry_of_files([file], ())
        write_stubs(registry, ns_uris, made)
    return made


@pytest.fixture(scope="module")
def type_checked(folder):
    """Return a function that has mypy check files beside the stubs, and gives its complaints."""

    def check(*files):
        run = mypy("--strict", "--no-error-summary", "--hide-error-context", *files, folder=folder)
        assert run.stderr == ""
        return run.stdout.splitlines()

    return check


def test_stubs_pass_the_strictest_checks(folder, type_checked):
    stubs = sorted(folder.glob("*.pyi"))
    assert [path.name for path in stubs] == ["survey.pyi", "typing_.pyi", "wing.pyi", "zoo.pyi"]
    assert type_checked(*stubs) == []


USE = """
import zoo
from survey import PhotoGridTask
from typing_ import Element, Two_words
from mmrs_core.languages.mission import Mission

def right(task: PhotoGridTask, place: zoo.Zoo, odd: Element) -> float:
    place.animals.append(zoo.Otter(name="Ottilie", depth=3, cubs=[zoo.Lion(name="Leo", mood="CALM")]))
    mission: Mission | None = odd.mission
    text: str = odd.from_
    return (task.altitude or 0.0) + len(text) + (odd.str or 0)

def wrong(task: PhotoGridTask, place: zoo.Zoo, odd: Element) -> None:
    task.altitud
    place.animals.append(zoo.Keeper())
    zoo.Lion(mood="SLEEPY")
    place.name.upper()
    Two_words(int="one")
"""


def test_type_checkers_find_wrong_uses_and_no_others(folder, type_checked):
    use = folder / "use.py"
    use.write_text(USE)
    complaints = type_checked(use)
    lines = {int(complaint.split(":")[1]) for complaint in complaints if ": error:" in complaint}
    first = (
        USE.splitlines().index("def wrong(task: PhotoGridTask, place: zoo.Zoo, odd: Element) -> None:") + 2
    )
    assert lines == set(range(first, first + 5)), complaints


@pytest.mark.parametrize("name", ["survey", "typing_", "wing", "zoo"])
def test_no_name_of_a_stub_means_two_things(folder, name):
    tree = ast.parse((folder / f"{name}.pyi").read_text())
    bound = [each for statement in tree.body for each in names_bound_by(statement)]
    assert len(bound) == len(set(bound))
    for statement in tree.body:
        if isinstance(statement, ast.ClassDef):
            own = {each for inner in statement.body for each in names_bound_by(inner)}
            for used in names_used_in(statement):
                assert used not in own
                assert used in bound or hasattr(builtins, used)


def names_bound_by(statement):
    if isinstance(statement, ast.AnnAssign):
        return [statement.target.id]
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return [alias.asname or alias.name for alias in statement.names]
    return [statement.name] if isinstance(statement, ast.ClassDef | ast.FunctionDef) else []


def names_used_in(statement):
    annotations = [inner.annotation for inner in statement.body if isinstance(inner, ast.AnnAssign)]
    for inner in statement.body:
        if isinstance(inner, ast.FunctionDef):
            annotations += [argument.annotation for argument in inner.args.kwonlyargs]
    return {node.id for each in annotations for node in ast.walk(each) if isinstance(node, ast.Name)} - {
        "Ellipsis"
    }


def test_every_class_and_feature_is_in_its_stub(folder):
    registry, (ns_uri, *_) = registry_of_files([AWKWARD], ())
    text = (folder / "typing_.pyi").read_text()
    for metaclass in registry.package(ns_uri).metaclasses:
        for feature in metaclass.features:
            assert f"    {feature.attribute}: " in text


def test_features_that_come_from_ecore_itself_are_in_the_stub(tmp_path):
    uri = "http://www.eclipse.org/emf/2002/Ecore"
    body = (
        '<eClassifiers xsi:type="ecore:EClass" name="Own"/>'
        f'<eClassifiers xsi:type="ecore:EClass" name="Note" eSuperTypes="{uri}#//ENamedElement #//Own"/>'
    )
    (tmp_path / "notes.ecore").write_text(
        f'<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:ecore="{uri}" '
        f'name="notes" nsURI="urn:notes">{body}</ecore:EPackage>'
    )
    registry, ns_uris = registry_of_files([tmp_path / "notes.ecore"], ())
    write_stubs(registry, ns_uris, tmp_path)
    stub = (tmp_path / "notes.pyi").read_text()
    assert "class Note(Own):\n    eAnnotations: list[Element]\n    name: str | None" in stub


def test_a_stub_in_a_package_imports_its_neighbours_from_there(tmp_path):
    package = tmp_path / "animals" / "models"
    package.mkdir(parents=True)
    for each in (package, package.parent):
        (each / "__init__.py").touch()
    registry, ns_uris = registry_of_files([ZOO], ())
    write_stubs(registry, ns_uris, package)
    assert "from animals.models import zoo as _zoo" in (package / "wing.pyi").read_text()


def test_stubs_are_replaced_but_nothing_that_somebody_else_wrote(tmp_path):
    registry, ns_uris = registry_of_files([ZOO], ())
    first = write_stubs(registry, ns_uris, tmp_path)
    assert write_stubs(registry, ns_uris, tmp_path) == first
    (tmp_path / "wing.pyi").write_text("mine: int\n")
    (tmp_path / "zoo.pyi").unlink()
    with pytest.raises(MmrsError, match=r"wing\.pyi: not made by this command"):
        write_stubs(registry, ns_uris, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["wing.pyi"]
    assert (tmp_path / "wing.pyi").read_text() == "mine: int\n"


def test_metamodels_that_one_refers_to_get_their_stubs_as_well(tmp_path):
    zoo_file = tmp_path / "zoo.ecore"
    zoo_file.write_bytes(ZOO.read_bytes())
    other = tmp_path / "aviary" / "aviary.ecore"
    other.parent.mkdir()
    other.write_text(
        '<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
        ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="aviary" nsURI="urn:test:aviary">'
        '<eClassifiers xsi:type="ecore:EClass" name="Cage" eSuperTypes="../zoo.ecore#//Zoo"/>'
        "</ecore:EPackage>"
    )
    registry, ns_uris = registry_of_files([other], ())
    made = write_stubs(registry, ns_uris, tmp_path / "out")
    assert [path.name for path in made] == ["aviary.pyi", "zoo.pyi"]


def test_a_metamodel_that_refers_to_one_that_is_missing_is_refused(tmp_path):
    lonely = tmp_path / "lonely.ecore"
    lonely.write_text(
        '<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="lonely" nsURI="urn:test:lonely">'
        '<eClassifiers xsi:type="ecore:EClass" name="A" eSuperTypes="../gone.ecore#//B"/></ecore:EPackage>'
    )
    with pytest.raises(PluginError, match=r"lonely\.ecore.*gone\.ecore"):
        registry_of_files([lonely], ())


@pytest.mark.parametrize("text", ['"', '""', '"""', "\\", 'a\\"', "a\nb\n", "\u202e", "tab\there", ""])
def test_no_text_can_end_a_docstring_or_change_what_it_says(text):
    found = ast.literal_eval(docstring(text))
    assert found.split() == text.split()
