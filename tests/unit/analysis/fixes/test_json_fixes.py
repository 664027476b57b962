"""Every quick fix of the core gives a JSON model that was spoilt in one place back as it was."""

import json
from pathlib import Path

import pytest

from mmrs_core.analysis.fixes import FIXES
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import to_json

EXAMPLES = Path(__file__).parents[4] / "examples"
DAM, PARK, CLOCK, POOL = (EXAMPLES / n for n in ("mixed-team", "carbon-dioxide", "handwritten", "pool"))
MISSION, CONTEXT, BEHAVIOUR = "mission.json", "context.json", "behaviour.json"
WAY = '    {"from": "//@tasks.0", "to": "//@tasks.1"},\n'
HOME = '"home": {"$type": "mission:GeoCoordinate", "latitude": 42.538428'
SPOILT = {
    "XMI001": (DAM, MISSION, '"urn:mmrs:survey:1.0"', '"urn:mmrs:survay:1.0"'),
    "XMI002": (DAM, MISSION, '"survey:MeasureTask"', '"survey:MesureTask"'),
    "XMI002 of a root": (PARK, CONTEXT, '"context:Context"', '"context:Kontext"'),
    "XMI003": (DAM, MISSION, HOME, '"home": {"latitude": 42.538428'),
    "XMI004": (DAM, MISSION, '"photoDistance"', '"photoDistanse"'),
    "XMI004 of an element": (DAM, MISSION, '"initialPosition"', '"initalPosition"'),
    "XMI004 of a list": (DAM, MISSION, '"requiredActions"', '"requredActions"'),
    "XMI004 of a list of elements": (DAM, MISSION, '"holes"', '"hols"'),
    "XMI005": (DAM, MISSION, '"SAFE"', '"Safe"'),
    "XMI005 of a truth": (PARK, "robots/quad-650.json", '"gyro": true', '"gyro": "yes"'),
    "XMI005 of a decimal comma": (DAM, MISSION, "42.538428", '"42,538428"'),
    "XMI005 of a name": (DAM, MISSION, '"name": "4"', '"name": 4'),
    "XMI006": (DAM, MISSION, '"to": "crest is free"', '"to": "crest is fere"'),
    "MML001": (DAM, MISSION, '"crs": "EPSG:4326"', '"crs": "EPSG-4326"'),
    "CTX001": (DAM, CONTEXT, '"EPSG:4326"', '"EPSG 4326"'),
    "BL016": (CLOCK, BEHAVIOUR, '"crs": "EPSG:4326"', '"crs": "GPS"'),
    "MML004": (DAM, MISSION, '"type": "Camera drone"', '"type": "camera-drone"'),
    "MML005": (DAM, MISSION, '"reserve": 0.3', '"reserve": 30'),
    "MML012": (POOL, MISSION, '["range"]', '["rang"]'),
    "MML027": (
        PARK,
        CONTEXT,
        '"latitude": 42.369802, "longitude": 13.349126',
        '"latitude": 13.349126, "longitude": 42.369802',
    ),
    "MML029": (PARK, CONTEXT, '"latitude": 42.369802', '"latitude": -42.369802'),
    "MML030": (PARK, CONTEXT, '"longitude": 13.349126', '"longitude": -13.349126'),
    "MML041": (DAM, MISSION, WAY, f'{WAY}    {{"from": "//@tasks.3", "to": "//@tasks.3"}},\n'),
    "MML042": (DAM, MISSION, WAY, WAY + WAY),
    "BL035": (CLOCK, BEHAVIOUR, '"typeName": "Small drone"', '"typeName": "Smal drone"'),
    "BL036": (CLOCK, BEHAVIOUR, '"TakePicture", "deviceId": "camera"', None),
    "BL037": (CLOCK, BEHAVIOUR, '"TakePicture", "d', '"TakePictures", "d'),
    "BL039": (CLOCK, BEHAVIOUR, '{"deviceId": "camera", "target"', '{"deviceId": "kamera", "target"'),
    "BL046": (CLOCK, BEHAVIOUR, '"reserve": 0.25', '"reserve": 25'),
    "BL049": (CLOCK, BEHAVIOUR, '"energy"]', '"enregy"]'),
    "CTX006": (DAM, CONTEXT, None, None),
    "CTX007": (DAM, CONTEXT, None, None),
    "CTX012": (DAM, CONTEXT, '"windDirection": 310', '"windDirection": -50'),
    "CTX018": (DAM, CONTEXT, '"width": 60.0', '"width": -60.0'),
    "CTX019": (DAM, CONTEXT, '10.0, "maxHeight": 50.0', '50.0, "maxHeight": 10.0'),
    "CTX027": (DAM, CONTEXT, '"Camera drone"', '"camera-drone"'),
    "RL017": (DAM, "robots/camera-drone.json", '{"min": -10, "max": 40}', '{"min": 40, "max": -10}'),
}
ADDED = {
    "XMI006": ('"to": "//@tasks.1"', '"to": "crest is free"'),
    "XMI005 of a name": ('"name": "crest road"', '"name": "4"'),
    "MML001": ('  "name": "Dam', '  "crs": "EPSG:4326",\n  "name": "Dam'),
    "BL016": ('  "name": "Clock', '  "crs": "EPSG:4326",\n  "name": "Clock'),
    "CTX012": ('"windDirection": 310.0', '"windDirection": 310'),
    "RL017": ('{"min": -10.0, "max": 40.0}', '{"min": -10, "max": 40}'),
}
CORRIDOR = """  "corridors": [
    {
      "name": "crest road",
      "width": 60.0,
      "minHeight": 10.0, "maxHeight": 50.0,
      "points": [
        {"$type": "mission:GeoCoordinate", "latitude": 42.5385, "longitude": 13.394},
        {"$type": "mission:GeoCoordinate", "latitude": 42.5385, "longitude": 13.3945}
      ],
      "robotTypes": ["Camera drone"]
    }
  ],
"""
ADDED |= dict.fromkeys(
    ("CTX018", "CTX019", "CTX027"), ('  "forbiddenAreas"', f'{CORRIDOR}  "forbiddenAreas"')
)
"""What a sound text is made to say first, so that it can be spoilt."""
ELSEWHERE = {"MML072": "shells of tasks are mended as those of areas", "XMI014": "see below"}


@pytest.fixture(scope="module")
def projects(session, tmp_path_factory):
    """Return the folder of the examples in JSON."""
    place = tmp_path_factory.mktemp("examples")
    registry = session.contributions.languages
    for folder in (DAM, PARK, CLOCK, POOL):
        for file in folder.rglob("*.xmi"):
            target = place / file.relative_to(EXAMPLES).with_suffix(".json")
            target.parent.mkdir(parents=True, exist_ok=True)
            model = read_model(file, registry, root=folder)
            target.write_bytes(to_json(model.roots, registry, file=target))
    return place


def texts(name, projects):
    """Return the project, the file, and its text as it ought to be and as it is."""
    folder, relative, right, wrong = SPOILT[name]
    file = (projects / folder.name / relative).resolve()
    sound = file.read_text(encoding="utf-8")
    if name in ADDED:
        assert ADDED[name][0] in sound
        sound = sound.replace(*ADDED[name], 1)
    if name == "BL036":
        wrong = right.replace('"camera', '"kamera')
    if name == "CTX006":
        vertex = next(line for line in sound.splitlines(True) if "42.539058, " in line)
        right, wrong = vertex, vertex * 2
    if name == "CTX007":
        right = next(sound[at : at + 44] for at in [sound.index('"minHeight": 4.0')])
        right = right[: right.index("9.0") + 3]
        wrong = right.replace("4.0", "_").replace("9.0", "4.0").replace("_", "9.0")
    assert right in sound
    project = file if folder == CLOCK else projects / folder.name
    return project, file, sound, sound.replace(right, wrong, 1)


@pytest.mark.parametrize("name", sorted(SPOILT))
def test_a_spoilt_json_text_is_mended_to_what_it_was(mended, projects, name):
    folder, file, sound, spoilt = texts(name, projects)
    repair = mended(folder, {file: spoilt.encode()})
    assert name.split()[0] in {each.fault.code for each in repair.applied}
    if name == "XMI003":
        assert json.loads(repair.texts[file]) == json.loads(sound)
    else:
        assert repair.texts[file].decode() == sound
    assert not repair.refused


def test_every_fix_of_the_core_is_tried_on_json():
    assert {fix.code for fix in FIXES} == {name.split()[0] for name in SPOILT} | set(ELSEWHERE)


def test_what_was_mended_is_not_mended_again(mended, projects):
    folder, file, _, spoilt = texts("XMI004", projects)
    once = mended(folder, {file: spoilt.encode()})
    again = mended(folder, once.texts)
    assert again.applied == ()
    assert again.texts == once.texts


@pytest.mark.parametrize("declared", [True, False])
def test_a_prefix_is_declared_among_the_languages(mended, projects, declared):
    file = (projects / DAM.name / MISSION).resolve()
    sound = file.read_text(encoding="utf-8")
    lacking = sound.replace(', "survey": "urn:mmrs:survey:1.0"', "")
    assert lacking != sound
    if not declared:
        whole = '  "$languages": {"mission": "urn:mmrs:mission:1.0"},\n'
        lacking = lacking.replace(whole, "").replace('"mission:', '"urn:mmrs:mission:1.0#')
    repair = mended(projects / DAM.name, {file: lacking.encode()})
    assert json.loads(repair.texts[file])["$languages"]["survey"] == "urn:mmrs:survey:1.0"
    assert repair.diagnosis.complete
    assert repair.diagnosis.faults == ()


def test_only_what_is_wrong_changes_in_an_unusual_layout(mended, projects):
    file = (projects / DAM.name / MISSION).resolve()
    tight = json.dumps(json.loads(file.read_text(encoding="utf-8")), separators=(",", ":"))
    spoilt = "\ufeff" + tight.replace("photoDistance", "photoDistanse") + "\r\n"
    repair = mended(projects / DAM.name, {file: spoilt.encode()})
    assert repair.texts[file].decode() == spoilt.replace("photoDistanse", "photoDistance")
