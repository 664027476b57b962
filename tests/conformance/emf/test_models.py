"""Models that we write, and EMF reads and writes again."""

import shutil
from pathlib import Path

import pytest
from emf_description import model_lines

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.metamodels.export import export_metamodels, schema_locations
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import write_model

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]

ZOO = "urn:test:zoo"
HEAD = (
    '<zoo:Zoo xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmi:version="2.0" xmlns:zoo="urn:test:zoo" xmlns:wing="urn:test:zoo:wing" '
)
RICH = """name="&lt;&amp;&quot;' &#xA;&#x9;>" star="//@animals.0" favourites="//@animals.2 //@animals.0">
<animals xsi:type="zoo:Lion" name="L" mood="is-hungry" hungry="ANGRY" age="0" teeth="30"
  keptBy="B2 B1" weight="1e-5"
  born="2024-05-01T10:11:12.123+0000" chip="0AFF" cage="-12" price="1.50" speed="2.5" steps="7"
  grade="x" shade="a">
  <moods>is-calm</moods><tags>a &lt;b> ]]&gt;</tags><tags></tags><weights>1e7</weights>
  <cubs xsi:type="zoo:Otter" name="cub" mate="//@animals.1"/>
</animals>
<animals xsi:type="zoo:Otter" name="O" depth="0.0"/>
<animals xsi:type="wing:Parrot" name="P" xmi:id="_p"><nest eggs="2"/></animals>
<keepers badge="B1" keeps="//@animals.0"/><keepers badge="B2" deputy="B1" keeps="//@animals.1 //@animals.0"/>
<keepers/>
<notes key="k" value="v"/><notes/>
</zoo:Zoo>"""


@pytest.fixture
def rewritten(referee, tmp_path):
    """Return a function that lets EMF read and write a file, and returns its faults and what it wrote."""

    def rewrite(file):
        out = tmp_path / f"{file.name}.emf"
        return referee.ask("save", file, out).faults, out.read_bytes()

    return rewrite


def test_emf_writes_what_we_write(rewritten, registry, tmp_path):
    (tmp_path / "rich.xmi").write_text(HEAD + RICH)
    model = read_model(tmp_path / "rich.xmi", registry)
    assert model.diagnostics == ()
    assert check_conformance(model, registry) == ()
    write_model(model.roots, tmp_path / "ours.xmi", registry)
    assert rewritten(tmp_path / "ours.xmi") == ([], (tmp_path / "ours.xmi").read_bytes())


def test_emf_reads_our_nil_though_it_would_not_write_it(rewritten, registry, tmp_path):
    (tmp_path / "nil.xmi").write_text(
        f'{HEAD}><animals xsi:type="zoo:Lion" name="l"><motto xsi:nil="true"/></animals></zoo:Zoo>'
    )
    write_model(read_model(tmp_path / "nil.xmi", registry).roots, tmp_path / "ours.xmi", registry)
    assert b'<motto xsi:nil="true"/>' in (tmp_path / "ours.xmi").read_bytes()
    faults, theirs = rewritten(tmp_path / "ours.xmi")
    assert faults == []
    assert b"motto" not in theirs


FOLDER = Path(__file__).parents[3] / "examples"
EXAMPLES = sorted(FOLDER.rglob("*.xmi"))


def test_there_are_examples():
    assert len(EXAMPLES) > 10


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: "-".join(path.parts[-3:]))
def test_emf_accepts_every_example_and_writes_it_as_we_do(rewritten, registry, tmp_path, example):
    model = read_model(example, registry, root=example.parents[1])
    assert model.diagnostics == ()
    write_model(model.roots, tmp_path / "ours.xmi", registry)
    assert rewritten(tmp_path / "ours.xmi") == ([], (tmp_path / "ours.xmi").read_bytes())


@pytest.mark.parametrize("project", sorted({path.relative_to(FOLDER).parts[0] for path in EXAMPLES}))
def test_eclipse_opens_every_example_by_schema_location_alone(
    referee, registry, tmp_path, project, exported_folder
):
    shutil.copytree(FOLDER / project, tmp_path / project)
    files = sorted((tmp_path / project).rglob("*.xmi"))
    for file in files:
        model = read_model(file, registry, root=tmp_path / project)
        places = schema_locations(registry, exported_folder, file)
        write_model(model.roots, file, registry, schema_location=places)
    assert [referee.ask("alone", "check", file).faults for file in files] == [[]] * len(files)


def test_without_schema_location_eclipse_finds_no_metamodel(referee):
    assert not referee.ask("alone", "check", EXAMPLES[0]).accepted


def test_emf_writes_references_to_other_files_as_we_do(rewritten, registry, tmp_path):
    lion = '<animals xsi:type="zoo:Lion" name="l"/>'
    (tmp_path / "far.xmi").write_text(f'{HEAD} name="far">{lion}</zoo:Zoo>')
    (tmp_path / "near.xmi").write_text(
        f'{HEAD} name="near">{lion}<star xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/>'
        '<favourites xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/>'
        '<favourites xsi:type="zoo:Lion" href="#//@animals.0"/></zoo:Zoo>'
    )
    model = read_model(tmp_path / "near.xmi", registry)
    write_model(model.roots, tmp_path / "ours.xmi", registry)
    assert rewritten(tmp_path / "ours.xmi") == ([], (tmp_path / "ours.xmi").read_bytes())


def test_paths_of_a_workspace_mean_to_emf_what_they_mean_to_us(referee, registry, tmp_path):
    project = tmp_path / "project"
    (project / "sub").mkdir(parents=True)
    (project / "far.xmi").write_text(f'{HEAD} name="far"><animals xsi:type="zoo:Lion" name="l"/></zoo:Zoo>')
    near = project / "sub" / "near.xmi"
    near.write_text(
        f'{HEAD} name="near"><star xsi:type="zoo:Lion" '
        'href="platform:/resource/project/far.xmi#//@animals.0"/></zoo:Zoo>'
    )
    referee.ask("workspace", "project", project)
    model = read_model(near, registry, root=project)
    write_model(model.roots, project / "sub" / "ours.xmi", registry)
    answer = referee.ask("equal", near, project / "sub" / "ours.xmi")
    assert (answer.faults, "EQUAL" in answer.lines) == ([], True)


def test_emf_writes_several_roots_as_we_do(rewritten, registry, tmp_path):
    lions = [registry.create(ZOO, "Lion", name=name) for name in "ab"]
    lions[0].mate = lions[1]
    write_model([*lions, registry.create(ZOO, "Zoo", star=lions[1])], tmp_path / "ours.xmi", registry)
    assert rewritten(tmp_path / "ours.xmi") == ([], (tmp_path / "ours.xmi").read_bytes())


def test_packages_inside_packages_are_found_by_schema_location(referee, registry, tmp_path, exported_folder):
    nest = registry.create("urn:test:zoo:wing", "Nest", eggs=2)
    parrot = registry.create("urn:test:zoo:wing", "Parrot", name="p", nest=nest)
    deep = registry.create("urn:test:suite:deeper", "Deep", depth=1.5)
    file = tmp_path / "several.xmi"
    write_model(
        [parrot, deep], file, registry, schema_location=schema_locations(registry, exported_folder, file)
    )
    assert referee.ask("alone", "check", file).faults == []


@pytest.fixture(scope="module")
def exported_folder(registry, tmp_path_factory):
    folder = tmp_path_factory.mktemp("exported metamodels")
    export_metamodels(registry, folder)
    return folder


WRONG = {
    "unknown feature": 'bogus="1">',
    "unknown class": '><animals xsi:type="zoo:Tiger" name="t"/>',
    "abstract class": '><animals name="t"/>',
    "wrong literal": '><animals xsi:type="zoo:Lion" name="l" mood="HUNGRY"/>',
    "wrong truth value": '><animals xsi:type="zoo:Lion" name="l" tame="yes"/>',
    "wrong number": '><animals xsi:type="zoo:Lion" name="l" weight="inf"/>',
    "underscores": '><animals xsi:type="zoo:Lion" name="l" teeth="1_000"/>',
    "spaces": '><animals xsi:type="zoo:Lion" name="l" teeth=" 5 "/>',
    "overflow": '><animals xsi:type="zoo:Lion" name="l" teeth="4294967296"/>',
    "wrong bytes": '><animals xsi:type="zoo:Lion" name="l" cage="128"/>',
    "dangling": 'star="//@animals.0">',
    "missing name": '><animals xsi:type="zoo:Lion"/>',
    "wrong class": '><animals xsi:type="zoo:Keeper"/>',
    "wrong target": 'star="//@keepers.0"><keepers/>',
    "too many": '><animals xsi:type="zoo:Lion" name="l" weights="1 2 3 4"/>',
    "one key twice": '><notes key="a" value="1"/><notes key="b"/><notes key="a" value="2"/>',
    "no key twice": "><notes/><notes/>",
    "duplicate id": '><keepers badge="a"/><keepers badge="a"/>',
    "unknown namespace": '><animals xmlns:o="urn:other" xsi:type="o:Cat"/>',
}
RIGHT = {
    "comment": "><!-- c --><?pi?>",
    "nested prefix": '><animals xmlns:w="urn:test:zoo:wing" xsi:type="w:Parrot" name="p"/>',
    "java numbers": '><animals xsi:type="zoo:Lion" name="l" weight="1.5d" speed="NaN" tame="TRUE"/>',
    "attribute list": '><animals xsi:type="zoo:Lion" name="l" tags="a b" moods="is-calm ANGRY"/>',
    "two keys": '><notes key="a" value="1"/><notes key="b" value="1"/><notes/>',
    "ids": '><keepers badge="a" deputy="b"/><keepers badge="b"/>',
    "nil": '><animals xsi:type="zoo:Lion" name="l"><motto xsi:nil="true"/></animals>',
    "extension": '><xmi:Extension extender="x"><a/></xmi:Extension>',
    "one-sided pair": '><animals xsi:type="zoo:Lion" name="a"/>'
    '<animals xsi:type="zoo:Lion" name="b" mateOf="//@animals.0"/>',
}


@pytest.mark.parametrize("title", [*WRONG, *RIGHT])
def test_emf_and_we_refuse_and_accept_the_same(referee, registry, tmp_path, title):
    file = tmp_path / "case.xmi"
    file.write_text(f"{HEAD}{(WRONG | RIGHT)[title]}</zoo:Zoo>")
    model = read_model(file, registry)
    found = (*model.diagnostics, *check_conformance(model, registry))
    ours = [fault for fault in found if fault.severity.value == "error" and fault.code != "ECO009"]
    theirs = referee.ask("check", file).faults
    assert (bool(ours), bool(theirs)) == (title in WRONG, title in WRONG)


KEYED = """<?xml version="1.0" encoding="UTF-8"?>
<m:Root xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:m="urn:test:keyed"
    linked="//@keyed.0 //@keyed.1">
  <keyed a="p" b="1"/>
  <keyed a="p" b="1"/>
  <keyed a="p" b="2"/>
  <keyed/>
  <keyed/>
  <numbers key="1" value="q"/>
  <numbers key="1" value="r"/>
  <numbers key="0"/>
  <numbers/>
  <things key="//@keyed.2"/>
  <things key="//@keyed.2"/>
  <things key="//@keyed.3"/>
</m:Root>
"""


def test_emf_and_we_find_the_same_keys_twice(referee, tmp_path):
    ecore = Path(__file__).parents[2] / "fixtures" / "models" / "keyed.ecore"
    registry = registry_with([MetamodelSource("urn:test:keyed", ecore, "keyed")])
    file = tmp_path / "keyed.xmi"
    file.write_text(KEYED)
    found = check_conformance(read_model(file, registry), registry)
    with referee.knowing(ecore) as told:
        assert told.faults == []
        theirs = referee.ask("check", file).faults
    names = [fault.split("'")[1] for fault in theirs]
    ours = [fault.message.partition(" in ")[2].partition(" ")[0] for fault in found]
    assert {fault.code for fault in found} == {"ECO013"}
    assert sorted(ours) == sorted(names) == ["keyed", "keyed", "linked", "numbers", "numbers", "things"]


@pytest.mark.parametrize("title", RIGHT)
def test_emf_and_we_read_the_same_values(referee, registry, tmp_path, title):
    file = tmp_path / "case.xmi"
    file.write_text(f"{HEAD}{RIGHT[title]}</zoo:Zoo>")
    said = referee.ask("dump", file).lines[1:]
    assert list(model_lines(read_model(file, registry).roots, "case.xmi")) == list(said)


FORMS = {
    "nil reference": 'Scalars{}><perhaps xsi:nil="true"/></suite:Scalars>',
    "nil value": 'Unsettable{}><string xsi:nil="true"/></suite:Unsettable>',
    "nil among many": 'Many{}><strings>a</strings><strings xsi:nil="true"/></suite:Many>',
    "empty list": 'Unsettable{} unsetTexts="" leaves=""/>',
    "set to the default": 'Unsettable{} int="0" boolean="false" double="0.0" mood="is-calm"/>',
    "keys": 'Keyed{} chosen="//@keys[key=\'a%20b\']"><keys key="a b"/></suite:Keyed>',
    "schema numbers": 'XmlTypes{} double="-INF" float="NaN" boolean="1" decimal="0.10" base64Binary="Cv8="/>',
    "java numbers": 'Scalars{} double="1.5d" float="2.5f" doubleObject="-Infinity" bigDecimal="1.50E+3"/>',
    "all bits": 'Scalars{} double="0.30000000000000004" doubleObject="4.9E-324" long="9223372036854775807"/>',
    "a date with a zone": 'Scalars{} date="2024-05-01T10:11:12.123+0200" char="x" characterObject="228"/>',
    "bytes": 'Scalars{} byteArray="0aFF" byte="-128" bigInteger="-123456789012345678901234567890"/>',
    "values as elements": "Scalars{}><double>1.5</double><string> a </string></suite:Scalars>",
    "many values as an attribute": 'Many{} ints="1 2 2" moods="is-calm ANGRY" strings="a b"/>',
    "awkward names": 'Awkward{} from="a" class="b" __init__="c" eClass="d" notify="e" self="f" None="g"/>',
    "awkward classes": 'None{} import="a"><nodes xsi:type="suite:class" import="b"/></suite:None>',
    "umlauts": 'Größe{} größe="1.5"/>',
    "own href": "Awkward{}><href>b</href><import><href>a#b</href></import></suite:Awkward>",
    "paired with itself": 'Linked{}><mate href="#/"/></suite:Linked>',
    "other prefix": 'Scalars{} xmlns:o="urn:test:suite:deeper"><nodes xsi:type="o:Deep"/></suite:Scalars>',
    "xmi type": 'Scalars{}><nodes xmi:type="suite:Many"/></suite:Scalars>',
    "identifiers": 'Linked{} xmi:id="_1" one="_2"><nodes xsi:type="suite:Many" xmi:id="_2"/></suite:Linked>',
    "map entries": 'Scalars{}><entries key="k"><value xsi:type="suite:Many"/></entries></suite:Scalars>',
}
ROOT = (
    ' xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:suite="urn:test:suite" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
)


@pytest.mark.parametrize("title", FORMS)
def test_emf_and_we_read_the_same_from_every_form(referee, registry, tmp_path, title):
    file, back = tmp_path / "case.xmi", tmp_path / "back.xmi"
    file.write_text(f"<suite:{FORMS[title].replace('{}', ROOT)}")
    model = read_model(file, registry)
    assert model.diagnostics == ()
    assert ["JUDGED case.xmi", *model_lines(model.roots, "case.xmi")] == list(referee.ask("dump", file).lines)
    write_model(model.roots, back, registry)
    assert "EQUAL" in referee.ask("equal", file, back).lines


@pytest.mark.parametrize("encoding", ["UTF-8", "UTF-8-SIG", "UTF-16", "ISO-8859-1", "ASCII"])
def test_emf_and_we_read_the_same_from_every_encoding(referee, registry, tmp_path, encoding):
    file = tmp_path / "case.xmi"
    header = f'<?xml version="1.0" encoding="{encoding.removesuffix("-SIG")}"?>'
    text = f'{header}<suite:Scalars{ROOT} string="ä&#x20AC;"/>'
    file.write_bytes(text.encode(encoding, "xmlcharrefreplace"))
    model = read_model(file, registry)
    assert model.roots[0].string == "ä€"
    assert ["JUDGED case.xmi", *model_lines(model.roots, "case.xmi")] == list(referee.ask("dump", file).lines)
