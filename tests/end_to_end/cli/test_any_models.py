"""Models of any language: shown, queried, converted, compared and validated from the command line."""

import json
from pathlib import Path

import pytest

from mmrs_core.cli import run

EXAMPLES = Path(__file__).parents[3] / "examples"
LIBRARY = """<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="library"
    nsURI="urn:test:library:1.0" nsPrefix="lib">
  <eClassifiers xsi:type="ecore:EClass" name="Library">
    <eStructuralFeatures xsi:type="ecore:EReference" name="books" upperBound="-1"
        eType="#//Book" containment="true"/>
    <eStructuralFeatures xsi:type="ecore:EReference" name="staff" upperBound="-1"
        eType="ecore:EClass people.ecore#//Person" containment="true"/>
  </eClassifiers>
  <eClassifiers xsi:type="ecore:EClass" name="Book">
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="title" lowerBound="1"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EString"/>
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="pages"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EInt"/>
  </eClassifiers>
</ecore:EPackage>
"""
PEOPLE = """<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="people"
    nsURI="urn:test:people:1.0" nsPrefix="people">
  <eClassifiers xsi:type="ecore:EClass" name="Person">
    <eStructuralFeatures xsi:type="ecore:EAttribute" name="name"
        eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EString"/>
  </eClassifiers>
</ecore:EPackage>
"""
TOWN = """<?xml version="1.0" encoding="UTF-8"?>
<lib:Library xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:lib="urn:test:library:1.0">
  <books title="Solaris" pages="204"/>
  <books title="Fiasco"/>
  <staff name="Ann"/>
</lib:Library>
"""
POINTING = TOWN.replace(
    "<lib:Library ",
    '<lib:Library xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xsi:schemaLocation="urn:test:library:1.0 models/library.ecore" ',
)


@pytest.fixture
def town(tmp_path, monkeypatch):
    """Return a folder with a model that has nothing to do with robots; its metamodels lie elsewhere."""
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "library.ecore").write_text(LIBRARY)
    (tmp_path / "models" / "people.ecore").write_text(PEOPLE)
    (tmp_path / "town.xmi").write_text(TOWN)
    (tmp_path / "pointing.xmi").write_text(POINTING)
    monkeypatch.chdir(tmp_path)
    return tmp_path


GIVEN = ("--metamodel", "models/library.ecore")


def test_a_model_is_shown_by_the_metamodel_that_is_given_and_those_it_needs(town, capsys):
    assert run(["show", "town.xmi", *GIVEN]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "Library",
        "├─ books: Book title=Solaris pages=204",
        "├─ books: Book title=Fiasco",
        "└─ staff: Person name=Ann",
    ]


def test_a_metamodel_is_found_where_the_model_points_to(town, capsys):
    assert run(["show", "pointing.xmi", "--path", "//Book[pages>100].title"]) == 0
    assert capsys.readouterr().out == "/books[0]/title: Solaris\n"


def test_a_metamodel_is_found_beside_the_model(town, capsys):
    (town / "models" / "town.xmi").write_text(TOWN)
    assert run(["show", "models/town.xmi", "--path", "staff", "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["found"]
    assert (found["path"], found["line"], found["value"]["name"]) == ("/staff[0]", 5, "Ann")


def test_without_its_metamodel_a_model_is_told_to_be_unknown(town, capsys):
    assert run(["show", "town.xmi"]) == 0
    out, err = capsys.readouterr()
    assert out == "Library (unknown, of urn:test:library:1.0)\n"
    assert "give it by --metamodel" in err


def test_a_metamodel_outside_the_reach_of_a_path_is_not_opened(town, capsys):
    for place in ("/etc/passwd", "file:///etc/x.ecore", "http://127.0.0.1:9/x.ecore", "town.xmi"):
        (town / "bad.xmi").write_text(POINTING.replace("models/library.ecore", place))
        assert run(["show", "bad.xmi"]) == 0
        assert "(unknown, of urn:test:library:1.0)" in capsys.readouterr().out


def test_a_path_that_breaks_is_wrong_usage_and_one_to_nothing_is_not(town, capsys):
    assert run(["show", "pointing.xmi", "--path", "bookz"]) == 2
    assert "no feature bookz of Library; did you mean books?" in capsys.readouterr().err
    assert run(["show", "pointing.xmi", "--path", "books[title=Solari]"]) == 1
    assert "none of 2 elements is so; did you mean Solaris?" in capsys.readouterr().err


def test_a_model_of_any_language_is_validated_by_its_metamodel(town, capsys):
    assert run(["validate", "town.xmi", *GIVEN]) == 0
    (town / "town.xmi").write_text(TOWN.replace('title="Fiasco"', 'titel="Fiasco"'))
    assert run(["validate", "town.xmi", *GIVEN]) == 1
    assert "town.xmi:4: error: Book: title is missing [ECO001]" in capsys.readouterr().err


def test_a_model_goes_to_json_and_back_byte_for_byte(town, capsys):
    assert run(["convert", "town.xmi", "town.json", *GIVEN]) == 0
    assert run(["convert", "town.json", "back.xmi", *GIVEN]) == 0
    assert (town / "back.xmi").read_text() == TOWN
    capsys.readouterr()
    assert run(["convert", "pointing.xmi"]) == 0
    assert json.loads(capsys.readouterr().out)["$type"] == "lib:Library"


def test_where_its_metamodel_lies_goes_along_to_another_folder(town, capsys):
    (town / "far").mkdir()
    assert run(["convert", "pointing.xmi", "far/town.json"]) == 0
    assert json.loads((town / "far" / "town.json").read_text())["$schemaLocation"] == {
        "urn:test:library:1.0": "../models/library.ecore"
    }
    capsys.readouterr()
    assert run(["show", "far/town.json", "--path", "books[1].title"]) == 0
    assert capsys.readouterr().out == "/books[1]/title: Fiasco\n"


def test_convert_replaces_nothing_unless_told_to(town, capsys):
    (town / "there.json").write_text("mine")
    assert run(["convert", "town.xmi", "there.json"]) == 2
    assert (town / "there.json").read_text() == "mine"
    assert run(["convert", "town.xmi", "there.json", "--force"]) == 0
    assert run(["convert", "town.xmi", "town.xmi", "--force"]) == 2


def test_convert_refuses_a_model_of_which_something_would_be_lost(town, capsys):
    (town / "town.xmi").write_text(TOWN.replace("title=", "titel="))
    assert run(["convert", "town.xmi", "town.json", *GIVEN]) == 1
    assert not (town / "town.json").exists()
    assert "something of it would be lost" in capsys.readouterr().err


def test_convert_guesses_nothing_about_json_of_a_missing_language(town, capsys):
    (town / "far.json").write_text('{"$type": "urn:far#Thing", "x": 1}')
    assert run(["convert", "far.json", "far.xmi"]) == 1
    assert "install what brings it, or keep the model as JSON" in capsys.readouterr().err


def test_diff_lists_what_changed_and_ends_with_one_and_nothing_in_another_format(town, capsys):
    (town / "new.xmi").write_text(POINTING.replace('pages="204"', 'pages="205"').replace("Ann", "Bea"))
    assert run(["diff", "pointing.xmi", "new.xmi"]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "- /staff[0] Person Ann",
        "~ /books[0] Book Solaris",
        "    pages: 204 → 205",
        "+ /staff[0] Person Bea",
        "1 added, 1 removed, 1 changed",
    ]
    assert run(["convert", "pointing.xmi", "town.json"]) == 0
    capsys.readouterr()
    assert run(["diff", "pointing.xmi", "town.json", "--json"]) == 0
    counts = {"added": 0, "removed": 0, "moved": 0, "changed": 0}
    assert json.loads(capsys.readouterr().out) == {"equal": True, "counts": counts, "changes": []}


def test_diff_compares_projects_model_by_model(tmp_path, capsys):
    for name in ("pool", "mixed-team"):
        assert run(["diff", str(EXAMPLES / name), str(EXAMPLES / name)]) == 0
    assert run(["diff", str(EXAMPLES / "pool"), str(EXAMPLES / "mixed-team"), "--json"]) == 1
    models = {change["model"] for change in json.loads(capsys.readouterr().out.split("\n", 2)[2])["changes"]}
    assert models >= {"context", "mission", "robots/pool-auv", "robots/crawler"}


def test_a_model_that_cannot_be_read_wholly_is_not_compared(town, capsys):
    (town / "bad.xmi").write_text(POINTING.replace("title=", "titel="))
    assert run(["diff", "pointing.xmi", "bad.xmi"]) == 3
    assert "bad.xmi: not compared, since something of it cannot be read" in capsys.readouterr().err


def test_metamodel_diff_says_whether_old_models_load(town, capsys):
    new = town / "new.ecore"
    new.write_text(
        LIBRARY.replace('name="pages"', 'name="sheets"').replace("people.ecore", "models/people.ecore")
    )
    assert run(["metamodel", "diff", "models/library.ecore", "new.ecore"]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "- Book.pages: the feature (incompatible: older models may say it; "
        "if it is sheets now, a migration has to say so)",
        "+ Book.sheets: the feature (compatible)",
        "compared: models/library.ecore with new.ecore",
        "1 incompatible change: not all old models load",
    ]
    assert run(["metamodel", "diff", "urn:mmrs:mission:1.0", "urn:mmrs:mission:1.0", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["old_models_load"] is True
    assert run(["metamodel", "diff", "gone.ecore", "models/library.ecore"]) == 3
    assert run(["metamodel", "diff", "urn:mmrs:misson:1.0", "models/library.ecore"]) == 3
    assert "did you mean urn:mmrs:mission:1.0?" in capsys.readouterr().err


def test_metamodel_diff_follows_the_files_that_are_referred_to(town, capsys):
    (town / "new").mkdir()
    (town / "new" / "library.ecore").write_text(LIBRARY)
    (town / "new" / "people.ecore").write_text(PEOPLE.replace('name="name"', 'name="fullName"'))
    assert run(["metamodel", "diff", "models/library.ecore", "new/library.ecore", "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["old_models_load"] is False
    assert [each["what"] for each in told["differences"]] == ["people:Person.name", "people:Person.fullName"]
    assert told["compared"][1] == {"old": "models/people.ecore", "new": "new/people.ecore"}


@pytest.fixture
def json_project(tmp_path):
    """Return the pool as JSON."""
    project = tmp_path / "pool"
    (project / "robots").mkdir(parents=True)
    for file in sorted((EXAMPLES / "pool").rglob("*.xmi")):
        target = (project / file.relative_to(EXAMPLES / "pool")).with_suffix(".json")
        assert run(["convert", str(file), str(target)]) == 0
    return project


def test_a_project_of_json_is_validated_planned_and_checked(json_project, capsys):
    assert run(["validate", str(json_project)]) == 0
    assert run(["plan", str(json_project), "-o", str(json_project / "behaviour.json")]) == 0
    assert run(["check", str(json_project)]) == 0
    assert json.loads((json_project / "behaviour.json").read_text())["$type"] == "behaviour:Behaviour"


def test_faults_in_json_are_told_with_file_and_line(json_project, capsys):
    mission = json_project / "mission.json"
    lines = mission.read_text().splitlines()
    place = next(index for index, line in enumerate(lines) if '"acceptedUnknowns"' in line)
    lines[place] = lines[place].replace("acceptedUnknowns", "acceptedUnknown")
    mission.write_text("\n".join(lines))
    assert run(["validate", str(json_project)]) == 1
    assert f"mission.json:{place + 1}: error: acceptedUnknown: no feature" in capsys.readouterr().err


def test_a_project_with_a_model_in_both_forms_is_refused(json_project, capsys):
    (json_project / "mission.xmi").write_bytes((EXAMPLES / "pool" / "mission.xmi").read_bytes())
    assert run(["validate", str(json_project)]) == 3
    assert "has both mission.xmi and mission.json; keep one of them" in capsys.readouterr().err


@pytest.mark.parametrize("form", ["xmi", "json"])
def test_a_mission_whose_plug_in_is_missing_names_it_and_refuses_to_plan(json_project, form, capsys):
    project = EXAMPLES / "pool" if form == "xmi" else json_project
    output = json_project / f"plan.{form}"
    assert run(["plan", str(project), "-o", str(output), "--no-plugins"]) == 1
    assert "install the one that provides urn:mmrs:auv:1.1, such as mmrs-auv" in capsys.readouterr().err
    assert not output.exists()


def test_a_number_without_end_is_valid_where_nobody_flies_by_it(town, capsys):
    library = LIBRARY.replace("//EInt", "//EDouble")
    (town / "models" / "library.ecore").write_text(library)
    (town / "town.xmi").write_text(TOWN.replace("204", "Infinity"))
    assert run(["validate", "town.xmi", *GIVEN]) == 0
    assert "warning: Book: pages is Infinity, not a finite number" in capsys.readouterr().err


def test_a_folder_that_is_missing_is_named_by_the_file_asked_for(town, capsys):
    assert run(["convert", "pointing.xmi", "nowhere/town.json"]) == 3
    assert capsys.readouterr().err == "mmrs: nowhere/town.json: no such file or directory\n"


@pytest.mark.parametrize(("form", "pages"), [("xmi", " pages="), ("json", '"pages":')])
def test_a_model_of_any_language_is_fixed(town, form, pages):
    file = town / f"fixed.{form}"
    assert run(["convert", "pointing.xmi", file.name, "--to", form]) == 0
    text = file.read_text()
    file.write_text(text.replace(pages, pages.replace("pages", "pagse")))
    assert run(["validate", file.name, "--fix", "--yes"]) == 0
    assert file.read_text() == text


@pytest.mark.parametrize(("target", "is_told"), [("town.json", False), ("models/town.json", True)])
def test_links_of_what_is_kept_are_told_where_they_go_to_another_folder(town, capsys, target, is_told):
    (town / "kite.xmi").write_text('<k:Kite xmlns:k="urn:kites:1.0"><line href="sky.xmi#/"/></k:Kite>')
    assert run(["convert", "kite.xmi", target]) == 0
    assert ("note: elements of languages that are not installed" in capsys.readouterr().err) is is_told
