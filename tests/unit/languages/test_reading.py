import pytest

from mmrs_core.diagnostics import Severity
from mmrs_core.languages.element import Unknown, metaclass_of, place_of
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.writing import to_xmi


def codes(model):
    return [fault.code for fault in model.diagnostics]


def only_fault(model):
    assert len(model.diagnostics) == 1, model.diagnostics
    return model.diagnostics[0]


def test_every_element_knows_its_file_line_and_path(read_zoo):
    model = read_zoo(
        '\n<animals xsi:type="zoo:Lion" name="a">\n\n<cubs xsi:type="zoo:Otter"\nname="b"/></animals>'
    )
    place = place_of(model.roots[0].animals[0].cubs[0])
    assert (place.file, place.line, place.path) == ("zoo.xmi", 4, "/animals[0]/cubs[0]")


@pytest.mark.parametrize("junk", ["<!-- so -->", "<?target data?>", "\n\t "])
def test_comments_and_instructions_are_passed_over(read_zoo, junk):
    model = read_zoo(f'{junk}<keepers badge="1">{junk}</keepers>{junk}')
    assert model.diagnostics == ()
    assert model.roots[0].keepers[0].badge == "1"


def test_a_prefix_may_be_declared_where_it_is_used(read_zoo):
    model = read_zoo('<animals xmlns:w="urn:test:zoo:wing" xsi:type="w:Parrot" name="p"/>')
    assert model.diagnostics == ()
    assert metaclass_of(model.roots[0].animals[0]).key == ("urn:test:zoo:wing", "Parrot")


def test_a_prefix_ends_with_the_element_that_declares_it(read_zoo):
    inner = '<animals xmlns:w="urn:test:zoo:wing" xsi:type="w:Parrot" name="p"/>'
    model = read_zoo(f'{inner}<animals xsi:type="w:Parrot" name="q"/>')
    assert codes(model) == ["XMI014"]


def test_the_default_namespace_may_be_the_metamodels(zoo):
    model = read_text(b'<Zoo xmlns="urn:test:zoo" name="z"><keepers badge="1"/></Zoo>', "z.xmi", zoo)
    assert model.diagnostics == ()
    assert model.roots[0].keepers[0].badge == "1"


def test_xmi_type_is_read_like_xsi_type(read_zoo):
    assert read_zoo('<animals xmi:type="zoo:Lion" name="l"/>').roots[0].animals[0].name == "l"


def test_an_extension_is_passed_over_with_a_warning(read_zoo):
    extension = '<xmi:Extension extender="x"><a><b/>text</a></xmi:Extension>'
    model = read_zoo(f'{extension}<keepers badge="1"/>')
    assert only_fault(model).code == "XMI011"
    assert only_fault(model).severity is Severity.WARNING
    assert len(model.roots[0].keepers) == 1


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1", "windows-1252"])
def test_encodings_are_understood(zoo, encoding):
    declared = "utf-8" if encoding == "utf-8-sig" else encoding
    text = (
        f'<?xml version="1.0" encoding="{declared}"?>\n<zoo:Zoo xmlns:zoo="urn:test:zoo" name="Gr\xfc\xdfe"/>'
    )
    model = read_text(text.encode(encoding), "z.xmi", zoo)
    assert model.roots[0].name == "Gr\xfc\xdfe"


def test_several_roots_are_read(zoo, zoo_text):
    one = zoo_text("", 'name="1"').decode()
    text = f'<xmi:XMI xmlns:xmi="http://www.omg.org/XMI" xmi:version="2.0">{one}{one}</xmi:XMI>'
    assert [root.name for root in read_text(text.encode(), "z.xmi", zoo).roots] == ["1", "1"]


def test_a_document_needs_no_schema_location_nor_does_one_matter(read_zoo):
    location = 'xsi:schemaLocation="urn:test:zoo http://127.0.0.1:1/never.ecore"'
    assert read_zoo("", f'{location} name="z"').diagnostics == ()


def test_all_faults_are_reported_with_their_lines(read_zoo):
    model = read_zoo(
        '\n<animals xsi:type="zoo:Lion" name="a" teeth="many" bogus="1"/>'
        '\n<animals xsi:type="zoo:Tiger" name="b"/>'
        '\n<animals name="c"/>'
        '\n<keeper badge="1"/>'
        '\n<keepers badge="1" deputy="//@keepers.9"/>'
    )
    assert [(fault.place.line, fault.code) for fault in model.diagnostics] == [
        (2, "XMI005"),
        (2, "XMI004"),
        (3, "XMI002"),
        (4, "XMI003"),
        (5, "XMI004"),
        (6, "XMI006"),
    ]


def test_a_misspelt_attribute_of_the_root_is_a_fault_with_the_nearest_name(read_zoo):
    fault = only_fault(read_zoo("", 'nmae="z"'))
    assert (fault.code, fault.hint) == ("XMI004", "did you mean name?")
    assert fault.message == "nmae: no feature of Zoo"


def test_an_unknown_class_is_a_fault_with_the_nearest_name(read_zoo):
    fault = only_fault(read_zoo('<animals xsi:type="zoo:Lionn" name="l"/>'))
    assert (fault.code, fault.hint) == ("XMI002", "did you mean Lion?")


def test_an_element_of_the_wrong_class_is_a_fault(read_zoo):
    fault = only_fault(read_zoo('<animals xsi:type="zoo:Keeper" badge="1"/>'))
    assert (fault.code, fault.message) == ("XMI008", "Keeper: not a Animal, which animals takes")


def test_a_single_feature_given_twice_is_a_fault(read_zoo):
    lion = '<guest xsi:type="zoo:Lion" name="l"/>'
    assert codes(read_zoo(lion * 2)) == ["XMI009"]


@pytest.mark.parametrize(
    "twice",
    [
        '<animals xsi:type="zoo:Lion"><name>a</name><name>b</name></animals>',
        '<animals xsi:type="zoo:Lion" name="a"><name>b</name></animals>',
    ],
)
def test_a_single_value_given_twice_is_a_fault(read_zoo, twice):
    model = read_zoo(twice)
    assert codes(model) == ["XMI009"]
    assert model.roots[0].animals[0].name == "a"


@pytest.mark.parametrize("step", ["//@animals.\u0660", "/\u0660/@animals.0", "//@animals.\uff10"])
def test_figures_of_other_scripts_lead_nowhere(read_zoo, step):
    assert codes(read_zoo('<animals xsi:type="zoo:Lion" name="l"/>', f'name="z" star="{step}"')) == ["XMI006"]


def test_stray_text_is_a_fault(read_zoo):
    assert codes(read_zoo("hello")) == ["XMI010"]


def test_an_element_inside_a_value_is_a_fault(read_zoo):
    assert codes(read_zoo('<animals xsi:type="zoo:Lion" name="l"><tags>a<b/></tags></animals>')) == ["XMI010"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (b"<html/>", "XMI015"),
        (b'<a:b xmlns:a="urn:nowhere"/>', "XMI001"),
        (b'<a:b xmlns:a="urn:test:zoo"/>', "XMI002"),
        (b'<a:Animal xmlns:a="urn:test:zoo"/>', "XMI003"),
    ],
)
def test_a_root_that_is_no_model_is_a_fault(zoo, text, code):
    assert codes(read_text(text, "x.xmi", zoo)) == [code]


STRANGER = (
    '<animals xmlns:o="urn:other" xsi:type="o:Cat" name="C &gt; D">'
    "<x y='>' z='\"'/>\n    &#xA;<o:q/></animals>"
)


def test_an_element_of_a_missing_plug_in_names_what_is_missing(read_zoo):
    fault = only_fault(read_zoo(STRANGER))
    assert (fault.code, fault.message) == ("XMI001", "urn:other: no such metamodel, needed for Cat")
    assert fault.hint.startswith("a plug-in is missing: install the one that provides urn:other, or")


def test_a_metamodel_unlike_any_installed_is_not_taken_for_a_slip_of_the_pen(core):
    survey = b'<a:B xmlns:a="urn:mmrs:survey:1.0"/>'
    assert "did you mean" not in only_fault(read_text(survey, "z.xmi", core)).hint


def test_a_metamodel_that_is_two_letters_off_is_named(core):
    slip = b'<a:Mission xmlns:a="urn:mmrs:misson:1.1"/>'
    hint = only_fault(read_text(slip, "z.xmi", core)).hint
    assert hint.startswith("did you mean urn:mmrs:mission:1.0? else a plug-in is missing")


@pytest.mark.parametrize("stranger", [STRANGER, '<animals xsi:type="zoo:Tiger" name="a>b"/>'])
def test_an_element_of_a_missing_plug_in_survives_a_save(read_zoo, zoo, stranger):
    model = read_zoo(f'{stranger}<animals xsi:type="zoo:Lion" name="l"/>', 'star="//@animals.1"')
    assert isinstance(model.roots[0].animals[0], Unknown)
    assert model.roots[0].star.name == "l"
    text = to_xmi(model.roots, zoo)
    assert stranger.partition('xsi:type="')[2].encode() in text
    again = read_text(text, "again.xmi", zoo)
    assert codes(again) == codes(model)
    assert to_xmi(again.roots, zoo) == text


def test_a_document_of_a_missing_plug_in_survives_a_save(zoo):
    text = b'<o:Cat xmlns:o="urn:other"><kitten/></o:Cat>'
    model = read_text(text, "cat.xmi", zoo)
    assert b"<kitten/></o:Cat>" in to_xmi(model.roots, zoo)


def test_reading_a_file_keeps_the_path_as_it_was_given(core, tmp_path, monkeypatch):
    (tmp_path / "m.xmi").write_bytes(b'<m:Mission xmlns:m="urn:mmrs:mission:1.0" bogus="1"/>')
    monkeypatch.chdir(tmp_path)
    from pathlib import Path

    model = read_model(Path("m.xmi"), core)
    assert str(model.file) == "m.xmi"
    assert str(model.diagnostics[0].place) == "m.xmi:1"
