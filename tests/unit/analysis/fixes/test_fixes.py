"""Every quick fix gives a text that was spoilt in one place back as it was."""

import re
from pathlib import Path

import pytest

from mmrs_core.analysis.fixes import FIXES
from mmrs_core.analysis.fixes.repair import with_edits
from mmrs_core.analysis.fixes.spelling import meant
from mmrs_core.contributions.fixes import Edit, Fix, with_value

EXAMPLES = Path(__file__).parents[4] / "examples"
DAM, PARK = EXAMPLES / "mixed-team", EXAMPLES / "carbon-dioxide"
CLOCK = EXAMPLES / "handwritten"
VERTEX = '    <shell xsi:type="mission:GeoCoordinate" latitude="42.539040" longitude="13.394370"/>\n'
WAY = '  <taskDependencies from="//@tasks.0" to="//@tasks.1"/>\n'

SPOILT = {
    "XMI001": (DAM, "mission.xmi", "urn:mmrs:survey:1.0", "urn:mmrs:survay:1.0"),
    "XMI002": (DAM, "mission.xmi", "survey:MeasureTask", "survey:MesureTask"),
    "XMI002 of a root": (PARK, "context.xmi", "context:Context", "context:Kontext"),
    "XMI003": (DAM, "mission.xmi", '<home xsi:type="mission:GeoCoordinate" ', "<home "),
    "XMI004": (DAM, "mission.xmi", 'photoDistance="20.0"', 'photoDistanse="20.0"'),
    "XMI004 of an element": (DAM, "mission.xmi", "<initialPosition", "<initalPosition"),
    "XMI004 of a value": (
        EXAMPLES / "pool",
        "mission.xmi",
        "<acceptedUnknowns>range</acceptedUnknowns>",
        "<acceptedUnknown>range</acceptedUnknown>",
    ),
    "XMI005": (DAM, "mission.xmi", 'travelMode="SAFE"', 'travelMode="Safe"'),
    "XMI005 of a truth": (DAM, "mission.xmi", 'returnHome="true"', 'returnHome="yes"'),
    "XMI005 of a decimal comma": (DAM, "mission.xmi", 'latitude="42.538500"', 'latitude="42,538500"'),
    "XMI006": (DAM, "mission.xmi", 'to="crest is free"', 'to="crest is fere"'),
    "XMI006 of a list": (CLOCK, "behaviour.xmi", 'waitFor="ready down"', 'waitFor="redy down"'),
    "MML001": (DAM, "mission.xmi", 'crs="EPSG:4326"', 'crs="EPSG-4326"'),
    "CTX001": (DAM, "context.xmi", 'crs="EPSG:4326"', 'crs="EPSG 4326"'),
    "BL016": (CLOCK, "behaviour.xmi", 'crs="EPSG:4326" name="Clock', 'crs="GPS" name="Clock'),
    "MML004": (DAM, "mission.xmi", 'type="Camera drone">', 'type="camera-drone">'),
    "MML005": (DAM, "mission.xmi", 'reserve="0.3"', 'reserve="30"'),
    "MML012": (DAM, "mission.xmi", 'acceptedUnknowns="clearance" name', 'acceptedUnknowns="clearence" name'),
    "MML027": (PARK, "context.xmi", 'latitude="{0}" longitude="{1}"', 'latitude="{1}" longitude="{0}"'),
    "MML029": (PARK, "context.xmi", 'latitude="42.369802"', 'latitude="-42.369802"'),
    "MML030": (PARK, "context.xmi", 'longitude="13.349126"', 'longitude="-13.349126"'),
    "MML041": (DAM, "mission.xmi", WAY, f'{WAY}  <taskDependencies from="//@tasks.3" to="//@tasks.3"/>\n'),
    "MML042": (DAM, "mission.xmi", WAY, WAY + WAY),
    "BL035": (CLOCK, "behaviour.xmi", 'typeName="Small drone"', 'typeName="Smal drone"'),
    "BL036": (CLOCK, "behaviour.xmi", 'actionName="TakePicture" deviceId="camera"', None),
    "BL037": (CLOCK, "behaviour.xmi", 'actionName="TakePicture"', 'actionName="TakePictures"'),
    "BL039": (CLOCK, "behaviour.xmi", '<heading deviceId="camera"', '<heading deviceId="kamera"'),
    "BL046": (CLOCK, "behaviour.xmi", 'reserve="0.25"', 'reserve="25"'),
    "BL049": (CLOCK, "behaviour.xmi", ">energy<", ">enregy<"),
    "CTX006": (DAM, "context.xmi", VERTEX, VERTEX + VERTEX),
    "CTX007": (DAM, "context.xmi", 'minHeight="4.0" maxHeight="9.0"', 'minHeight="9.0" maxHeight="4.0"'),
    "CTX012": (DAM, "context.xmi", 'windDirection="310"', 'windDirection="-50"'),
    "CTX018": (DAM, "context.xmi", 'width="60.0"', 'width="-60.0"'),
    "CTX019": (DAM, "context.xmi", 'minHeight="10.0" maxHeight="50.0"', 'minHeight="50.0" maxHeight="10.0"'),
    "CTX027": (DAM, "context.xmi", ">Camera drone<", ">camera-drone<"),
    "RL017": (
        DAM,
        "robots/camera-drone.xmi",
        'Temperature min="-10.0" max="40.0"',
        'Temperature min="40.0" max="-10.0"',
    ),
}
ADDED = {
    "XMI006": ('to="//@tasks.1"', 'to="crest is free"'),
    "XMI006 of a list": ('waitFor="//@robots.0/@slots.0"', 'waitFor="ready down"'),
    "BL016": ('name="Clock', 'crs="EPSG:4326" name="Clock'),
    "MML012": ('name="Dam inspection"', 'acceptedUnknowns="clearance" name="Dam inspection"'),
    "CTX012": ('windDirection="310.0"', 'windDirection="310"'),
}
CORRIDOR = """  <corridors name="crest road" width="60.0" minHeight="10.0" maxHeight="50.0">
    <points xsi:type="mission:GeoCoordinate" latitude="42.5385" longitude="13.3940"/>
    <points xsi:type="mission:GeoCoordinate" latitude="42.5385" longitude="13.3945"/>
    <robotTypes>Camera drone</robotTypes>
  </corridors>
"""
ADDED |= dict.fromkeys(("CTX018", "CTX019", "CTX027"), ("  <environment ", f"{CORRIDOR}  <environment "))
"""What a sound text is made to say first, so that it can be spoilt."""
ELSEWHERE = {"MML072": "shells of tasks are mended as those of areas", "XMI014": "see below"}


def texts(name):
    """Return the project, the file, and its text as it ought to be and as it is."""
    folder, relative, right, wrong = SPOILT[name]
    file = (folder / relative).resolve()
    folder = folder / "behaviour.xmi" if folder == CLOCK else folder
    sound = file.read_text(encoding="utf-8")
    if name in ADDED:
        sound = sound.replace(*ADDED[name], 1)
    if name == "MML027":
        tag = next(line for line in sound.splitlines() if "<shell" in line)
        numbers = tag.split('"')[3], tag.split('"')[5]
        right, wrong = right.format(*numbers), wrong.format(*numbers)
    if name == "BL036":
        wrong = right.replace("camera", "kamera")
    assert right in sound
    return folder, file, sound, sound.replace(right, wrong, 2 if "root" in name else 1)


@pytest.mark.parametrize("name", sorted(SPOILT))
def test_a_spoilt_text_is_mended_to_what_it_was(mended, name):
    folder, file, sound, spoilt = texts(name)
    repair = mended(folder, {file: spoilt.encode()})
    assert name[:6].strip() in {each.fault.code for each in repair.applied}
    assert repair.texts[file].decode() == sound
    assert not repair.refused


def test_a_name_with_another_number_is_not_taken_for_misspelt(mended):
    file = (DAM / "mission.xmi").resolve()
    text = file.read_text(encoding="utf-8").replace('name="crest is free"', 'name="fork 1"')
    spoilt = text.replace('to="//@tasks.1"', 'to="fork 2"', 1)
    assert not mended(DAM, {file: spoilt.encode()}).applied


def test_every_fix_of_the_core_is_tried():
    assert {fix.code for fix in FIXES} == {name.split()[0] for name in SPOILT} | set(ELSEWHERE)


def test_a_prefix_is_declared_that_only_one_metamodel_has(mended):
    file = (DAM / "mission.xmi").resolve()
    spoilt = file.read_text(encoding="utf-8").replace(' xmlns:survey="urn:mmrs:survey:1.0"', "")
    repair = mended(DAM, {file: spoilt.encode()})
    assert b'xmlns:survey="urn:mmrs:survey:1.0"' in repair.texts[file]
    assert repair.diagnosis.complete
    assert [each for each in repair.diagnosis.wrong if each.code == "XMI014"] == []


def test_a_fix_that_brings_another_error_is_refused(mended):
    folder, file, _, spoilt = texts("MML005")

    def worse(wrong):
        yield with_value(wrong.tag.attribute("reserve"), "nothing")

    repair = mended(folder, {file: spoilt.encode()}, [Fix("MML005", "spoil it", worse)])
    assert repair.applied == ()
    assert [each.fault.code for each in repair.refused] == ["MML005"]
    assert repair.texts[file].decode() == spoilt


def test_a_fix_that_makes_the_text_unreadable_is_refused(mended):
    folder, file, _, spoilt = texts("MML005")
    torn = [Fix("MML005", "tear it", lambda wrong: [Edit(0, len(wrong.markup.data) // 2, "")])]
    assert mended(folder, {file: spoilt.encode()}, torn).applied == ()


def test_one_bad_fix_does_not_keep_others_from_being_applied(mended):
    folder, file, _, spoilt = texts("MML005")
    twice = spoilt.replace('travelMode="SAFE"', 'travelMode="safe"').encode()
    torn = Fix("MML005", "tear it", lambda wrong: [Edit(0, len(wrong.markup.data) // 2, "")])
    fixes = [torn, next(fix for fix in FIXES if fix.code == "XMI005")]
    repair = mended(folder, {file: twice}, fixes)
    assert [each.fault.code for each in repair.applied] == ["XMI005"]


def test_vertices_stay_where_references_count_them(mended):
    folder, file, _, spoilt = texts("CTX006")
    referring = spoilt.replace("<!-- stands in the lake -->", "<!-- //@shell.1 -->")
    repair = mended(folder, {file: referring.encode()})
    assert "CTX006" not in {each.fault.code for each in repair.applied}


def test_a_word_between_two_known_ones_is_left_alone():
    assert meant("cat", ["car", "cut"]) is None


def test_edits_that_overlap_are_none():
    assert with_edits(b"abcdef", [Edit(0, 3, "x"), Edit(2, 4, "y")]) is None


def test_edits_leave_everything_else_as_it_is():
    assert with_edits(b"abcdef", [Edit(4, 5, "E"), Edit(1, 1, "+")]) == b"a+bcdEf"


PLACE = r'latitude="([^"]*)" longitude="([^"]*)"'
EXCHANGED = r'latitude="\2" longitude="\1"'


def placed(relative, pattern, replacement, count=0):
    """Return a file of the park and its text in which places were changed."""
    file = (PARK / relative).resolve()
    return file, re.sub(pattern, replacement, file.read_text(encoding="utf-8"), count=count)


@pytest.mark.parametrize("relative", ["mission.xmi", "context.xmi"])
def test_two_files_that_disagree_are_both_named_and_neither_is_changed(mended, relative):
    file, spoilt = placed(relative, PLACE, EXCHANGED)
    repair = mended(PARK, {file: spoilt.encode()})
    assert [each.code for each in repair.diagnosis.wrong] == ["CTX008", "MML028"]
    assert {Path(each.place.file).name for each in repair.diagnosis.wrong} == {"context.xmi", "mission.xmi"}
    assert repair.applied == repair.refused == ()


@pytest.mark.parametrize("relative", ["mission.xmi", "context.xmi"])
def test_two_files_that_disagree_are_named_where_exchanged_figures_are_near(mended, relative):
    texts = {}
    for each in ("mission.xmi", "context.xmi"):
        # 13.74 north and 13.35 east: exchanged, some 60 km off
        file, text = placed(each, r'latitude="42\.(\d+)"', r'latitude="13.7\1"')
        texts[file] = (re.sub(PLACE, EXCHANGED, text) if each == relative else text).encode()
    repair = mended(PARK, texts)
    assert [each.code for each in repair.diagnosis.wrong[:2]] == ["CTX008", "MML028"]
    assert "latitude and longitude may be exchanged" in repair.diagnosis.wrong[0].hint
    assert repair.applied == repair.refused == ()


def test_the_homes_are_mended_where_tasks_and_context_agree(mended):
    file, spoilt = placed("mission.xmi", f"<home(.*){PLACE}", r'<home\1latitude="\3" longitude="\2"')
    repair = mended(PARK, {file: spoilt.encode()})
    assert [each.fault.code for each in repair.applied] == ["MML027"] * 3
    assert repair.texts[file] == file.read_bytes()
    assert repair.diagnosis.wrong == ()


def test_one_home_with_two_wrong_signs_is_accused_and_left_as_it_is(mended):
    file, spoilt = placed(
        "mission.xmi", '"42.370000" longitude="13.350097"', '"-42.37" longitude="-13.350097"'
    )
    repair = mended(PARK, {file: spoilt.encode()})
    assert [(each.code, each.place.path) for each in repair.diagnosis.wrong] == [
        ("MML028", "/team/robots[1]")
    ]
    assert repair.diagnosis.wrong[0].message.endswith("with the other signs, it lies among them")
    assert repair.applied == repair.refused == ()


def test_a_fix_that_hides_another_fault_is_refused(mended):
    # in its right place, the second home would link the third, which is 101 km away, with the rest
    file, spoilt = placed("mission.xmi", '"42.370000" longitude="13.350097"', '"13.395" longitude="42.37"')
    spoilt = spoilt.replace('longitude="13.350194"', 'longitude="14.58"')
    repair = mended(PARK, {file: spoilt.encode()})
    assert [(each.code, each.place.path) for each in repair.diagnosis.wrong] == [
        ("MML027", "/team/robots[1]"),
        ("MML028", "/team/robots[2]"),
    ]
    assert repair.applied == ()
    objection = f"that would hide MML028 at {repair.diagnosis.wrong[1].place}, and not fix it"
    assert [each.objection for each in repair.refused] == [objection]


def test_faults_of_other_elements_go_with_the_value_that_they_stem_from(examined):
    file = (DAM / "mission.xmi").resolve()
    text = re.sub(f"(<home.*){PLACE}", r'\1latitude="\3" longitude="\2"', file.read_text("utf-8"))
    repairer, now = examined(DAM, {file: text.encode()})
    assert "/tasks[8]" in {each.place.path for each in now.wrong}  # it is placed relative to a home
    assert repairer.repair(now, {file: text.encode()}).texts[file] == file.read_bytes()


def test_one_home_with_the_wrong_sign_is_accused_and_not_its_neighbours(examined):
    file, spoilt = placed("mission.xmi", 'longitude="13.350097"', 'longitude="-13.350097"')
    _repairer, now = examined(PARK, {file: spoilt.encode()})
    assert [(each.code, each.place.path) for each in now.wrong] == [("MML030", "/team/robots[1]")]


def test_places_far_apart_are_sound_where_the_mission_says_so(examined):
    file, spoilt = placed("mission.xmi", 'longitude="13.350097"', 'longitude="17.350097"')
    said = spoilt.replace('reserve="0.25"', 'largestGap="400000" reserve="0.25"')
    for text, codes in ((spoilt, ["MML028"]), (said, [])):
        _, now = examined(PARK, {file: text.encode()})
        assert [each.code for each in now.wrong] == codes
