"""What ``mmrs show`` says of values of every type, and of files with several roots."""

import json
import shutil
from pathlib import Path

import pytest

ZOO = Path(__file__).parents[2] / "fixtures" / "models" / "zoo.ecore"
LION = """<?xml version="1.0" encoding="UTF-8"?>
<zoo:Lion xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:zoo="urn:test:zoo" name="Leo"
    teeth="28" weight="190.5" tame="true" mood="is-hungry" born="2020-01-02T03:04:05.678+0100"
    price="12.50" chip="0AFF" grade="97"/>
"""
TWO = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:zoo="urn:test:zoo">
  <zoo:Zoo name="first"><keepers badge="k1"/></zoo:Zoo>
  <zoo:Zoo name="second"><keepers badge="k2" strength="3"/></zoo:Zoo>
</xmi:XMI>
"""


@pytest.fixture
def lion(tmp_path, monkeypatch):
    """Return the file of a lion that says something of every type; its metamodel lies beside it."""
    shutil.copy(ZOO, tmp_path / "zoo.ecore")
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "lion.xmi"
    file.write_text(LION)
    return file.name


@pytest.fixture
def two(lion):
    """Return a file that holds two zoos, in the second of which something is wrong."""
    Path("two.xmi").write_text(TWO)
    return "two.xmi"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("teeth", 28),
        ("weight", 190.5),
        ("tame", True),
        ("mood", "is-hungry"),
        ("born", "2020-01-02T03:04:05.678+0100"),
        ("price", "12.50"),
        ("chip", "0AFF"),
        ("grade", "a"),
    ],
)
def test_a_value_of_every_type_is_told_as_json_and_in_words(lion, mmrs, name, value):
    _, whole, _ = mmrs("show", lion, "--json")
    _, alone, _ = mmrs("show", lion, "--path", name, "--json")
    _, words, _ = mmrs("show", lion, "--path", name)
    assert json.loads(whole)["roots"][0][name] == value
    assert json.loads(alone)["found"][0]["value"] == value
    assert words == f"/{name}: {json.dumps(value) if isinstance(value, bool) else value}\n"


def test_each_of_several_roots_has_its_number(two, mmrs):
    _, words, _ = mmrs("show", two)
    assert [line[:3] for line in words.splitlines() if line.startswith("/")] == ["/0:", "/1:"]


@pytest.mark.parametrize("path", ["/1/keepers[0]", "//Keeper[badge=k2]", "/1/@keepers.0"])
def test_a_path_from_one_of_several_roots_is_taken_and_told(two, mmrs, path):
    _, words, _ = mmrs("show", two, "--path", path)
    assert words == "/1/keepers[0]: Keeper badge=k2\n"


def test_a_fault_below_one_of_several_roots_tells_its_number(two, mmrs):
    code, _, faults = mmrs("validate", two)
    assert code == 1
    assert "strength: no feature of Keeper" in faults
    assert "at: /1/keepers[0]" in faults


def test_what_a_reference_leads_to_inside_an_unknown_element_is_told_by_its_path(lion, mmrs):
    Path("far.xmi").write_text(
        '<zoo:Zoo xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:zoo="urn:test:zoo"'
        ' xmlns:far="urn:far" star="//@animals.0/@cubs.1"><animals xsi:type="far:Cage"/></zoo:Zoo>'
    )
    _, words, _ = mmrs("show", "far.xmi", "--path", "star")
    _, encoded, _ = mmrs("show", "far.xmi", "--path", "star", "--json")
    assert words == "/animals[0]/cubs[1]: something inside Cage (unknown, of urn:far)\n"
    assert json.loads(encoded)["found"][0]["value"] == "/animals[0]/cubs[1]"
