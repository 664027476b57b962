"""Generated files, word for word; other tests run them and have peers read them."""

import ast
import json
from dataclasses import replace
from pathlib import Path

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input, two_drones

from mmrs_core.behaviour.program import MoveTarget, Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import feedback, program
from mmrs_mavlink.plugin import mmrs_targets

EXPECTED = Path(__file__).parent / "expected"
BY_NAME = {target.name: target for target in mmrs_targets()}


def choosing():
    """Return a robot that chooses, goes to an object, and holds in a local frame."""
    buoy = replace(
        go_to("seek", (4.0, 6.0, 5.0)), target=MoveTarget((4.0, 6.0, 5.0), "a buoy", 1.5), distance=1.0
    )
    robot = robot_program(
        "Triton 1",
        [take_off("up", 5.0), replace(buoy, after=(feedback("seen"),)), LAND],
        transitions={1: Transition(1, 2, condition="calm", otherwise=3)},
    )
    return program(robot, name="pool", frame=Frame("EPSG:4326", None, None))


def check(path: Path, content: str, update: bool) -> None:
    if update:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, "utf-8")
    assert path.read_text("utf-8") == content


def expected_path(behaviour, path: str) -> Path:
    """Return where the expected file lies; Python gets another ending, so that no tool takes it for ours."""
    return EXPECTED / behaviour.__name__ / (f"{path}.txt" if path.endswith(".py") else path)


def files_of(target: str, behaviour) -> dict[str, str]:
    files = render(BY_NAME[target], target_input(behaviour), allow_lossy=True)
    return {file.path: file.content.decode("utf-8") for file in files if not file.path.endswith(".whl")}


CASES = [
    ("mavlink-python", two_drones, "robot_alpha.py"),
    ("mavlink-python", two_drones, "robot_beta.py"),
    ("mavlink-python", two_drones, "fleet.py"),
    ("mavlink-python", two_drones, "README.md"),
    ("mavlink-python", two_drones, "mmrs@.service"),
    ("mavlink-python", choosing, "robot_Triton_1_a72fbfb3.py"),
    ("mavlink-python", choosing, "fleet.py"),
    ("mavlink-python", choosing, "conditions.py"),
    ("mavlink-python", choosing, "objects.py"),
    ("mavlink-python", choosing, "README.md"),
    ("qgc-plan", two_drones, "alpha.plan"),
    ("qgc-plan", two_drones, "beta.plan"),
    ("wpl", two_drones, "alpha.waypoints"),
    ("wpl", two_drones, "alpha.fence.waypoints"),
    ("wpl", two_drones, "alpha.rally.waypoints"),
    ("wpl", two_drones, "beta.waypoints"),
]


@pytest.mark.parametrize(("target", "behaviour", "path"), CASES)
def test_a_generated_file_is_as_expected(target, behaviour, path, update_golden):
    content = files_of(target, behaviour())[path]
    if path.endswith(".py"):
        ast.parse(content)
    elif path.endswith(".plan"):
        json.loads(content)
    check(expected_path(behaviour, path), content, update_golden)


def test_a_manifest_is_as_expected(update_golden):
    manifest = json.loads(files_of("qgc-plan", two_drones())["qgc-plan.manifest.json"])
    manifest["versions"] = dict.fromkeys(manifest["versions"], "any")
    check(EXPECTED / "two_drones/manifest.json", json.dumps(manifest, indent=2) + "\n", update_golden)


@pytest.mark.parametrize("target", sorted(BY_NAME))
def test_refusals_are_as_expected(target, update_golden):
    lines = []
    for behaviour in (two_drones(), choosing()):
        try:
            render(BY_NAME[target], target_input(behaviour))
        except UnsupportedError as error:
            lines += [str(error), *(f"    {element}" for element in error.elements)]
        else:
            lines.append("renders")
    check(EXPECTED / f"{target}-refusals.txt", "\n".join(lines) + "\n", update_golden)


def test_every_expected_file_is_compared():
    compared = {expected_path(behaviour, path) for _, behaviour, path in CASES}
    compared |= {EXPECTED / f"{target}-refusals.txt" for target in BY_NAME}
    compared.add(EXPECTED / "two_drones/manifest.json")
    assert {path for path in EXPECTED.rglob("*") if path.is_file()} == compared
