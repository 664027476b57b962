"""New plug-ins as their authors meet them: written, installed by pip, tested, and used by every command."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from built_wheels import build, install
from type_checks import mypy
from warm_python import python

pytestmark = pytest.mark.long

KINDS = {"polygon": "class", "line": "import", "point": "while-typing"}
"""A plug-in for each geometry of tasks, by names that are hard on Python."""
WHOLE = "a-very-long-name-of-thirty-chs"
"""A plug-in with every part."""
PARTS = {"robot": "kite-train", "target": "kite-code", "check": "kite-check", "vehicle": "kite-wing"}
"""A plug-in for each part alone."""


def run(*command, cwd, site=None, code=0):
    """Return the standard output of a command that ends with a code."""
    environment = {**os.environ, "PYTHONPATH": str(site)} if site else dict(os.environ)
    done = subprocess.run(
        [str(each) for each in command],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert done.returncode == code, f"{command}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done.stdout


def snake(kind):
    return KINDS[kind].replace("-", "_")


def mmrs(*arguments, cwd, site=None, code=0):
    return run(python(), "-m", "mmrs_core", *arguments, cwd=cwd, site=site, code=code)


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with new plug-ins: one for each geometry, one for each part, and one with all parts."""
    made = tmp_path_factory.mktemp("plugins")
    for kind in KINDS:
        mmrs("plugin", "new", KINDS[kind], "--task", kind, cwd=made)
    for part, name in PARTS.items():
        mmrs("plugin", "new", name, "--with", part, cwd=made)
    mmrs("plugin", "new", WHOLE, "--with", "task,robot,target,check,vehicle", cwd=made)
    return made


@pytest.fixture(scope="module")
def site(place):
    """A folder with all of them installed, beside the installed distributions."""
    others = [place / f"mmrs-{name}" for name in (*KINDS.values(), *PARTS.values())]
    install([place / f"mmrs-{WHOLE}", *build(others, place / "wheels")], made := place / "site")
    return made


def its_tests_pass(name, place, site):
    options = ("-q", "-W", "error", "-p", "no:cacheprovider")
    said = run(python(), "-m", "pytest", *options, cwd=place / f"mmrs-{name}", site=site)
    assert " passed" in said
    assert "skipped" not in said


def test_a_new_plugin_with_every_part_passes_its_tests(place, site):
    its_tests_pass(WHOLE, place, site)


@pytest.mark.thorough
@pytest.mark.parametrize("name", [*KINDS.values(), *PARTS.values()])
def test_new_plugins_of_every_part_pass_their_tests(name, place, site):
    its_tests_pass(name, place, site)


def test_new_plugins_are_listed_with_what_they_contribute(place, site):
    listed = json.loads(mmrs("plugin", "list", "--json", cwd=place, site=site))["plugins"]
    task, robot = {"constraints", "fixes", "rules"}, {"robot_kinds"}
    model, others = {"metamodels", "map_symbols"}, {"checks", "targets", "vehicles"}
    expected = {name: task | model for name in KINDS.values()} | {WHOLE: task | robot | model | others}
    expected |= {PARTS["robot"]: robot | model} | {
        PARTS[part]: {f"{part}s"} for part in PARTS if part != "robot"
    }
    for name, sorts in expected.items():
        assert listed[name][:2] == [f"mmrs-{name}", "0.1.0"]
        assert set(listed[name][2]) == sorts


def test_a_part_that_does_not_exist_is_refused(tmp_path):
    mmrs("plugin", "new", "roof-wash", "--with", "task,engine", cwd=tmp_path, code=2)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", KINDS)
def test_the_example_of_a_new_plugin_is_planned_by_its_rule(kind, place, site):
    folder = place / f"mmrs-{KINDS[kind]}"
    mmrs("plan", "example", "-o", "behaviour.xmi", cwd=folder, site=site)
    assert f'rule="{snake(kind)}"' in (folder / "behaviour.xmi").read_text()


@pytest.mark.parametrize("kind", KINDS)
def test_a_breach_of_the_constraint_is_reported_with_its_code(kind, place, site, tmp_path):
    attribute, bad = {"polygon": ("spacing", "0.0"), "line": ("speed", "0.0"), "point": ("duration", "-1.0")}[
        kind
    ]
    good = {"polygon": "4.0", "line": "0.8", "point": "30.0"}[kind]
    example = place / f"mmrs-{KINDS[kind]}" / "example"
    robots = tmp_path / "robots"
    robots.mkdir()
    (robots / "robot.xmi").write_bytes((example / "robots" / "robot.xmi").read_bytes())
    text = (example / "mission.xmi").read_text()
    (tmp_path / "mission.xmi").write_text(text.replace(f'{attribute}="{good}"', f'{attribute}="{bad}"'))
    found = json.loads(mmrs("validate", tmp_path, "--json", cwd=tmp_path, site=site, code=1))
    assert any(fault["code"] == f"{KINDS[kind][:3].upper()}001" for fault in found["diagnostics"])


def test_all_three_serve_one_mission_together(place, site, tmp_path):
    texts = [(place / f"mmrs-{KINDS[kind]}" / "example" / "mission.xmi").read_text() for kind in KINDS]
    tasks = [text[text.index("  <tasks") : text.index("  <origin")] for text in texts]
    named = [task.replace('name="first"', f'name="{kind}"') for kind, task in zip(KINDS, tasks, strict=True)]
    prefixes = " ".join(f'xmlns:{snake(kind)}="urn:mmrs:{KINDS[kind]}:1.0"' for kind in KINDS)
    whole = texts[0].replace(tasks[0], "".join(named))
    whole = whole.replace('xmlns:class="urn:mmrs:class:1.0"', prefixes)
    (tmp_path / "mission.xmi").write_text(whole)
    (tmp_path / "robots").mkdir()
    rover = place / "mmrs-class" / "example" / "robots" / "robot.xmi"
    (tmp_path / "robots" / "robot.xmi").write_bytes(rover.read_bytes())
    mmrs("plan", ".", cwd=tmp_path, site=site)
    planned = (tmp_path / "behaviour.xmi").read_text()
    assert [kind for kind in KINDS if f'rule="{snake(kind)}"' not in planned] == []


def test_new_plugins_are_formatted_and_typed_as_strictly_as_the_core(place):
    folders = [place / f"mmrs-{name}" for name in (*KINDS.values(), *PARTS.values(), WHOLE)]
    ruff = (sys.executable, "-m", "ruff")
    run(*ruff, "check", "--no-cache", *folders, cwd=place)
    run(*ruff, "format", "--no-cache", "--check", *folders, cwd=place)
    packages = (package for each in folders for package in each.glob("mmrs_*"))
    settings = ("--config-file", folders[-1] / "pyproject.toml")
    found = mypy(*settings, *packages, folders[-1] / "tests", folder=place)
    assert found.returncode == 0, found.stdout


def test_the_readme_of_a_new_plugin_shows_the_task_of_its_example(place):
    for kind in KINDS:
        folder = place / f"mmrs-{KINDS[kind]}"
        readme = (folder / "README.md").read_text()
        task = readme.partition("```xml\n")[2].partition("```")[0]
        lines = [line.strip() for line in task.splitlines()]
        mission = [line.strip() for line in (folder / "example" / "mission.xmi").read_text().splitlines()]
        assert len(lines) > 2
        assert set(lines) <= set(mission)


def test_a_folder_with_something_in_it_stays_as_it_was(tmp_path):
    (tmp_path / "mine").write_text("precious")
    mmrs("plugin", "new", "roof-wash", "-o", tmp_path, cwd=tmp_path, code=1)
    assert [each.name for each in tmp_path.iterdir()] == ["mine"]


@pytest.mark.parametrize(
    "name",
    [
        *("../roof", "survey", "-x"),
        *(
            pytest.param(name, marks=pytest.mark.thorough)
            for name in ("Roof Wash", "core", "photo-grid", "1st", "ab\n", "", "a" * 40)
        ),
    ],
)
def test_a_name_that_will_not_do_is_refused_before_anything_is_written(name, tmp_path):
    mmrs("plugin", "new", "-o", "made", "--", name, cwd=tmp_path, code=2)
    assert list(tmp_path.iterdir()) == []


def test_a_new_plugin_goes_into_an_empty_folder_and_into_new_ones(tmp_path):
    (tmp_path / "empty").mkdir()
    for folder in ("empty", "deep/er/still"):
        mmrs("plugin", "new", "roof-wash", "-o", folder, cwd=tmp_path)
        assert (tmp_path / Path(folder) / "pyproject.toml").is_file()


def test_commands_that_come_next_can_be_pasted_for_folders_of_any_name(tmp_path):
    said = mmrs("plugin", "new", "roof-wash", "-o", "my $roof", cwd=tmp_path)
    assert "  cd 'my $roof'\n" in said
