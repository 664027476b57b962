"""What Python must call otherwise keeps its name in files, and stubs say what works when a program runs."""

import ast
import runpy

import pytest
from type_checks import mypy

from mmrs_core.generation.stubs.write import write_stubs
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import to_xmi

HARD = {
    "from": "from_",
    "class": "class_",
    "name": "name",
    "import": "import_",
    "self": "self",
    "max.speed": "max_speed",
    "max-speed": "max_speed_",
    "2nd": "_2nd",
    "__dict__": "_dict___",
    "self.": "self_",
}
"""Names of features as in the metamodel, with those in Python."""

HEAD = (
    '<ecore:EPackage xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"'
)
TEXT = "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EString"
NAMED_IN_XML = [name for name in HARD if name != "2nd"]
"""XML has no attribute whose name begins with a digit."""


@pytest.fixture
def hard(tmp_path):
    """Return the file of a metamodel whose features have hard names."""
    features = "".join(
        f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{name}" eType="{TEXT}"/>' for name in HARD
    )
    file = tmp_path / "hard.ecore"
    file.write_text(
        f'{HEAD} name="hard" nsURI="urn:test:hard" nsPrefix="hard">'
        f'<eClassifiers xsi:type="ecore:EClass" name="Hard.Case">{features}</eClassifiers></ecore:EPackage>'
    )
    return file


def features_in(stub):
    """Return the names of the features of each class in a stub, and of the options of its constructor."""
    classes = [each for each in ast.parse(stub.read_text()).body if isinstance(each, ast.ClassDef)]
    found = {}
    for each in classes:
        held = [inner.target.id for inner in each.body if isinstance(inner, ast.AnnAssign)]
        (made,) = [inner for inner in each.body if isinstance(inner, ast.FunctionDef)]
        found[each.name] = held, [argument.arg for argument in made.args.kwonlyargs]
    return found


def strictly(folder, *names):
    """Return what mypy has to say about modules in a folder."""
    done = mypy("--strict", "--no-error-summary", "--hide-error-context", *names, folder=folder)
    assert done.stderr == ""
    return done.stdout


def test_hard_names_have_a_form_in_python_and_the_stub_says_it(hard, tmp_path):
    registry, ns_uris = registry_of_files([hard], ())
    (stub,) = write_stubs(registry, ns_uris, tmp_path)
    assert features_in(stub) == {"Hard_Case": (list(HARD.values()), list(HARD.values()))}


def test_files_keep_the_names_of_the_metamodel(hard, tmp_path):
    registry, (ns_uri,) = registry_of_files([hard], ())
    options = {HARD[name]: f"<{name}>" for name in NAMED_IN_XML}
    element = registry.metaclass(ns_uri, "Hard.Case").interface(**options)
    file = tmp_path / "case.xmi"
    file.write_bytes(to_xmi((element,), registry))
    text = file.read_text()
    assert all(f' {name}="&lt;{name}>"' in text for name in NAMED_IN_XML)
    assert "from_" not in text
    (back,) = read_model(file, registry).roots
    assert metaclass_of(back).name == "Hard.Case"
    assert all(getattr(back, HARD[name]) == f"<{name}>" for name in NAMED_IN_XML)


def test_a_program_that_keeps_to_the_stub_works_and_passes_strict_checks(hard, tmp_path):
    registry, ns_uris = registry_of_files([hard], ())
    write_stubs(registry, ns_uris, tmp_path)
    (tmp_path / "use.py").write_text(
        "from __future__ import annotations\n\nfrom typing import TYPE_CHECKING\n\n"
        "if TYPE_CHECKING:\n    from hard import Hard_Case\n\n\n"
        "def route(case: Hard_Case) -> str:\n"
        '    return (case.from_ or "") + (case.class_ or "") + (case.self or "") + (case.max_speed_ or "")\n'
    )
    assert strictly(tmp_path, "use.py", "hard.pyi") == ""
    program = runpy.run_path(str(tmp_path / "use.py"))
    case = registry.package(ns_uris[0]).member("Hard.Case")(from_="a", class_="b", self="c", max_speed_="d")
    assert program["route"](case) == "abcd"


@pytest.fixture
def circle(tmp_path):
    """Return two files of metamodels that have one name and refer to each other."""
    files = []
    for home, other in (("left", "right"), ("right", "left")):
        file = tmp_path / home / "part.ecore"
        file.parent.mkdir()
        file.write_text(
            f'{HEAD} name="part" nsURI="urn:test:{home}" nsPrefix="{home}">'
            f'<eClassifiers xsi:type="ecore:EClass" name="Part"><eStructuralFeatures'
            f' xsi:type="ecore:EReference" name="import" eType="ecore:EClass ../{other}/part.ecore#//Part"/>'
            "</eClassifiers></ecore:EPackage>"
        )
        files.append(file)
    return files


def test_packages_of_one_name_that_refer_to_each_other_get_modules_of_two_names(circle, tmp_path):
    registry, ns_uris = registry_of_files(circle[:1], ())
    made = write_stubs(registry, ns_uris, tmp_path / "made")
    assert [path.name for path in made] == ["part.pyi", "part_.pyi"]
    assert '"""Typed stubs of urn:test:left,' in made[0].read_text()
    assert '"""Typed stubs of urn:test:right,' in made[1].read_text()
    (tmp_path / "made" / "use.py").write_text(
        "import part\nimport part_\n\n\n"
        "def there(one: part.Part) -> part_.Part | None:\n    return one.import_\n\n\n"
        "def back(one: part.Part) -> part.Part | None:\n"
        "    return one.import_.import_ if one.import_ else None\n"
    )
    assert strictly(tmp_path / "made", "part.pyi", "part_.pyi", "use.py") == ""


def test_stubs_of_a_circle_are_the_same_every_time(circle, tmp_path):
    texts = []
    for _ in range(2):
        registry, ns_uris = registry_of_files(circle, ())
        texts.append([path.read_bytes() for path in write_stubs(registry, ns_uris, tmp_path / "made")])
    assert texts[0] == texts[1]
