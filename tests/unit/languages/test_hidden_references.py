"""References into elements of languages that are not installed are kept, and never written wrong."""

import pytest

from mmrs_core.languages.element import Hidden, path_of, root_of
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.references.hidden import strayed
from mmrs_core.languages.writing import to_json, to_xmi, write_model

HEAD = (
    b'<?xml version="1.0" encoding="UTF-8"?>\n'
    b'<zoo:Zoo xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    b' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
)
XMI = (
    HEAD + b' xmlns:far="urn:test:far:1.0" xmlns:zoo="urn:test:zoo" name="z" star="//@animals.0/@cubs.1">\n'
    b'  <animals xsi:type="far:Panel" name="a" mate="//@animals.2">\n'
    b'    <cubs xsi:type="zoo:Lion" xmi:id="c0"/><cubs xsi:type="zoo:Lion" key="c&amp;1"/>\n'
    b"  </animals>\n"
    b'  <animals xsi:type="zoo:Lion" name="Leo" mate="c0"/>\n'
    b'  <animals xsi:type="zoo:Lion" name="Lea" mate="//@animals.0/@cubs.0/@heart"/>\n'
    b'  <keepers badge="k" keeps="c0 c&amp;1"/>\n'
    b"</zoo:Zoo>\n"
)
JSON = b"""{
  "$languages": {"far": "urn:test:far:1.0", "zoo": "urn:test:zoo"},
  "$type": "zoo:Zoo",
  "star": "//@animals.0/@cubs.1",
  "animals": [
    {
      "$type": "far:Panel",
      "cubs": [
        {"$id": "c0"},
        {"$id": "c1"}
      ]
    },
    {"$type": "zoo:Lion", "name": "Leo", "mate": "c1"}
  ]
}
"""


@pytest.fixture
def kept(zoo):
    """Return the model of a zoo in which an element of a missing language is referred into."""
    return read_text(XMI, "zoo.xmi", zoo)


@pytest.mark.parametrize(("text", "write"), [(XMI, to_xmi), (JSON, to_json)], ids=["xmi", "json"])
def test_a_reference_into_what_is_not_understood_is_saved_byte_for_byte(zoo, text, write):
    model = read_text(text, f"a.{write.__name__[3:]}", zoo)
    assert {fault.code for fault in model.diagnostics} == {"XMI001"}
    assert write(model.roots, zoo) == text


def test_it_survives_the_way_through_json(zoo, kept):
    text = to_json(kept.roots, zoo)
    assert to_xmi(read_text(text, "b.json", zoo).roots, zoo) == XMI


def test_the_fault_names_the_missing_language_and_what_is_kept(kept):
    fault = next(fault for fault in kept.diagnostics if fault.place.path == "/animals[1]")
    assert fault.message == "mate: leads into a Panel of urn:test:far:1.0, which is not installed: 'c0'"
    assert fault.hint == (
        "a plug-in is missing: install the one that provides urn:test:far:1.0, "
        "or write it ('mmrs plugin new'); the reference is kept as it is"
    )


def test_paths_say_where_it_leads(kept):
    zoo = kept.roots[0]
    assert path_of(zoo.star) == "/animals[0]/cubs[1]"
    assert path_of(zoo.animals[1].mate) == "/animals[0]#c0"
    assert root_of(zoo.star) is zoo


def test_a_path_past_all_unknown_elements_still_leads_nowhere(zoo):
    model = read_text(XMI.replace(b"//@animals.0/@cubs.1", b"//@animals.7/@cubs.1"), "zoo.xmi", zoo)
    assert "XMI006" in {fault.code for fault in model.diagnostics}


def test_an_identifier_that_nobody_says_still_leads_nowhere(zoo):
    model = read_text(XMI.replace(b'mate="c0"', b'mate="c9"'), "zoo.xmi", zoo)
    assert "XMI006" in {fault.code for fault in model.diagnostics}


def test_the_path_follows_an_element_that_moves(zoo, kept):
    root = kept.roots[0]
    panel = root.animals[0]
    panel._mmrs_links = None
    root.animals.remove(panel)
    root.animals.append(panel)
    assert b'star="//@animals.2/@cubs.1"' in to_xmi(root._mmrs_source.roots, zoo)


@pytest.mark.parametrize("write", [to_xmi, to_json])
def test_nothing_is_written_when_the_kept_text_would_refer_to_another_element(zoo, kept, write):
    del kept.roots[0].animals[1]
    with pytest.raises(ValueError, match=r"the Panel is kept as it was read, and //@animals\.2 in it leads"):
        write(kept.roots, zoo)


def test_a_path_of_another_file_in_kept_text_is_not_taken_for_one_of_this(zoo):
    text = XMI.replace(b'mate="//@animals.2"', b'mate="far.xmi#//@animals.2"')
    model = read_text(text, "zoo.xmi", zoo)
    panel = model.roots[0].animals[0]
    del model.roots[0].animals[2]
    assert strayed(panel, model.roots) == ""


def test_nothing_is_written_when_the_element_around_it_is_gone(zoo, kept):
    root = kept.roots[0]
    del root.animals[0]
    with pytest.raises(ValueError, match=r"star: refers to .* which stands in no file"):
        to_xmi(kept.roots, zoo)


def test_a_link_to_what_is_hidden_in_another_file_keeps_its_class(zoo, tmp_path):
    (tmp_path / "far.xmi").write_bytes(XMI)
    link = '<star xsi:type="far:Cub" href="far.xmi#//@animals.0/@cubs.1"/>'
    text = (
        HEAD.decode()
        + f' xmlns:far="urn:test:far:1.0" xmlns:zoo="urn:test:zoo" name="z">\n  {link}\n</zoo:Zoo>\n'
    )
    file = tmp_path / "near.xmi"
    file.write_text(text)
    model = read_model(file, zoo)
    assert isinstance(model.roots[0].star, Hidden)
    write_model(model.roots, file, zoo)
    assert file.read_text() == text
