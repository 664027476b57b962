"""Commands that act on a behaviour refuse the faults of its context and robot types, as validate does."""

import re
import shutil

import pytest
from lxml import etree


def put(file, tag, **attributes):
    tree = etree.parse(file)
    next(tree.iter(tag)).attrib.update(attributes)
    tree.write(file)


@pytest.mark.parametrize(
    "command",
    [
        ["validate"],
        ["check"],
        ["simulate"],
        ["preview"],
        ["generate", "--target", "mavlink-python", "-o", "out"],
        ["run", "--backend", "simulation", "--log", "logs"],
    ],
    ids=lambda command: command[0],
)
def test_a_negative_safety_distance_is_refused(mmrs, project, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    put(project / "context.xmi", "obstacles", safetyDistance="-5")
    code, out, err = mmrs(command[0], project / "behaviour.xmi", *command[1:])
    assert code == 1
    assert "safe\n" not in out
    assert re.search(r"safetyDistance of \S+.* is -5, but must be at least 0 \[CTX005\]", err)
    assert list(tmp_path.iterdir()) == [project]


@pytest.mark.parametrize(
    ("file", "tag", "values", "code"),
    [
        ("context.xmi", "obstacles", {"minHeight": "30", "maxHeight": "0"}, "[CTX007]"),
        ("robots/*.xmi", "size", {"height": "0"}, "[RL006]"),
    ],
)
def test_an_obstacle_upside_down_and_a_robot_type_without_size_are_refused(
    mmrs, project, file, tag, values, code
):
    put(next(project.glob(file)), tag, **values)
    ended, _, err = mmrs("check", project)
    assert (ended, code in err) == (1, True)


def test_two_robot_types_of_one_name_are_refused(mmrs, project):
    file = next((project / "robots").glob("*.xmi"))
    shutil.copy(file, file.with_name("again.xmi"))
    for command in ("validate", "check"):
        code, _, err = mmrs(command, project)
        assert (code, "two robot types have this name" in err) == (1, True)


def test_a_context_is_drawn_in_the_frame_of_the_behaviour(mmrs, project):
    """An area that crosses itself can only be seen where its corners have places."""
    file = project / "context.xmi"
    tree = etree.parse(file)
    corners = tree.findall(".//obstacles/shell")
    for corner in corners[1:]:
        corner.attrib.update(corners[0].attrib)
    tree.write(file)
    code, _, err = mmrs("check", project)
    assert (code, "[CTX" in err) == (1, True)
