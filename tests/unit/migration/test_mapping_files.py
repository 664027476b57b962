"""Mapping files are checked before anything is migrated, and every fault says where."""

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.migration.rules.mapping_file import read_mapping

GOOD = """
[languages]
robot = "urn:mmrs:robot:1.0"
[packages]
port.uris = "urn:example:port"
[structure.port]
Named = ["title: text"]
Hull = ["Named", "length: number", "colour: RED | BLUE", "mate: -> Hull", "cabins: Named *"]
[rules.port.Hull]
to = "robot:Robot"
[rules.port.Hull.features]
title = "name"
"""


@pytest.fixture
def read(written, registry):
    return lambda text: read_mapping(written("m.toml", text), registry)


def test_a_mapping_is_read(read):
    found = read(GOOD)
    assert found.rules["port.Hull"].to == ("urn:mmrs:robot:1.0", "Robot")
    assert found.rules["port.Hull"].uses["title"].to == ("name",)
    assert found.dialect.package("urn:example:port") == "port"
    assert found.dialect.package("file:/home/me/port.ecore") == "port"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'to = "robot:Robot"',
            'to = "robot:Robt"',
            "rules: port: Hull: to: Robt: no class of urn:mmrs:robot:1.0",
        ),
        (
            'to = "robot:Robot"',
            'to = "boat:Robot"',
            "to: 'boat:Robot': 'boat' is none of the languages (robot)",
        ),
        ('to = "robot:Robot"', 'too = "robot:Robot"', "too: no such key here; did you mean to?"),
        ('to = "robot:Robot"', "to = 3", "to: expected a text, not 3"),
        ('title = "name"', 'title = "nam"', "title: nam: no feature of Robot; did you mean name?"),
        ('title = "name"', 'title = "size.wide"', "title: wide: no feature of Size"),
        ('title = "name"', 'title = "name.x"', "'name.x': name of Robot contains no elements"),
        ('title = "name"', 'title = "a[b"', "'a[b': no path of features"),
        ('title = "name"', 'titel = "name"', "titel: no declared feature of port.Hull"),
        ('title = "name"', "title = { times = 2 }", "needs one of 'to', 'drop' and 'with'"),
        (
            'title = "name"',
            'title = { to = "name", time = 2 }',
            "time: no such key here; did you mean times?",
        ),
        ('title = "name"', 'title = { to = "name", times = "2" }', "times: expected a number, not '2'"),
        (
            'title = "name"',
            'title = { to = "name", bearing = { base = "here" } }',
            "needs base = 'self' or 'home'",
        ),
        ("[rules.port.Hull]", "[rules.port.Hulk]", "port.Hulk is not among the declared classes"),
        ('"length: number"', '"length: metre"', "port.Hull: length: 'metre' is no declared class"),
        ("urn:mmrs:robot:1.0", "urn:mmrs:robots", "languages: robot: urn:mmrs:robots is not installed"),
        ("[languages]", "[languages", "not TOML"),
    ],
)
def test_a_fault_of_a_mapping_says_where_it_is(read, old, new, message):
    with pytest.raises(UnreadableError) as fault:
        read(GOOD.replace(old, new, 1) if "Hull" not in old else GOOD.replace(old, new))
    assert message in str(fault.value)
    assert "m.toml: " in str(fault.value)


def test_a_form_of_document_needs_something_to_be_recognised_by(read):
    with pytest.raises(UnreadableError, match="needs 'under' or 'keys'"):
        read(GOOD + '[documents.tides]\nis = "a tide table"\n')
