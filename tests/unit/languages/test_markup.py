"""Every part of a text is found where it stands."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.xmi.markup import Markup

TEXT = """<?xml version="1.0" encoding="UTF-8"?>
<!-- é -->
<m:Root xmlns:m='urn:m' name = "a &quot;>&lt; b">
  <tasks name="one"/>
  <tasks name="two"><point x="1"/></tasks>
</m:Root>
""".encode()


@pytest.fixture
def markup():
    return Markup(TEXT, "m.xmi")


def test_an_attribute_is_found_with_its_name_and_value(markup):
    name = markup.root.attribute("name")
    assert name.value == 'a ">< b'
    assert TEXT[name.begin : name.end] == b"name"
    assert TEXT[name.value_begin : name.value_end] == b"a &quot;>&lt; b"


def test_a_tag_reaches_from_its_first_to_its_last_character(markup):
    one, two = markup.root.named("tasks")
    assert TEXT[one.begin : one.end] == b'<tasks name="one"/>'
    assert TEXT[two.begin : two.end] == b'<tasks name="two"><point x="1"/></tasks>'
    assert TEXT[two.inside : two.closing] == b'<point x="1"/>'


def test_an_element_is_found_by_its_path_and_line(markup):
    assert markup.at("/tasks[1]/point", 5).attribute("x").value == "1"
    assert markup.at("/", 3) is markup.root


def test_a_path_that_disagrees_with_the_line_leads_nowhere(markup):
    assert markup.at("/tasks[0]", 5) is None
    assert markup.at("/tasks[2]", 5) is None


def test_models_inside_a_wrapper_are_told_apart_by_their_lines():
    text = b'<xmi:XMI xmlns:xmi="x">\n<m:A xmlns:m="m"/>\n<m:B xmlns:m="m"/>\n</xmi:XMI>'
    assert Markup(text, "m.xmi").at("/", 3).name == "m:B"


def test_prefixes_are_those_in_scope(markup):
    assert markup.root.named("tasks")[0].prefixes() == {"m": "urn:m"}


@pytest.mark.parametrize("text", [b"<a>", b"", b'<?xml version="1.0" encoding="ISO-8859-1"?><a/>'])
def test_what_cannot_be_edited_safely_is_refused(text):
    with pytest.raises(UnreadableError):
        Markup(text, "m.xmi")


@given(st.lists(st.text("ab<>&\"' é\n", max_size=6), max_size=4))
def test_any_value_is_found_again(values):
    from xml.sax.saxutils import quoteattr

    text = "".join(f"<b v={quoteattr(value)}/>" for value in values)
    found = Markup(f"<a>{text}</a>".encode(), "m.xmi").root.named("b")
    assert [each.attribute("v").value for each in found] == values
