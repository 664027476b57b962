import json
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import target_input, two_drones

from mmrs_core.contributions.targets import FileSpec, Target, TracedStep
from mmrs_core.errors import InternalError, UnsupportedError
from mmrs_core.generation.render import render


@pytest.fixture
def target(tmp_path):
    (tmp_path / "hello.jinja").write_text("hello {{ who | py }}\n", "utf-8")
    (tmp_path / "bare.jinja").write_text("hello {{ who }}\n", "utf-8")
    (tmp_path / "joined.jinja").write_text("{{ [who | py, who] | join }}\n", "utf-8")
    (tmp_path / "undefined.jinja").write_text("{{ nobody | py }}\n", "utf-8")
    (tmp_path / "copied.txt").write_text("{{ as it is }}", "utf-8")
    return Target(
        "greeting",
        "says hello",
        tmp_path,
        lambda given: [FileSpec("hello.txt", "hello.jinja", {"who": given.program.name})],
        lambda given: [],
        {"shout": lambda value: str(value).upper()},
    )


def with_file(target: Target, path: str, template: str) -> Target:
    return replace(target, files=lambda given: [FileSpec(path, template, {"who": "x"})])


def test_a_template_is_rendered_with_its_view(target):
    files = render(target, target_input(two_drones()))
    assert (files[0].path, files[0].content) == ("hello.txt", b'hello "survey"\n')


def test_a_template_that_was_changed_is_rendered_as_it_is_now(target):
    render(target, target_input(two_drones()))
    (target.templates / "hello.jinja").write_text("good evening {{ who | py }}\n", "utf-8")
    assert render(target, target_input(two_drones()))[0].content == b'good evening "survey"\n'


def test_targets_with_the_same_templates_have_their_own_filters(target):
    (target.templates / "loud.jinja").write_text("{{ 'hey' | shout }}\n", "utf-8")
    loud = with_file(target, "a.txt", "loud.jinja")
    quiet = replace(loud, filters={"shout": lambda value: str(value).lower()})
    made = [render(each, target_input(two_drones()))[0].content for each in (loud, quiet, loud)]
    assert made == [b"HEY\n", b"hey\n", b"HEY\n"]


def test_a_template_without_the_ending_is_copied(target):
    files = render(with_file(target, "a.txt", "copied.txt"), target_input(two_drones()))
    assert files[0].content == b"{{ as it is }}"


def test_a_file_that_is_no_text_is_written_as_it_is(target):
    binary = replace(target, files=lambda given: [FileSpec("a.bin", "", data=b"\xff\x00{{ who }}")])
    assert render(binary, target_input(two_drones()))[0].content == b"\xff\x00{{ who }}"


@pytest.mark.parametrize("template", ["bare.jinja", "joined.jinja"])
def test_a_value_without_a_filter_is_an_error(target, template):
    with pytest.raises(InternalError, match="without a filter"):
        render(with_file(target, "a.txt", template), target_input(two_drones()))


def test_an_undefined_name_is_an_error(target):
    with pytest.raises(InternalError, match="nobody"):
        render(with_file(target, "a.txt", "undefined.jinja"), target_input(two_drones()))


def test_a_filter_of_the_target_encodes(target, tmp_path):
    (tmp_path / "loud.jinja").write_text("{{ who | shout }}", "utf-8")
    files = render(with_file(target, "a.txt", "loud.jinja"), target_input(two_drones()))
    assert files[0].content == b"X"


@pytest.mark.parametrize("path", ["../a", "/a", "a/../../b", "a\\b", "\u00e4"])
def test_a_path_that_leaves_the_folder_is_an_error(target, path):
    with pytest.raises(InternalError, match="leaves the folder"):
        render(with_file(target, path, "copied.txt"), target_input(two_drones()))


def test_two_files_of_one_path_are_an_error_even_where_case_differs(target):
    twice = replace(target, files=lambda g: [FileSpec("a", "copied.txt"), FileSpec("A", "copied.txt")])
    with pytest.raises(InternalError, match="written twice"):
        render(twice, target_input(two_drones()))


def test_refusals_are_all_listed(target):
    refusing = replace(target, refusals=lambda given: ["robot 'a': flies", "robot 'b': sings"])
    with pytest.raises(UnsupportedError, match="2 things") as error:
        render(refusing, target_input(two_drones()))
    assert error.value.elements == ("robot 'a': flies", "robot 'b': sings")


def test_losses_that_are_allowed_are_in_the_manifest(target):
    refusing = replace(target, refusals=lambda given: ["robot 'a': flies"])
    files = render(refusing, target_input(two_drones()), allow_lossy=True)
    assert json.loads(files[-1].content)["losses"] == ["robot 'a': flies"]


def test_the_manifest_lists_hashes_versions_and_what_serves_what(target):
    step = TracedStep("line 1", "alpha", "a1", "photos", "by_hand")
    traced = replace(target, files=lambda given: [FileSpec("a.txt", "copied.txt", trace=(step,), once=True)])
    manifest = json.loads(render(traced, target_input(two_drones()), provider="jinja2")[-1].content)
    assert manifest["files"][0]["path"] == "a.txt"
    assert len(manifest["files"][0]["sha256"]) == 64
    assert manifest["files"][0]["once"] is True
    assert set(manifest["versions"]) == {"mmrs-core", "jinja2"}
    assert manifest["trace"] == [
        {
            "file": "a.txt",
            "step": "line 1",
            "robot": "alpha",
            "move": "a1",
            "task": "photos",
            "rule": "by_hand",
            "lines": None,
            "then": ["a2"],
        }
    ]


def test_same_input_gives_the_same_bytes(target):
    given = target_input(two_drones())
    assert render(target, given) == render(target, given)
