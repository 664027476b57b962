"""What Eclipse writes into files beyond plain values, read and written back as it stands."""

from decimal import Decimal
from pathlib import Path

import pytest

from mmrs_core.errors import PluginError
from mmrs_core.languages.metamodels.export import schema_locations
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import to_json, to_xmi, write_model

MODELS = Path(__file__).parents[2] / "fixtures" / "models"
NAMESPACES = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmlns:suite="urn:test:suite" xmlns:deep="urn:test:suite:deeper"'
)


@pytest.fixture(scope="module")
def suite():
    """A metamodel with every kind of feature, and one in another file that builds upon it."""
    names = ("suite", "parts")
    return registry_with([MetamodelSource(f"urn:test:{each}", MODELS / f"{each}.ecore") for each in names])


@pytest.fixture
def again(suite):
    """Return a function that reads a root element, and returns it with the text it is written as."""

    def again(kind, attributes="", content=""):
        text = f"<suite:{kind} {NAMESPACES} {attributes}>{content}</suite:{kind}>"
        model = read_text(text.encode(), "suite.xmi", suite)
        assert model.diagnostics == ()
        return model.roots[0], to_xmi(model.roots, suite).decode()

    return again


def test_a_reference_said_to_be_nil_stays_so(again):
    node, text = again("Scalars", content='<perhaps xsi:nil="true"/>')
    assert node.perhaps is None
    assert '<perhaps xsi:nil="true"/>' in text


def test_a_value_without_default_said_to_be_nil_stays_so(again):
    node, text = again("Unsettable", content='<string xsi:nil="true"/>')
    assert node.string is None
    assert '<string xsi:nil="true"/>' in text


@pytest.mark.parametrize("feature", ["unsetTexts", "leaves"])
def test_a_list_said_to_be_empty_stays_so(again, feature):
    node, text = again("Unsettable", f'{feature}=""')
    assert getattr(node, feature) == []
    assert f'{feature}=""' in text


def test_what_was_said_to_be_empty_may_be_filled(again, suite):
    node, _ = again("Unsettable", 'unsetTexts=""')
    node.unsetTexts.append("a")
    text = to_xmi([node], suite).decode()
    assert "<unsetTexts>a</unsetTexts>" in text
    assert 'unsetTexts=""' not in text


def test_a_value_among_many_may_be_nil(again):
    node, text = again("Many", content='<strings>a</strings><strings xsi:nil="true"/>')
    assert node.strings == ["a", None]
    assert '<strings>a</strings>\n  <strings xsi:nil="true"/>' in text


def test_nil_among_many_survives_as_json(again, suite):
    node, _ = again("Many", content='<strings>a</strings><strings xsi:nil="true"/>')
    text = to_json([node], suite)
    assert b'"strings": ["a", null]' in text
    assert read_text(text, "many.json", suite).roots[0].strings == ["a", None]


def test_a_number_among_many_may_not_be_nil(suite):
    text = f'<suite:Many {NAMESPACES}><ints xsi:nil="true"/></suite:Many>'
    assert [fault.code for fault in read_text(text.encode(), "m", suite).diagnostics] == ["XMI005"]


def test_nothing_is_said_of_a_feature_that_cannot_be_unset(again):
    _, text = again("Scalars", content='<single xsi:nil="true"/>')
    assert "single" not in text


@pytest.mark.parametrize(
    ("keys", "index"),
    [("key='b'", 1), ("key='a%20b'", 0), ("key=&quot;b&quot;", 1), ("key='b',value='2.5'", 1)],
)
def test_a_path_may_name_keys_in_the_forms_of_emf(again, keys, index):
    content = '<keys key="a b"/><keys key="b" value="2.5"/>'
    node, _ = again("Keyed", f'chosen="//@keys[{keys}]"', content)
    assert node.chosen is node.keys[index]


def test_keys_that_nobody_has_lead_nowhere(suite):
    text = f'<suite:Keyed {NAMESPACES} chosen="//@keys[key=null]"><keys key="a"/></suite:Keyed>'
    assert [fault.code for fault in read_text(text.encode(), "k", suite).diagnostics] == ["XMI006"]


@pytest.mark.parametrize(
    ("feature", "text", "value"),
    [
        ("double", "-INF", float("-inf")),
        ("float", "INF", float("inf")),
        ("base64Binary", "Cv8=", b"\n\xff"),
        ("hexBinary", "0AFF", b"\n\xff"),
        ("decimal", "0.00000000010", Decimal("1.0E-10")),
        ("unsignedInt", "4294967295", 4294967295),
    ],
)
def test_the_types_of_xml_schema_keep_their_forms(again, feature, text, value):
    node, written = again("XmlTypes", f'{feature}="{text}"')
    assert getattr(node, feature) == value
    assert f'{feature}="{text}"' in written


@pytest.mark.parametrize(("feature", "text"), [("base64Binary", "C"), ("double", "INFINITY")])
def test_wrong_values_of_the_types_of_xml_schema_are_faults(suite, feature, text):
    found = read_text(f'<suite:XmlTypes {NAMESPACES} {feature}="{text}"/>'.encode(), "x", suite)
    assert [fault.code for fault in found.diagnostics] == ["XMI005"]


@pytest.mark.parametrize(("text", "value"), [("1", True), ("0", False), ("true", True)])
def test_truth_values_of_xml_schema_may_be_figures(again, text, value):
    node, _ = again("XmlTypes", f'boolean="{text}"')
    assert node.boolean is value


def test_anything_may_stand_where_any_object_may(again):
    node, _ = again("Scalars", content='<anything xsi:type="suite:Many"/>')
    assert type(node.anything).__name__ == "Many"


def test_an_own_feature_called_href_is_written_so_that_nobody_takes_it_for_a_link(again, suite):
    node, text = again("Awkward", content='<import href="there"/>')
    assert "<href>there</href>" in text
    assert read_text(text.encode(), "a", suite).roots[0].import_[0].href == "there"
    assert node.import_[0].href == "there"


def test_whoever_pairs_with_itself_is_written_as_a_link(suite):
    alone = suite.create("urn:test:suite", "Linked")
    alone.mate = alone
    text = to_xmi([alone], suite)
    assert b'<mate href="#/"/>' in text
    found = read_text(text, "alone.xmi", suite).roots[0]
    assert found.mate is found


@pytest.mark.parametrize("identifier", ["a b", "/a", "a#b", "x:y", ""])
def test_an_id_that_is_no_word_does_not_refer(suite, identifier):
    named = suite.create("urn:test:suite", "Named", id=identifier)
    named.next = named
    text = to_xmi([named], suite)
    assert b'next="/"' in text
    assert read_text(text, "named.xmi", suite).roots[0].id == identifier


def test_an_id_that_is_a_word_refers(suite):
    named = suite.create("urn:test:suite", "Named", id="n.1")
    named.next = named
    assert b'next="n.1"' in to_xmi([named], suite)


def test_an_id_that_is_not_written_does_not_refer(suite):
    numbered = suite.create("urn:test:suite", "Numbered", number=0)
    numbered.next = numbered
    text = to_xmi([numbered], suite)
    assert b"number" not in text
    assert b'next="/"' in text


@pytest.fixture
def split(suite, tmp_path):
    """Two files: the first contains the root of the second."""
    inner = tmp_path / "inner.xmi"
    outer = tmp_path / "outer.xmi"
    inner.write_text(
        f'<suite:Scalars {NAMESPACES}><owner xsi:type="suite:Scalars" href="outer.xmi#/"/></suite:Scalars>'
    )
    outer.write_text(
        f'<suite:Scalars {NAMESPACES}><nodes xsi:type="suite:Scalars" href="inner.xmi#/"/></suite:Scalars>'
    )
    return outer, inner


@pytest.mark.parametrize("first", [0, 1])
def test_either_of_two_files_of_which_one_contains_the_other_may_be_read(suite, split, first):
    model = read_model(split[first], suite)
    assert [fault for each in (model, *model.linked) for fault in each.diagnostics] == []
    outer, inner = (model, model.linked[0])[:: -1 if first else 1]
    assert inner.roots[0].owner is outer.roots[0]
    assert outer.roots[0].nodes == [inner.roots[0]]


@pytest.mark.parametrize("first", [0, 1])
def test_both_files_keep_saying_which_contains_the_other(suite, split, first):
    for file in split:
        write_model(read_model(file, suite).roots, file, suite)
    assert b'href="inner.xmi#/"' in split[0].read_bytes()
    assert b'<owner xsi:type="suite:Scalars" href="outer.xmi#/"/>' in split[1].read_bytes()


def test_a_file_that_claims_a_container_which_does_not_contain_it_is_at_fault(suite, split):
    split[0].write_text(f"<suite:Scalars {NAMESPACES}/>")
    assert [fault.code for fault in read_model(split[1], suite).diagnostics] == ["XMI013"]


def test_exported_metamodels_are_found_from_the_folder_of_the_file(suite, tmp_path):
    places = schema_locations(suite, tmp_path / "all models", tmp_path / "fields" / "one.xmi")
    assert places["urn:test:suite"] == "../all%20models/suite.ecore"
    assert places["urn:test:suite:inner"] == "../all%20models/suite.ecore#//inner"
    assert places["urn:test:suite:deeper"] == "../all%20models/suite.ecore#//inner/deeper"


@pytest.mark.parametrize(
    "place", ["platform:/resource/models/far.xmi", "platform:/resource/fields/far.xmi", "../fields/far.xmi"]
)
def test_paths_of_an_eclipse_workspace_lead_into_the_project(suite, tmp_path, place):
    folder = tmp_path / "models"
    (folder / "sub").mkdir(parents=True)
    (folder / "fields").mkdir()
    for far in (folder / "far.xmi", folder / "fields" / "far.xmi"):
        far.write_text(f'<suite:Scalars {NAMESPACES} name="far"/>')
    near = folder / "sub" / "near.xmi"
    near.write_text(
        f'<suite:Linked {NAMESPACES}><one xsi:type="suite:Scalars" href="{place}#/"/></suite:Linked>'
    )
    model = read_model(near, suite, root=folder)
    assert model.diagnostics == ()
    assert model.roots[0].one.name == "far"


@pytest.mark.parametrize(
    "place",
    ["platform:/resource/other/far.xmi", "platform:/resource/models/../far.xmi", "platform:/meta/models/x"],
)
def test_paths_of_an_eclipse_workspace_never_leave_the_project(suite, tmp_path, place):
    folder = tmp_path / "models"
    folder.mkdir()
    for far in (tmp_path / "far.xmi", tmp_path / "other" / "far.xmi"):
        far.parent.mkdir(exist_ok=True)
        far.write_text(f"<suite:Scalars {NAMESPACES}/>")
    near = folder / "near.xmi"
    near.write_text(f'<suite:Linked {NAMESPACES}><one href="{place}#/"/></suite:Linked>')
    assert [fault.code for fault in read_model(near, suite).diagnostics] == ["XMI007"]


def test_a_feature_map_is_refused_by_its_name(tmp_path):
    text = (MODELS / "parts.ecore").read_text()
    weight = 'name="weight" eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EDouble"'
    assert weight in text
    mixed = text.replace(weight, weight.replace("EDouble", "EFeatureMapEntry"))
    (tmp_path / "parts.ecore").write_text(mixed)
    sources = [
        MetamodelSource("urn:test:suite", MODELS / "suite.ecore"),
        MetamodelSource("urn:test:parts", tmp_path / "parts.ecore"),
    ]
    with pytest.raises(PluginError, match=r"Part\.weight: a feature map, which models here cannot hold"):
        registry_with(sources)
