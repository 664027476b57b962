"""Models with elements of languages that are not installed open, say so, and are saved as they were."""

import json
from pathlib import Path

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.missing import hint_for, stem_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_json, to_xmi

ROOT = Path(__file__).parents[3]
XMI = b"""<?xml version="1.0" encoding="UTF-8"?>
<zoo:Zoo xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"\
 xmlns:solar="urn:test:solar:1.0" xmlns:zoo="urn:test:zoo" name="z" star="//@animals.1">
  <animals xsi:type="solar:Panel" name="a &lt; b" rows = '3'>
      <shell xsi:type="zoo:Keeper"   badge="x"/><!-- kept, too -->
  </animals>
  <animals xsi:type="zoo:Lion" name="Leo"/>
</zoo:Zoo>
"""
JSON = b"""{
  "$languages": {"solar": "urn:test:solar:1.0", "zoo": "urn:test:zoo"},
  "$type": "zoo:Zoo",
  "name": "z",
  "star": "//@animals.1",
  "animals": [
    {
      "$type": "solar:Panel",
      "name": "a < b",
      "rows": 3,
      "shell": [
        {"$type": "zoo:Keeper", "badge": "x"},
        {"at": [1.50, 2e3, null, true]}
      ]
    },
    {"$type": "zoo:Lion", "name": "Leo"}
  ]
}
"""


@pytest.mark.parametrize(("text", "write"), [(XMI, to_xmi), (JSON, to_json)], ids=["xmi", "json"])
def test_what_is_not_understood_is_saved_byte_for_byte(zoo, text, write):
    model = read_text(text, f"a.{write.__name__[3:]}", zoo)
    assert [fault.code for fault in model.diagnostics] == ["XMI001"]
    assert write(model.roots, zoo) == text


@pytest.mark.parametrize(("text", "name", "line"), [(XMI, "a.xmi", 3), (JSON, "a.json", 8)])
def test_the_fault_names_language_file_and_line(zoo, text, name, line):
    (fault,) = read_text(text, name, zoo).diagnostics
    assert (str(fault.place), fault.message) == (
        f"{name}:{line}",
        "urn:test:solar:1.0: no such metamodel, needed for Panel",
    )


def test_what_xmi_held_survives_the_way_through_json(zoo):
    text = to_json(read_text(XMI, "a.xmi", zoo).roots, zoo)
    assert to_xmi(read_text(text, "b.json", zoo).roots, zoo) == XMI


def test_what_json_held_is_not_guessed_into_xmi(zoo):
    model = read_text(JSON, "a.json", zoo)
    with pytest.raises(ValueError, match=r"^/animals\[0\]: urn:test:solar:1\.0#Panel is not installed"):
        to_xmi(model.roots, zoo)


def test_a_whole_model_of_a_missing_language_is_saved_as_it_was(zoo):
    text = XMI.replace(b"zoo:Zoo", b"far:Zoo").replace(b"xmlns:zoo=", b'xmlns:far="urn:far" xmlns:zoo=')
    model = read_text(text, "a.xmi", zoo)
    assert to_xmi(model.roots, zoo) == text
    json = to_json(model.roots, zoo)
    assert to_xmi(read_text(json, "b.json", zoo).roots, zoo) == text


def test_a_whole_json_model_of_a_missing_language_is_saved_as_it_was(zoo):
    text = JSON.replace(b"zoo:Zoo", b"solar:Zoo")
    again = to_json(read_text(text, "a.json", zoo).roots, zoo)
    assert to_json(read_text(again, "a.json", zoo).roots, zoo) == again


def test_prefixes_that_mean_something_else_at_the_root_stay_with_their_element(zoo):
    element = b'<animals xmlns:zoo="urn:other" xsi:type="zoo:Thing"><at xmlns="urn:plain"/></animals>'
    text = XMI.replace(
        b'  <animals xsi:type="zoo:Lion"', b"  " + element + b'\n  <animals xsi:type="zoo:Lion"'
    )
    model = read_text(text, "a.xmi", zoo)
    assert [fault.code for fault in model.diagnostics] == ["XMI001", "XMI001"]
    assert to_xmi(model.roots, zoo) == text


def test_two_prefixes_of_one_kept_language_stay_apart(zoo):
    element = b'<animals xmlns:sun="urn:test:solar:1.0" xsi:type="sun:Thing"/>'
    text = XMI.replace(
        b'  <animals xsi:type="zoo:Lion"', b"  " + element + b'\n  <animals xsi:type="zoo:Lion"'
    )
    assert to_xmi(read_text(text, "a.xmi", zoo).roots, zoo) == text


@pytest.mark.parametrize(("name", "likely"), [("rover", "mmrs-rover"), ("a-b", "mmrs-a-b or mmrs-a")])
def test_the_likely_distribution_of_our_own_plug_ins_is_named(zoo, name, likely):
    uri = f"urn:mmrs:{name}:1.0"
    assert f"install the one that provides {uri}, such as {likely}; the element" in hint_for(uri, zoo)


def test_another_version_of_an_installed_language_is_named(zoo):
    assert hint_for("urn:mmrs:mission:2.0", zoo).startswith("urn:mmrs:mission:1.0 is installed")


@pytest.mark.parametrize(
    ("ns_uri", "stem"),
    [("http://x/lib/1.0", "http://x/lib"), ("http://x/lib/v2/", "http://x/lib"), ("urn:a:b", "urn:a:b")],
)
def test_a_version_at_the_end_of_an_ns_uri_is_no_part_of_its_stem(ns_uri, stem):
    assert stem_of(ns_uri) == stem


def test_an_element_kept_as_xml_is_read_once_its_language_is_installed(zoo):
    text = XMI.replace(b'"solar:Panel"', b'"zoo:Otter"').replace(b"rows = '3'", b'depth="4.5"')
    text = text.replace(b"<shell", b"<cubs").replace(b'"zoo:Keeper"   badge', b'"zoo:Lion" teeth="3" name')
    whole = to_json(read_text(text.replace(b"</shell", b"</cubs"), "a.xmi", zoo).roots, zoo)
    otter = text[text.index(b"<animals") : text.index(b"</animals>") + 10].decode()
    kept = json.loads(whole)
    kept["animals"][0] = {
        "$type": "zoo:Otter",
        "$xml": otter,
        "$namespaces": {"zoo": "urn:test:zoo", "xsi": "http://www.w3.org/2001/XMLSchema-instance"},
    }
    model = read_text(json.dumps(kept).encode(), "b.json", zoo)
    assert model.diagnostics == ()
    assert to_json(model.roots, zoo) == whole


def test_a_model_kept_as_xml_is_read_once_its_language_is_installed(zoo, core):
    whole = XMI.replace(b'xsi:type="solar:Panel"', b'xsi:type="zoo:Otter"').replace(
        b"rows = '3'", b'depth="4.5"'
    )
    whole = whole.replace(b"<shell", b"<cubs").replace(b'"zoo:Keeper"   badge', b'"zoo:Lion" name')
    text = to_json(read_text(whole, "a.xmi", zoo).roots, zoo)
    kept = to_json(read_text(whole, "a.xmi", core).roots, core)
    assert b"$xml" in kept
    assert to_json(read_text(kept, "b.json", zoo).roots, zoo) == text


@pytest.mark.parametrize("xml", ["<a>", "no xml", "<a/><b/>", "<!DOCTYPE x><a/>", "<!-- --><a/>", "<b:a/>"])
def test_kept_xml_that_is_none_is_refused_with_its_line(zoo, xml):
    text = f'{{"$type": "urn:far#Thing",\n "$xml": "{xml}"}}'
    with pytest.raises(UnreadableError, match=r"^a\.json:1: "):
        read_text(text.encode(), "a.json", zoo)
