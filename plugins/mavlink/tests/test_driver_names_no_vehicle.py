"""The driver goes by vehicle profiles alone: it compares with no name of a vehicle or an autopilot."""

import ast
from pathlib import Path

import mmrs_mavlink
from mmrs_mavlink.profiles import PROFILES

ROOT = Path(mmrs_mavlink.__file__).parent
PARTS = (
    "driver.py",
    "linked.py",
    "options.py",
    "program.py",
    "driving",
    "links",
    "records",
    "services",
    "steps",
)
SOURCES = [
    source
    for part in (*PARTS, "vehicles")
    for source in ([ROOT / part] if part.endswith(".py") else sorted((ROOT / part).rglob("*.py")))
]
NAMES = {
    *(name for each in PROFILES.values() for name in (each.name, each.vehicle, each.autopilot.name)),
    *(f"MAV_AUTOPILOT_{name}" for name in ("ARDUPILOTMEGA", "PX4")),
    *(each.autopilot.title for each in PROFILES.values()),
}
OF_ONE = {"ardupilot", "px4"}
GUIDANCE = {"vehicles/px4.py"}
"""What is imported by the profile of one autopilot, and so may know it."""


def names_in(source: Path):
    """Yield each name of a vehicle or an autopilot in the code of a module, with its line."""
    for node in ast.walk(ast.parse(source.read_text("utf-8"))):
        said = getattr(node, "value", None) if isinstance(node, ast.Constant) else getattr(node, "attr", None)
        if isinstance(said, str) and said in NAMES:
            yield node.lineno, said
        if isinstance(node, ast.ImportFrom) and OF_ONE & set((node.module or "").split(".")):
            yield node.lineno, node.module


def test_no_module_of_the_driver_names_a_vehicle():
    paths = {source.relative_to(ROOT).as_posix(): source for source in SOURCES}
    found = {path: names for path, source in paths.items() if (names := list(names_in(source)))}
    assert found.keys() <= GUIDANCE, found


def test_a_name_is_found(tmp_path):
    (tmp_path / "a.py").write_text(
        'if kind == "copter" or number == mavlink.MAV_AUTOPILOT_PX4:\n    pass\n', "utf-8"
    )
    assert [name for _, name in names_in(tmp_path / "a.py")] == ["copter", "MAV_AUTOPILOT_PX4"]
