"""The core names no robot, and nothing that a plug-in brings: these come by hooks."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("mmrs_core", "codegen_templates", "metamodels")
CORE = ("mmrs-core", "mmrs-runtime", "mmrs-studio")
"""Distributions that are no plug-ins."""

EXAMPLES = {
    "mmrs_core/analysis/fixes/spelling.py": ('"drone", "stone"', "'drone')"),
    "mmrs_core/cli/bus.py": ("--robot Drone1", "--robot Drone2", "keys Drone1", "--robot Auv1"),
    "mmrs_core/cli/control.py": ("hold Drone1",),
    "mmrs_core/cli/generate.py": ("--target mavlink-python",),
    "mmrs_core/cli/live.py": ("Drone1:cut", "Drone1=udpin"),
    "mmrs_core/cli/metamodel.py": ("mmrs_solar/metamodels/solar.ecore -o mmrs_solar",),
    "mmrs_core/languages/query/path.py": ("name=Drone1",),
}
"""Examples in help texts and documentation, which may name anything: by file, what is allowed there."""


def plugin_words() -> Iterator[str]:
    """Yield the names of each plug-in's distribution and packages, and the nsURIs of its languages."""
    for project in sorted(ROOT.glob("plugins/*/pyproject.toml")):
        name = tomllib.loads(project.read_text(encoding="utf-8"))["project"]["name"]
        yield re.escape(name).replace(r"\-", "[-_]")
    for ecore in sorted(ROOT.glob("plugins/*/*/metamodels/*.ecore")):
        found = re.search(r'nsURI="([^"]+)"', ecore.read_text(encoding="utf-8"))
        assert found is not None, ecore
        yield re.escape(found[1].rpartition(":")[0]) + ":"


ROBOTS = r"copter|drone|rover|submarine|px4|auv|vessel|underwater vehicle"
OF_PLUGINS = r"mavlink|ardupilot|ardusub|thruster|positionHold|trajectory\b|mmrs_codecs"
NAMES = re.compile("|".join((ROBOTS, OF_PLUGINS, *plugin_words())), re.IGNORECASE)


def text_files() -> list[Path]:
    found = (path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.is_file())
    return sorted(
        path for path in found if "__pycache__" not in path.parts and path.suffix not in (".png", ".woff2")
    )


def named_in(path: Path, examples: tuple[str, ...]) -> Iterator[str]:
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        rest = line
        for example in examples:
            rest = rest.replace(example, "")
        if found := NAMES.search(rest):
            yield f"{path.relative_to(ROOT)}:{number}: {found[0]}: {line.strip()}"


def test_the_core_names_no_robot_and_nothing_of_a_plug_in():
    files = text_files()
    assert len(files) > 300
    named = [
        each for path in files for each in named_in(path, EXAMPLES.get(path.relative_to(ROOT).as_posix(), ()))
    ]
    assert named == []


@pytest.mark.parametrize(
    "word",
    [
        "ArduCopter",
        "drones",
        "PX4",
        "MAVLink",
        "Thruster",
        "mmrs_solar",
        "mmrs-auv",
        "auv_vision",
        "urn:mmrs:survey:1.0",
    ],
)
def test_the_words_of_plug_ins_are_found(word):
    assert NAMES.search(f"the {word} is")


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_exception_is_needed(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    assert [example for example in EXAMPLES[name] if example not in text] == []
    assert list(named_in(ROOT / name, ()))
