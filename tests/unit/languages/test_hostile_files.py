import os

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.xmi import events as xml_events

ROOT = b'<m:Mission xmlns:m="urn:mmrs:mission:1.0"'


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"   ",
        b"no xml at all",
        b"\x00\x01\x02" * 100,
        b"\xff\xfe\x00",
        b"<a><b></a>",
        ROOT,
        ROOT + b">",
        ROOT + b' name="a" name="b"/>',
        ROOT + b'/><extra xmlns="x"/>',
        ROOT + b' name="&unknown;"/>',
        ROOT + b' name="\x01"/>',
        b'<?xml version="1.0" encoding="ASCII"?>' + ROOT + b' name="\xc3\xbc"/>',
        b'<?xml version="1.0" encoding="klingon"?>' + ROOT + b"/>",
        b'<?xml version="1.0" encoding="utf-7"?>' + ROOT + b"/>",
        b'<?xml version="1.0" encoding="shift_jis"?>' + ROOT + b"/>",
        b"<m:Mission/>",
        b'{"eClass": "Mission"}',
    ],
)
def test_what_is_no_xml_is_unreadable_with_its_name(core, data):
    with pytest.raises(UnreadableError, match=r"^bad\.xmi"):
        read_text(data, "bad.xmi", core)


@pytest.mark.parametrize(
    "doctype",
    [
        b"<!DOCTYPE m>",
        b'<!DOCTYPE m [<!ENTITY a "b">]>',
        b'<!DOCTYPE m SYSTEM "file:///etc/passwd">',
        b'<!DOCTYPE m [<!ENTITY x SYSTEM "http://127.0.0.1:1/">]>',
    ],
)
def test_a_doctype_is_refused_before_anything_else(core, doctype):
    with pytest.raises(UnreadableError, match=r"^bad\.xmi:1: DOCTYPE is not accepted"):
        read_text(doctype + ROOT + b' name="&a;"/>', "bad.xmi", core)


def test_an_element_with_more_attributes_than_any_model_is_unreadable(core):
    crowd = b" ".join(b"a%d='>'" % index for index in range(10_001))
    with pytest.raises(UnreadableError, match=r"^bad\.xmi:2: more than 10000 attributes in one element"):
        read_text(b"<?xml version='1.0'?>\n" + ROOT + b" " + crowd + b"/>", "bad.xmi", core)


def test_a_long_text_or_value_is_not_taken_for_many_attributes(core):
    long = b" a='1'" * 20_000
    model = read_text(ROOT + b' name="x' + long + b'"/>', "long.xmi", core)
    assert model.diagnostics == ()
    stray = read_text(ROOT + b">" + long + b"</m:Mission>", "long.xmi", core)
    assert {fault.code for fault in stray.diagnostics} == {"XMI010"}


def test_deep_nesting_is_unreadable(core):
    with pytest.raises(UnreadableError, match="nested deeper than"):
        read_text(ROOT + b">" + b"<a>" * 100_000, "deep.xmi", core)


def test_deep_nesting_that_is_still_allowed_can_be_read_and_written(zoo, zoo_text):
    from mmrs_core.languages.conformance import check_conformance
    from mmrs_core.languages.writing import to_xmi

    depth = xml_events.DEEPEST_NESTING - 2
    text = '<cubs xsi:type="zoo:Lion" name="l">' * depth + "</cubs>" * depth
    model = read_text(zoo_text(f'<guest xsi:type="zoo:Lion" name="g">{text}</guest>'), "deep.xmi", zoo)
    assert model.diagnostics == ()
    assert check_conformance(model, zoo) == ()
    assert to_xmi(read_text(to_xmi(model.roots, zoo), "again", zoo).roots, zoo) == to_xmi(model.roots, zoo)


def test_a_missing_file_a_folder_and_a_device_are_unreadable(core, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for name, why in (("gone.xmi", "no such file"), (".", "not a file"), ("pipe", "not a file")):
        with pytest.raises(UnreadableError, match=why):
            read_model(tmp_path / name, core)


def test_a_file_beyond_the_bound_is_not_even_opened(core, tmp_path, monkeypatch):
    path = tmp_path / "large.xmi"
    with path.open("wb") as stream:
        stream.truncate(xml_events.LARGEST_FILE + 1)
    with pytest.raises(UnreadableError, match=r"large\.xmi: larger than 512 MB"):
        read_model(path, core)


@pytest.mark.parametrize("unit", [b"\x00", b"<a/>", b"junk ", b"<a>"])
def test_megabytes_of_junk_end_quickly(core, unit):
    with pytest.raises(UnreadableError):
        read_text(unit * (5_000_000 // len(unit)), "junk.xmi", core)


def test_a_long_value_is_cut_in_messages(read_zoo):
    model = read_zoo("x" * 100_000)
    assert len(model.diagnostics[0].message) < 200


def test_a_long_path_that_leads_nowhere_does_not_take_long(read_zoo):
    path = "/" + "/@animals.0/@cubs.0" * 20_000
    model = read_zoo('<animals xsi:type="zoo:Lion" name="a"/>', f'star="{path}"')
    assert [fault.code for fault in model.diagnostics] == ["XMI006"]


def test_hostile_names_are_only_names(core):
    name = "'; import os; os.system('x') # {{7*7}} %s &lt;b> ../../x"
    model = read_text(ROOT + f' name="{name}"/>'.encode(), "m.xmi", core)
    assert model.roots[0].name == name.replace("&lt;", "<")


def test_more_faults_than_anybody_would_read_end_the_reading(core):
    with pytest.raises(
        UnreadableError, match=r"^wide:1: more than 10000 faults; the first is: x: no feature"
    ):
        read_text(ROOT + b">" + b"<x/>" * 20_000 + b"</m:Mission>", "wide", core)
