"""The core names no robot, and nothing that a plug-in brings: these come by hooks."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CORE = ROOT / "mmrs_core"

ROBOTS = re.compile(r"copter|drone|rover|submarine|px4", re.IGNORECASE)
OF_PLUGINS = re.compile(
    r"mmrs[_-](?:auv|dronecan|flyaq|imc|mavlink|moos|multicopter|rover|solar|survey)\b|auv_vessel|mmrs_codecs"
    r"|urn:mmrs:(?:auv|multicopter|rover|solar|survey)|positionHold|[Tt]hruster"
)
EXAMPLES = re.compile(
    r"Example: mmrs |e\.g\. Drone1|name=Drone1|mmrs_solar/metamodels|\"drone\", \"stone\"|'drone'\)"
)
"""Examples in help texts and documentation, which may name anything."""

BY_HAND = (
    "generation/capabilities/",
    "testing/programs.py",
    "testing/small_programs.py",
    "testing/conformance/targets.py",
)
"""Behaviours made by hand, with which targets are tried: they fly, drive and dive."""


def text_files() -> list[Path]:
    found = (path for path in CORE.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return sorted(path for path in found if path.suffix not in (".png", ".woff2"))


@pytest.mark.parametrize("pattern", [ROBOTS, OF_PLUGINS], ids=["robots", "plug-ins"])
def test_the_core_names_no_robot_and_nothing_of_a_plug_in(pattern):
    named = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in text_files()
        if not path.relative_to(CORE).as_posix().startswith(BY_HAND)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if pattern.search(line) and not EXAMPLES.search(line)
    ]
    assert named == []


@pytest.mark.parametrize("name", BY_HAND)
def test_every_exception_is_needed(name):
    paths = [path for path in text_files() if path.relative_to(CORE).as_posix().startswith(name)]
    assert any(ROBOTS.search(path.read_text(encoding="utf-8")) for path in paths)
