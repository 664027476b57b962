"""Models that are converted together refer to each other as before, and all are written or none."""

import json
import shutil
from pathlib import Path

import pytest

from mmrs_core.cli import run

ROOT = Path(__file__).parents[3]
DAM = ROOT / "examples" / "mixed-team"
ZOO = ROOT / "tests" / "fixtures" / "models" / "zoo.ecore"
HEAD = (
    '<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:zoo="urn:test:zoo"\n'
    '    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">\n'
)
ONE = """  <zoo:Zoo name="north">
    <animals xsi:type="zoo:Otter" href="{other}.xmi#/1"/>
  </zoo:Zoo>
  <zoo:Otter name="{name}"/>
</xmi:XMI>
"""


@pytest.fixture
def zoos(tmp_path, monkeypatch):
    """Go to a folder with two files, each of which contains a part that stands in the other."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(ZOO, tmp_path / "zoo.ecore")
    (tmp_path / "a.xmi").write_text(HEAD + ONE.format(other="b", name="Olga"), encoding="utf-8")
    (tmp_path / "b.xmi").write_text(HEAD + ONE.format(other="a", name="Otto"), encoding="utf-8")
    return tmp_path


def refs(file):
    return [each["$ref"] for each in json.loads(file.read_text(encoding="utf-8"))["$roots"][0]["animals"]]


def test_files_that_contain_each_others_parts_go_on_doing_so(zoos):
    assert run(["convert", "a.xmi", "b.xmi", "-o", "out", "--metamodel", "zoo.ecore"]) == 0
    assert refs(zoos / "out" / "a.json") == ["b.json#/1"]
    assert refs(zoos / "out" / "b.json") == ["a.json#/1"]


def test_comments_are_counted_since_they_are_left_out(zoos, capsys):
    (zoos / "a.xmi").write_text(f"<!-- 1 -->{HEAD}<!-- 2 -->" + ONE.format(other="b", name="Olga"))
    known = ["--metamodel", "zoo.ecore"]
    for into in (["-o", "out"], ["b.json"], []):
        assert run(["convert", "a.xmi", *into, *known]) == 0
        assert "a.xmi: note: 2 comments left out" in capsys.readouterr().err
    assert run(["convert", "a.xmi", "c.json", *known, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["comments_left_out"] == 2


def test_an_output_with_the_suffix_of_a_model_is_a_file(zoos, capsys):
    known = ["--metamodel", "zoo.ecore"]
    assert run(["convert", "a.xmi", "-o", "c.json", *known]) == 0
    assert refs(zoos / "c.json") == ["b.xmi#/1"]
    assert run(["convert", "a.xmi", "b.xmi", "-o", "d.json", *known]) == 2
    assert "-o d.json: one file for several models; name an output folder" in capsys.readouterr().err


def test_comments_before_elements_stay_in_xmi(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (DAM / "mission.xmi").read_text(encoding="utf-8").replace("  <team>", "  <team> <!-- aside -->", 1)
    (tmp_path / "mission.xmi").write_text(
        text.replace("<!-- 9 -->", "<!-- 9:\n       again -->\n  <!-- & -->")
    )
    assert run(["convert", "mission.xmi", "other.xmi"]) == 0
    assert "mission.xmi: note: 1 comment left out\n" in capsys.readouterr().err
    lines = [line.strip() for line in (tmp_path / "other.xmi").read_text(encoding="utf-8").splitlines()]
    assert lines[lines.index("<!-- 9:") :][:4] == [
        "<!-- 9:",
        "again",
        "& -->",
        lines[lines.index("again") + 2],
    ]
    assert lines[1].startswith("<!-- Inspection of a dam")
    assert sum(line.count("<!--") for line in lines) == text.count("<!--") - 1
    assert run(["diff", "mission.xmi", "other.xmi"]) == 0


def test_back_again_they_say_the_same(zoos, capsys):
    known = ["--metamodel", "zoo.ecore"]
    assert run(["convert", "a.xmi", "b.xmi", "-o", "there", *known]) == 0
    assert run(["convert", "there/a.json", "there/b.json", "-o", "back", *known]) == 0
    assert run(["diff", "a.xmi", "back/a.xmi", *known]) == 0
    assert (zoos / "back" / "a.xmi").read_text(encoding="utf-8").count("b.xmi#/1") == 1


def test_a_file_that_is_not_converted_is_referred_to_where_it_is(zoos, capsys):
    assert run(["convert", "a.xmi", "-o", "out/deep", "--metamodel", "zoo.ecore"]) == 0
    assert refs(zoos / "out" / "deep" / "a.json") == ["../../b.xmi#/1"]
    assert "b.xmi: note: referred to, and not converted" in capsys.readouterr().err


def test_a_project_is_converted_whole(tmp_path, capsys):
    assert run(["convert", str(DAM), "-o", str(tmp_path / "dam")]) == 0
    assert len(list((tmp_path / "dam").rglob("*.json"))) == len(list(DAM.rglob("*.xmi"))) == 5
    assert run(["validate", str(tmp_path / "dam")]) == 0
    assert run(["diff", str(DAM), str(tmp_path / "dam")]) == 0


def test_a_form_may_be_wanted_that_files_have_already(zoos):
    assert run(["convert", "a.xmi", "b.xmi", "-o", "out", "--to", "xmi", "--metamodel", "zoo.ecore"]) == 0
    assert 'href="b.xmi#/1"' in (zoos / "out" / "a.xmi").read_text(encoding="utf-8")


def test_nothing_is_written_if_one_model_would_lose_something(zoos, capsys):
    (zoos / "b.xmi").write_text(HEAD + '  <zoo:Zoo nmae="b"/>\n</xmi:XMI>\n', encoding="utf-8")
    assert run(["convert", "a.xmi", "b.xmi", "-o", "out", "--metamodel", "zoo.ecore"]) == 1
    assert not (zoos / "out").exists()
    assert "b.xmi:3: error: nmae: no feature of Zoo" in capsys.readouterr().err


def test_nothing_is_written_if_one_file_exists(zoos, capsys):
    (zoos / "out").mkdir()
    (zoos / "out" / "b.json").write_text("mine", encoding="utf-8")
    assert run(["convert", "a.xmi", "b.xmi", "-o", "out", "--metamodel", "zoo.ecore"]) == 2
    assert [file.name for file in (zoos / "out").iterdir()] == ["b.json"]
    assert run(["convert", "a.xmi", "b.xmi", "-o", "out", "--metamodel", "zoo.ecore", "--force"]) == 0
    assert refs(zoos / "out" / "b.json") == ["a.json#/1"]


def test_inputs_are_not_replaced(zoos, capsys):
    assert run(["convert", "a.xmi", "b.xmi", "-o", ".", "--to", "xmi", "--metamodel", "zoo.ecore"]) == 2
    assert "is read by this command" in capsys.readouterr().err


def test_two_models_do_not_go_to_one_file(tmp_path, capsys):
    shutil.copytree(DAM, tmp_path / "dam")
    assert (
        run(["convert", str(tmp_path / "dam" / "mission.xmi"), str(tmp_path / "dam" / "mission.json")]) == 0
    )
    assert run(["convert", str(tmp_path / "dam"), "-o", str(tmp_path / "out")]) == 3
    assert "and so would" in capsys.readouterr().err


def test_three_files_need_a_folder_to_go_to(zoos, capsys):
    assert run(["convert", "a.xmi", "b.xmi", "c.xmi"]) == 2
    assert "-o DIR" in capsys.readouterr().err


def test_a_metamodel_is_shown_by_its_classes_as_a_tree_and_as_json(capsys):
    assert run(["show", str(ZOO)]) == 0
    told = capsys.readouterr().out
    assert told.startswith("zoo urn:test:zoo (")
    assert "├─ abstract class Animal\n│  ├─ name: EString [1..1]\n" in told
    assert "│  ├─ animals: contains Animal [0..*]\n" in told
    assert run(["show", str(ZOO), "--json"]) == 0
    animal = json.loads(capsys.readouterr().out)["packages"][0]["classes"][1]
    assert (animal["name"], animal["features"][0]["lower"]) == ("Animal", 1)


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        (["show", ZOO, "--path", "x"], 2, "--path"),
        (["diff", ZOO, DAM / "mission.xmi"], 3, "zoo.ecore: is a metamodel"),
        (["convert", ZOO], 3, "a metamodel, not a model"),
    ],
)
def test_a_metamodel_is_no_model(line, code, said, capsys):
    assert run(list(map(str, line))) == code
    assert said in capsys.readouterr().err


def test_two_metamodels_are_compared_as_metamodels(tmp_path, capsys):
    newer = tmp_path / "zoo.ecore"
    text = ZOO.read_text(encoding="utf-8").replace('name="badge"', 'name="label"')
    newer.write_text(text, encoding="utf-8")
    assert run(["diff", str(ZOO), str(newer)]) == 1
    assert "not all old models load" in capsys.readouterr().out


def test_a_sound_metamodel_is_said_to_be_one(tmp_path, capsys):
    assert run(["validate", str(ZOO)]) == 0
    assert "a sound metamodel (" in capsys.readouterr().out
    broken = tmp_path / "zoo.ecore"
    broken.write_text(ZOO.read_text(encoding="utf-8").replace("#//Mood", "#//Mod"), encoding="utf-8")
    assert run(["validate", str(broken)]) == 1
    assert "no type Mod" in capsys.readouterr().err


SOLAR = ROOT / "examples" / "solar-park"


@pytest.fixture
def named(tmp_path, monkeypatch, capsys):
    """Go to a folder with the solar park, and the same by name."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(SOLAR, "park")
    assert run(["convert", "park", "-o", "named", "--to", "xmi", "--names"]) == 0
    assert "named/mission.xmi: note: 9 references by name\n" in capsys.readouterr().err
    return tmp_path


def test_references_become_names_on_request(named, capsys):
    mission = (named / "named" / "mission.xmi").read_text(encoding="utf-8")
    assert 'group="south field"' in mission
    assert 'from="overview complete" to="hot panels"' in mission
    assert "//@" not in mission
    assert run(["validate", "named"]) == 0
    assert run(["diff", "park", "named"]) == 0


def test_a_model_by_name_is_converted_to_paths_for_eclipse(named, capsys):
    for source, target in (("named", "back"), ("park", "plain")):
        assert run(["convert", source, "-o", target, "--to", "xmi"]) == 0
    for file in ("mission.xmi", "context.xmi", "robots/thermal-drone.xmi"):
        assert (named / "back" / file).read_bytes() == (named / "plain" / file).read_bytes()


def test_a_model_alone_is_converted_by_the_names_beside_it(named, capsys):
    assert run(["convert", "named/mission.xmi", "named/again.json", "--names", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["references"] == {"by_name": 9, "by_path": {}}
    assert '"group": "south field"' in (named / "named" / "again.json").read_text(encoding="utf-8")
    assert run(["diff", "named/mission.xmi", "named/again.json"]) == 0


def test_references_that_stay_paths_are_counted_with_the_reason(named, capsys):
    context = named / "park" / "context.xmi"
    context.write_text(context.read_text(encoding="utf-8").replace("east field", "south field"), "utf-8")
    assert run(["convert", "park/mission.xmi", "--to", "xmi", "--names"]) == 0
    said = capsys.readouterr()
    assert "6 references by name, 3 by path, to elements with a name that others have (3)\n" in said.err
    assert said.out.count('href="context.xmi#//@elements.') == 3


def test_a_name_of_two_elements_is_refused_with_both(named, capsys):
    mission = named / "named" / "mission.xmi"
    text = mission.read_text(encoding="utf-8").replace("rows of the east field", "rows of the south field")
    mission.write_text(text, encoding="utf-8")
    assert run(["convert", "named", "-o", "out"]) == 1
    said = capsys.readouterr().err
    assert (
        "named/mission.xmi:25: error: from: 'rows of the south field' is the name of ThermalRowTask" in said
    )
    assert not (named / "out").exists()
