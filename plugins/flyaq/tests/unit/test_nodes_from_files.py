"""What a file says, before anybody asks what it means."""

import pytest
from mmrs_flyaq.sources.documents import node_of, parse_xmi
from mmrs_flyaq.sources.nodes import Claim, Link, Text

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.json_form.tree import Tree

XMI = 'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'


def from_json(text):
    tree = Tree(text.encode(), "a.json")
    return node_of(tree, tree.top)


def from_xmi(text):
    return parse_xmi(text.encode(), "a.xmi")


@pytest.mark.parametrize(
    ("spelling", "claim"),
    [
        ("shop://Order", Claim("http://shop", "Order")),
        ("http://shop#//Order", Claim("http://shop", "Order")),
        ("file:/C:/shops/shop.ecore#//Order", Claim("file:/C:/shops/shop.ecore", "Order")),
        ("shop.ecore#//Order", Claim("shop.ecore", "Order")),
        ("unknown://Order", Claim("unknown", "Order")),
    ],
)
def test_every_spelling_of_a_class_is_read(spelling, claim):
    assert from_json(f'{{"@ns": {{"shop": "http://shop"}}, "eClass": "{spelling}"}}').claim == claim


def test_an_object_without_a_class_claims_none():
    assert from_json('{"name": "x"}').claim is None


def test_values_of_json_know_their_lines():
    node = from_json('{\n "a": 1,\n "b": [true,\n  "x"]\n}')
    assert node.values == {"a": [Text("1", 2)], "b": [Text("true", 3), Text("x", 3)]}


def test_a_reference_of_json_is_a_link():
    (link,) = from_json('{"to": {"$ref": "//@tasks.1", "eClass": "m://Task"}}').values["to"]
    assert isinstance(link, Link)
    assert link.text == "//@tasks.1"


def test_null_in_json_is_no_value():
    assert from_json('{"a": null}').values == {}


def test_json_nested_too_deeply_is_refused_with_its_line():
    deep = '{"a":' * 150 + "1" + "}" * 150
    with pytest.raises(UnreadableError, match=r"a\.json:1: nested deeper than 100 levels"):
        from_json(deep)


def test_lists_nested_too_deeply_in_json_are_refused():
    with pytest.raises(UnreadableError, match="nested deeper than 100 levels"):
        from_json('{"a":' + "[" * 150 + "{}" + "]" * 150 + "}")


def test_attributes_and_elements_of_xmi_are_values():
    (root,) = from_xmi(
        f'<s:Shop {XMI} xmlns:s="http://shop" name="corner">\n<orders total="3"/></s:Shop>'
    ).roots
    assert root.claim == Claim("http://shop", "Shop")
    assert root.text("name") == "corner"
    (order,) = root.nodes("orders")
    assert (order.claim, order.line, order.text("total")) == (None, 2, "3")


def test_an_element_of_xmi_may_name_its_class():
    (root,) = from_xmi(f'<s:Shop {XMI} xmlns:s="http://shop"><orders xsi:type="s:Gift"/></s:Shop>').roots
    assert root.nodes("orders")[0].claim == Claim("http://shop", "Gift")


def test_an_attribute_of_xmi_may_be_written_as_an_element():
    (root,) = from_xmi(f'<s:Shop {XMI} xmlns:s="http://shop"><note>a\nb</note><note>c</note></s:Shop>').roots
    assert root.texts("note") == ("a\nb", "c")


def test_an_element_of_xmi_with_nothing_but_an_href_is_a_link():
    (root,) = from_xmi(f'<s:Shop {XMI} xmlns:s="http://shop"><owner href="b.xmi#/"/></s:Shop>').roots
    assert [link.text for link in root.links("owner")] == ["b.xmi#/"]


def test_a_file_of_xmi_may_hold_several_roots():
    found = from_xmi(f'<xmi:XMI {XMI} xmlns:s="http://shop"><s:Shop/><s:Order/></xmi:XMI>').roots
    assert [root.name for root in found] == ["Shop", "Order"]


def test_xmi_tells_where_its_metamodels_lie():
    document = from_xmi(
        f'<s:Shop {XMI} xmlns:s="http://shop" xsi:schemaLocation="http://shop ../shop.ecore"/>'
    )
    assert document.locations == (("http://shop", "../shop.ecore"),)


def test_xmi_nested_too_deeply_is_refused():
    with pytest.raises(UnreadableError, match="nested deeper than 100 levels"):
        from_xmi(f'<s:Shop {XMI} xmlns:s="http://shop">' + "<a>" * 120 + "</a>" * 120 + "</s:Shop>")


def test_a_node_knows_its_path_and_what_it_is_called():
    node = from_json('{"eClass": "m://Mission", "tasks": [{"eClass": "m://Fork", "name": "split"}]}')
    (task,) = node.nodes("tasks")
    assert (task.path(), task.called()) == ("/tasks[0]", "Fork 'split'")
