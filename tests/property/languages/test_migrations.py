"""Random models of an older version say after migration what they said before, by the newer names."""

import json
import re
from pathlib import Path

import pytest
from counts import many
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.diagnostics import has_errors
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import to_json, to_xmi
from mmrs_core.testing.instances import instances_of

ZOO = Path(__file__).parents[2] / "fixtures" / "models" / "zoo.ecore"
OLD, MIDDLE, NEW = "urn:old:zoo", "urn:middle:zoo", "urn:test:zoo"
FIRST = {"Zoo.beasts": "creatures", "Beast.young": "cubs", "Cat.fangs": "teeth", "Keeper.cares": "keeps"}
SECOND = {"Zoo.creatures": "animals", "Animal.partner": "mate", "Parrot.home": "nest"}
STEPS = (
    Migration(OLD, MIDDLE, classes={"Beast": "Animal", "Cat": "Lion"}, features=FIRST),
    Migration(MIDDLE, NEW, features=SECOND),
    Migration(f"{OLD}:wing", f"{NEW}:wing", features={"Parrot.home": "nest"}),
)
KEYS = {
    "beasts": "animals",
    "young": "cubs",
    "fangs": "teeth",
    "cares": "keeps",
    "partner": "mate",
    "home": "nest",
}
RELAXED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


@pytest.fixture(scope="module")
def old(tmp_path_factory):
    """Return the older version of the zoo, whose names differ."""
    text = ZOO.read_text(encoding="utf-8").replace('nsURI="urn:test:zoo', f'nsURI="{OLD}')
    for before, after in KEYS.items():
        text = text.replace(f'name="{after}"', f'name="{before}"').replace(f'/{after}"', f'/{before}"')
    for before, after in (("Beast", "Animal"), ("Cat", "Lion")):
        text = re.sub(rf'(name="|#//){after}\b', rf"\1{before}", text)
    file = tmp_path_factory.mktemp("old") / "old.ecore"
    file.write_text(text, encoding="utf-8")
    return registry_with([MetamodelSource(OLD, file, "old")])


@pytest.fixture(scope="module")
def new():
    """Return the newer version, to which migrations lead."""
    return registry_with([MetamodelSource(NEW, ZOO, "zoo")], STEPS)


def renamed(value, key=""):
    """Return what JSON of the older version says, by the newer names."""
    if isinstance(value, dict):
        return {KEYS.get(name, name): renamed(each, name) for name, each in value.items()}
    if isinstance(value, list):
        return [renamed(each, key) for each in value]
    if key == "$type":
        return value.replace("Cat", "Lion")
    if isinstance(value, str) and key in REFERENCES:
        return re.sub(r"@(\w+)", lambda match: f"@{KEYS.get(match[1], match[1])}", value)
    return value.replace(OLD, NEW) if isinstance(value, str) and key in ("zoo", "wing") else value


REFERENCES = ("star", "favourites", "anything", "partner", "mateOf", "keptBy", "cares", "deputy")


@RELAXED
@given(data=st.data())
def test_a_migrated_model_says_what_it_said(old, new, data):
    root = data.draw(instances_of(old, OLD))
    before = to_json([root], old)
    write, name = data.draw(st.sampled_from([(to_xmi, "a.xmi"), (to_json, "a.json")]))
    model = read_text(write([root], old), name, new)
    assert not has_errors((*model.diagnostics, *check_conformance(model, new)))
    assert json.loads(to_json(model.roots, new)) == renamed(json.loads(before))


SAMPLE = f"""<zoo:Zoo xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
  xmlns:zoo="{OLD}" xmlns:far="urn:far" name="z" star="//@beasts.1">
  <beasts xsi:type="zoo:Cat" xmi:id="leo" name="Leo" fangs="3"><tags>a</tags><motto xsi:nil="true"/></beasts>
  <beasts xsi:type="zoo:Otter" name="Ot" depth="2.5"><young xsi:type="far:Alien"><x/></young></beasts>
  <keepers cares="//@beasts.0 //@beasts.1"/><anything href="#leo"/>
</zoo:Zoo>
""".encode()
PIECES = st.sampled_from(
    [
        b"",
        b"<",
        b">",
        b'"',
        b"/>",
        b"&lt;",
        b"<!DOCTYPE x>",
        b"<![CDATA[x]]>",
        b"\x00",
        b"\xff",
        b"//@beasts.0",
        b' href="x.xmi#/"',
        b' xsi:nil="true"',
        b"<beasts/>",
        b"</beasts>",
        b' xsi:type="zoo:Cat"',
        b"<xmi:XMI>",
        b"<xmi:Extension/>",
        b"text",
        b' $x="1"',
        b' xmi:id="leo"',
        b"urn:old:zoo:wing",
        b'xmlns="urn:old:zoo"',
    ]
)


@settings(RELAXED, max_examples=many(5000))
@given(data=st.data())
def test_a_damaged_old_model_never_breaks_us(new, data):
    text = bytearray(SAMPLE)
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        text[start : start + data.draw(st.integers(0, 12))] = data.draw(PIECES)
    try:
        model = read_text(bytes(text), "damaged.xmi", new)
    except UnreadableError:
        return
    assert all(fault.place.line > 0 for fault in model.diagnostics)
    assert to_json(model.roots, new)
