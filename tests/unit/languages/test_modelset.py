import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.modelset import project_files, read_project

MISSION = '<m:Mission xmlns:m="urn:mmrs:mission:1.0" name="m"/>'
CONTEXT = '<c:Context xmlns:c="urn:mmrs:context:1.0" name="c"/>'


def robot(name):
    return f'<r:Robot xmlns:r="urn:mmrs:robot:1.0" name="{name}"/>'


@pytest.fixture
def project(tmp_path):
    (tmp_path / "robots").mkdir()
    (tmp_path / "mission.xmi").write_text(MISSION)
    (tmp_path / "context.xmi").write_text(CONTEXT)
    (tmp_path / "robots" / "b.xmi").write_text(robot("bee"))
    (tmp_path / "robots" / "a.xmi").write_text(robot("ant"))
    return tmp_path


def test_a_folder_stands_for_its_files(project, core):
    found, faults = read_project(project, registry=core)
    assert faults == ()
    assert (found.mission.name, found.context.name) == ("m", "c")
    assert list(found.robots) == ["ant", "bee"]
    assert len(found.models) == 4


def test_a_mission_file_stands_for_its_folder(project, core):
    found, _ = read_project(project / "mission.xmi", registry=core)
    assert found.context.name == "c"


def test_given_files_go_before_those_of_the_folder(project, core, tmp_path):
    other = tmp_path / "other.xmi"
    other.write_text(CONTEXT.replace('name="c"', 'name="other"'))
    robots = [project / "robots" / "b.xmi"]
    found, _ = read_project(project, context=other, robots=robots, registry=core)
    assert found.context.name == "other"
    assert list(found.robots) == ["bee"]


def test_a_project_needs_no_context(project, core):
    (project / "context.xmi").unlink()
    found, faults = read_project(project, registry=core)
    assert found.context is None
    assert faults == ()


def test_a_folder_without_a_mission_is_unreadable(tmp_path):
    with pytest.raises(UnreadableError, match=r"no mission\.xmi in this folder"):
        project_files(tmp_path)


def test_two_types_of_one_name_are_a_fault(project, core):
    (project / "robots" / "b.xmi").write_text(robot("ant"))
    found, faults = read_project(project, registry=core)
    assert [fault.code for fault in faults] == ["PRJ001"]
    assert "the first is at" in faults[0].message
    assert list(found.robots) == ["ant"]


def test_several_types_in_one_file_are_fine(project, core):
    text = robot("x") + robot("y")
    (project / "robots" / "a.xmi").write_text(f'<x:XMI xmlns:x="http://www.omg.org/XMI">{text}</x:XMI>')
    found, faults = read_project(project, registry=core)
    assert faults == ()
    assert list(found.robots) == ["x", "y", "bee"]


@pytest.mark.parametrize("file", ["mission.xmi", "context.xmi", "robots/a.xmi"])
def test_a_file_with_the_wrong_root_is_a_fault(project, core, file):
    (project / file).write_text('<b:Behaviour xmlns:b="urn:mmrs:behaviour:1.0"/>')
    found, faults = read_project(project, registry=core)
    assert [fault.code for fault in faults] == ["PRJ002"]
    assert faults[0].place.file.endswith(file)
    assert (found is None) == (file == "mission.xmi")


def test_faults_of_all_files_are_reported(project, core):
    (project / "mission.xmi").write_text(MISSION.replace("name", "nmae"))
    (project / "context.xmi").write_text(CONTEXT.replace("name", "nmae"))
    _, faults = read_project(project, registry=core)
    assert [fault.place.file.rpartition("/")[2] for fault in faults] == ["mission.xmi", "context.xmi"]


def test_files_of_a_project_share_their_elements(project, core):
    (project / "mission.xmi").write_text(
        '<m:Mission xmlns:m="urn:mmrs:mission:1.0"><origin '
        'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        'xsi:type="m:RelativeCoordinate" x="1.0" y="2.0">'
        '<reference xsi:type="m:GeoCoordinate" href="context.xmi#//@origin"/></origin></m:Mission>'
    )
    (project / "context.xmi").write_text(
        CONTEXT.replace(
            "/>",
            ' xmlns:m="urn:mmrs:mission:1.0">'
            '<origin xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:type="m:GeoCoordinate" '
            'latitude="1.0" longitude="2.0"/></c:Context>',
        )
    )
    found, faults = read_project(project, registry=core)
    assert faults == ()
    assert found.mission.origin.reference is found.context.origin
