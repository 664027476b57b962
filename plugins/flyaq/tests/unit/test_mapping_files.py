"""Mapping files are checked before anything is migrated, and every fault says where."""

import re

import pytest
from mmrs_flyaq.plugin import FLYAQ_2015
from mmrs_flyaq.rules.mapping_file import read_mapping

from mmrs_core.errors import UnreadableError

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
    assert [str(path) for path in found.rules["port.Hull"].uses["title"].to] == ["name"]
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
        ('"length: number"', '"length: metre"', "port.Hull: length: 'metre' is not a declared class"),
        ("urn:mmrs:robot:1.0", "urn:mmrs:robots", "languages: robot: urn:mmrs:robots is not installed"),
        ("[languages]", "[languages", "not TOML"),
        ("port.uris", "harbour.uris", "packages: port: needs 'uris' or 'files'"),
        ('port.uris = "urn:example:port"', "port.uris = []", "packages: port: needs 'uris' or 'files'"),
        (
            'title = "name"',
            'length = { to = "size.length", times = nan }',
            "times: expected a number other than 0, not nan",
        ),
        (
            'title = "name"',
            'length = { to = "size.length", times = 0 }',
            "times: expected a number other than 0, not 0",
        ),
        (
            'title = "name"',
            'colour = { to = "name", values = { REED = "red" } }',
            "port: Hull: colour: values: 'REED' is not a literal of colour (RED, BLUE); did you mean RED?",
        ),
        (
            'title = "name"',
            'colour = { to = "rangingSystem", values = { RED = "LIDER" } }',
            "; did you mean LIDAR?",
        ),
        (
            'title = "name"',
            'cabins = ["batteries", "devices"]',
            "an element has one place only, not 2: batteries, devices",
        ),
    ],
)
def test_a_fault_of_a_mapping_says_where_it_is(read, old, new, message):
    with pytest.raises(UnreadableError) as fault:
        read(GOOD.replace(old, new, 1) if "Hull" not in old else GOOD.replace(old, new))
    assert message in str(fault.value)
    assert re.search(r"m\.toml:\d+: ", str(fault.value))


FLYAQ = FLYAQ_2015.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'set.altitudeReference = "ORIGIN"',
            'set.altitudeReference = "MOON"',
            "set: altitudeReference: 'MOON' is not a literal of AltitudeReference (ELLIPSOID, MSL, ORIGIN)",
        ),
        ('set.altitudeReference = "ORIGIN"', 'set.reserve = "x"', "set: reserve: 'x': not a"),
        (
            'set.altitudeReference = "ORIGIN"',
            "set.geoidSeparation = true",
            "set: geoidSeparation: 'true': not a",
        ),
        ('set.altitudeReference = "ORIGIN"', 'set.team = "x"', "set: team: 'x': team holds elements"),
        ("absent = 50.0", 'absent = "four"', "gridResolution: absent: 'four': not a"),
        ('absent = "NORMAL"', 'absent = "NORMALLY"', "absent: 'NORMALLY' is not a literal of GoToType"),
        (
            'absent = "{type}_{number}"',
            'absent = "{nope}_{number}"',
            "absent: 'nope' is not a declared feature",
        ),
        ('hoist = "targets"', 'hoist = "nowhere"', "home: hoist: 'nowhere': no class that a rule leads to"),
        ('radius = "radius"', 'radius = "name"', "Circle: ring: radius: name holds no number"),
        ('clockwise = "clockwise"', 'clockwise = "way"', "ring: clockwise: 'way' is not a declared feature"),
        ('below = "maxHeight"', 'below = "name"', "minHeight: below: name holds no number"),
        ('below = "maxHeight"', 'below = "greatest"', "below: 'greatest' is not a declared feature"),
        (
            'given = "maxPayload"',
            'given = "payload"',
            "given: 'payload' is not a declared feature of drone.Fl",
        ),
        ('given = ["maxPayload",', 'given = ["payload",', "also: given: 'payload' is not a declared feature"),
        (
            'radius = { with = "targetPosition"',
            'radius = { with = "x"',
            "radius: with: 'x' is not a declared",
        ),
        ('of = "receiver"', 'of = "name"', "slot: counterpart: of: name is no reference"),
        ('within = "slots"', 'within = "boxes"', "counterpart: within: 'boxes': no class that a rule"),
        ('action = "actionName"', 'action = "parameters"', "device: action: parameters is no attribute"),
        ('to = "deviceId"', 'to = "parameters"', "device: to: 'id': parameters holds elements, not values"),
        ('wait = { slot = "slot"', 'wait = { slot = "name"', "wait: slot: name is no reference"),
        ('add = "waitFor"', 'add = "waits"', "wait: add: 'waits': no transition has such a"),
        ('add = "waitFor"', 'add = "slots"', "wait: add: 'slots': no transition has such a reference"),
        ("at = { preActions", "at = { beforehand", "wait: at: 'beforehand' is not a declared feature of any"),
        ('as = "home"', 'as = "house"', "home: as: no rule has the variant 'house'"),
        ('first_of = "shell"', 'first_of = "name"', "initialPosition: first_of: name is no contained"),
        ("widen = 1.0", "widen = -1.0", "shell: widen: expected metres, not -1"),
        (
            'features.drones = "robots"',
            'features.drones = { to = "robots", times = 2 }',
            "times: means nothing",
        ),
        ('name = "name"', 'name = { to = "name", distinct = true }', "distinct: means nothing for name"),
        ('giro = { to = "gyro"', 'giro = { to = "gps"', "gps: to: gps takes one value only, and giro goes"),
        (
            'crs = { to = "crs"',
            'crs = { to = "altitudeReference"',
            "absent: 'wgs84' is not a literal of Alti",
        ),
        ('tasks = "tasks"', 'tasks = "crs"', "tasks: to: crs holds values, and tasks holds elements"),
        ('name = "name"', 'name = "team"', "name: to: team holds elements, and name is an attribute"),
        ('from = "from"', 'from = "name"', "from: to: name holds values, and from holds elements"),
        ('swarm = "team"', 'swarm = { to = "team", hoist = "tasks" }', "team contains, so nothing is to be"),
        (', hoist = "targets", as = "home"', ', as = "home"', "home only refers: needs 'hoist'"),
        ("absent = 0.0, bearing", 'absent = "north", bearing', "direction: absent: expected a number"),
        ('"targetPosition", absent = false', '"targetPosition", absent = "no"', "expected true or false"),
        ('{ TakeSnapshot = "TakePicture" }', "{ TakeSnapshot = 2 }", "TakeSnapshot: expected a text, not 2"),
    ],
)
def test_what_makes_no_sense_is_refused_before_anything_is_read(read, old, new, message):
    assert old in FLYAQ
    line = FLYAQ.partition(old)[0].count("\n") + 1
    with pytest.raises(UnreadableError) as fault:
        read(FLYAQ.replace(old, new, 1))
    assert message in str(fault.value)
    told = int(re.search(r"m\.toml:(\d+): ", str(fault.value))[1])
    assert line - 10 <= told <= line + 10, "told far from where it is"


def test_a_constant_and_a_feature_for_one_value_are_refused(read):
    with pytest.raises(UnreadableError, match=r"name takes one value only, and set: name goes there already"):
        read(GOOD.replace("[rules.port.Hull.features]", 'set.name = "x"\n[rules.port.Hull.features]'))


def test_a_wrong_constant_at_the_end_of_a_path_has_its_line(read):
    text = GOOD.replace("[rules.port.Hull.features]", 'set."size.height" = "x"\n[rules.port.Hull.features]')
    with pytest.raises(UnreadableError, match=r"m\.toml:11: .*set: size\.height: 'x': not a"):
        read(text)


def test_constants_of_a_rule_that_makes_nothing_are_refused(read):
    with pytest.raises(UnreadableError, match="port: Named: set: means nothing without 'to'"):
        read(GOOD + '[rules.port.Named]\nset.name = "x"\n')


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ('title = "name"', "title = name", 12),
        ('title = "name"', '# none\ntitle = { too = "name" }', 13),
        ('features]\ntitle = "name"', 'features."title"]\ntoo = "name"', 12),
        ('"length: number"', '"length: metre"', 8),
        ('to = "robot:Robot"', 'to = "robot:Robo"', 10),
        ("port.uris", "harbour.uris", 4),
    ],
)
def test_a_fault_of_a_mapping_has_a_line(read, old, new, line):
    with pytest.raises(UnreadableError, match=rf"m\.toml:{line}: "):
        read(GOOD.replace(old, new))


def test_a_key_that_stands_in_a_table_of_its_own_is_found_there(read):
    text = GOOD + '[rules.port.Hull.features.length]\nto = "size.length"\ntime = 2\n'
    with pytest.raises(UnreadableError, match=r"m\.toml:15: rules: port: Hull: length: time: no such key"):
        read(text)


def test_a_form_of_document_needs_something_to_be_recognised_by(read):
    with pytest.raises(UnreadableError, match="needs 'under' or 'keys'"):
        read(GOOD + '[documents.tides]\nis = "a tide table"\n')


@pytest.mark.parametrize("text", ["", 'name = "Port"\n'])
def test_a_mapping_without_rules_is_none(read, text):
    with pytest.raises(UnreadableError, match="contains no rules"):
        read(text)


def test_a_mapping_that_nests_too_deeply_for_the_parser_is_refused(read):
    with pytest.raises(UnreadableError, match=r"m\.toml: nested too deeply"):
        read("x = " + "[" * 3000)
