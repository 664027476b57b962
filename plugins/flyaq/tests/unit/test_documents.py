"""Files are recognised for what they are."""

import pytest
from mmrs_flyaq.sources.documents import open_document

from mmrs_core.errors import UnreadableError
from mmrs_core.resources import shipped


@pytest.fixture
def what(mapping):
    return lambda file: open_document(file, mapping.documents).what


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("palette.json", "a palette of the 2015 editor: nothing to migrate"),
        ("extensions.json", "a list of task extensions of the 2015 server: nothing to migrate"),
        ("drones.json", "a list of robot types"),
        ("round.xmi", "a model"),
        ("round.json", "a model"),
        ("workspace/drone.ecore", "a metamodel, http://www.flyaq.it/drone: nothing to migrate"),
    ],
)
def test_files_are_called_what_they_are(what, flyaq, name, words):
    assert what(flyaq / name) == words


def test_a_mission_of_mmrs_needs_no_migration(what):
    mission = shipped("examples") / "pool" / "mission.xmi"
    assert what(mission) == "already a model of MMRS: nothing to migrate"


def test_every_robot_type_of_a_list_is_a_model_of_its_own(migrated, flyaq):
    paths = [str(output.path) for output in migrated(flyaq / "drones.json").outputs]
    assert paths == ["robots/Wren.xmi", "robots/Heron.xmi"]


@pytest.mark.parametrize("text", ["3", '"x"', "null", " true"])
def test_json_that_is_no_model_is_told_so(what, written, text):
    with pytest.raises(UnreadableError, match=r"x\.json:1: its root is neither an object"):
        what(written("x.json", text))


def test_what_is_neither_xml_nor_json_is_told_so(what, written):
    with pytest.raises(UnreadableError, match=r"README\.txt:1: neither XML nor JSON"):
        what(written("README.txt", "How to fly\n"))


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_files_in_any_unicode_encoding_are_recognised(what, flyaq, tmp_path, encoding):
    for name in ("round.json", "Heron.xmi"):
        text = (flyaq / name).read_text().replace("UTF-8", encoding.upper().removesuffix("-SIG"))
        (tmp_path / name).write_bytes(text.encode(encoding))
        assert what(tmp_path / name) == "a model"


@pytest.mark.parametrize("text", ["", "hello", '{"a": 1}', "[1, 2]", "[]", "{", "<a>"])
def test_what_is_no_model_is_refused_by_its_name(what, written, text):
    with pytest.raises(UnreadableError, match=r"x\.txt"):
        what(written("x.txt", text))


def test_a_file_that_cannot_be_read_does_not_keep_others_from_being_migrated(migrated, flyaq, written):
    found = migrated(written("x.json", "{"), flyaq / "Heron.xmi")
    assert "x.json" in found.sources[0].fault
    assert [str(output.path) for output in found.outputs] == ["robots/Heron.xmi"]
