"""Faults put into the code by hand, and whether the tests find each.

Run in the root of a checkout, with names to try only those::

    .venv/bin/python benchmarks/mutants.py planner engine-patience

It works on a copy in a temporary folder, which is what the tests import. It prints a line for each fault, and
exits with 1 if tests pass with one of them, or if the code that one is to replace is no longer there.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLANNING = ("tests/unit/planning", "tests/property/planning")
ANALYSIS = ("tests/unit/analysis", "tests/property/analysis")
ENGINE = (
    "tests/unit/simulation",
    "tests/unit/mmrs_runtime",
    "tests/property/simulation",
    "tests/property/bus",
)
READER = ("tests/unit/languages", "tests/property/languages")
VESSEL = tuple(
    f"plugins/auv-vessel/tests/{each}" for each in ("control", "movement", "body", "wire", "test_guard.py")
)


@dataclass(frozen=True, slots=True)
class Mutant:
    """A fault: `old` becomes `new`, once, in `file`, and some test below `tests` must fail."""

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]


def _mutants(
    area: str, folder: str, tests: tuple[str, ...], *faults: tuple[str, str, str, str]
) -> list[Mutant]:
    return [Mutant(f"{area}-{name}", f"{folder}/{file}", old, new, tests) for name, file, old, new in faults]


MUTANTS = (
    *_mutants(
        "planner",
        "mmrs_core/planning",
        PLANNING,
        ("waits-for-all", "schedule.py", "time = max((end for end, _", "time = min((end for end, _"),
        (
            "signals-alike",
            "schedule.py",
            'return f"{job!r}{_ENDED_BY}{robot!r}"',
            'return f"{job}{_ENDED_BY}{robot}"',
        ),
        ("error-once", "separation.py", "2.0 * scene.position_error", "scene.position_error"),
        ("limits", "levels.py", "max(max(side) for side in _lower", "min(max(side) for side in _lower"),
        ("reach", "levels.py", "(left - width / 2, right - width / 2)", "(left - width, right - width)"),
        ("spots", "lines.py", "begin + (i + 0.5) * (end - begin)", "begin + i * (end - begin)"),
    ),
    *_mutants(
        "checks",
        "mmrs_core/analysis",
        ANALYSIS,
        ("error-once", "separation.py", "least + 2.0 * input.program", "least + 1.0 * input.program"),
        ("idle-ignored", "separation.py", "if input.program.idle:", "if False:"),
        ("excused-anywhere", "separation.py", "if not column.contains(occupation.points):", "if False:"),
        ("charger", "endurance.py", "CHARGER_REACH = 1.0", "CHARGER_REACH = 1000.0"),
        ("emergency", "clearance.py", "area.use is not AreaUse.EMERGENCY and ", ""),
        ("reserve", "endurance.py", "lifetime * (1.0 - input.program.reserve)", "lifetime"),
        (
            "one-battery",
            "endurance.py",
            "_long_enough(robot, index, max(known))",
            "_long_enough(robot, index, min(known))",
        ),
    ),
    *_mutants(
        "engine",
        "runtime/mmrs_runtime/engine",
        ENGINE,
        ("patience", "waits.py", "if end <= now), None)", "if end < now - 1.0), None)"),
        ("held-counts", "waits.py", "self.since + seconds", "self.since"),
        ("peers", "waits.py", "if gone | away != setters:", "if True:"),
        ("taken-over", "responses.py", "if found.which == TAKEN_OVER:", "if False:"),
        (
            "time-of-slots",
            "life.py",
            "self._slots.state(slot).lamport + 1 for",
            "self._slots.state(slot).lamport for",
        ),
        (
            "condition-fault",
            "decisions.py",
            "except FAILURES as error:",
            "except ZeroDivisionError as error:",
        ),
    ),
    *_mutants(
        "reader",
        "mmrs_core/languages",
        READER,
        (
            "one-target",
            "references/resolution.py",
            "not in (None, target):",
            "not in (None, target, raw(element, feature)):",
        ),
        ("fragments", "references/addresses.py", "range(len(value))", "range(1, len(value) + 1)"),
        ("wrong-type", "references/resolution.py", "elif not feature.type.accepts(target):", "elif False:"),
        ("other-end", "references/resolution.py", "            values.put(element)\n", "            pass\n"),
        (
            "nil",
            "xmi/reader.py",
            'self._nil = _value(attributes, _NIL) in ("true", "1")',
            "self._nil = False",
        ),
    ),
    *_mutants(
        "pictures",
        "mmrs_core/pictures/preview",
        ("tests/unit/pictures/preview",),
        (
            "unknown-clearance",
            "features.py",
            "for clearance in clearances.values() if clearance is not None]",
            "or 0.0 for clearance in clearances.values()]",
        ),
        ("unmarked-gap", "from_models.py", "return short if drawn else", "return"),
        ("unlisted-gap", "from_models.py", "if short or not drawn:", "if short:"),
        ("closed-over-a-gap", "from_models.py", "lines = pieces if", "lines = () if"),
        ("late-error", "from_models.py", "errors_first[:MOST]", "errors_first[-MOST:]"),
    ),
    *_mutants(
        "vessel",
        "plugins/auv-vessel/auv_vessel",
        VESSEL,
        ("check-sum", "wire/load.py", "bool(crc & 0x4000)", "bool(crc & 0x2000)"),
        ("leak", "control/failsafe.py", "LEAK_SAID = 2", "LEAK_SAID = 20"),
        ("deepest", "control/failsafe.py", "1.02 * max_depth + 0.5", "1.2 * max_depth + 5.0"),
        (
            "frozen",
            "control/plausibility.py",
            "            return self.frozen\n",
            "            return False\n",
        ),
        ("held", "control/allocation.py", " - hessian[np.ix_(free, held)] @ x[held]", ""),
        ("stuffing", "wire/load.py", "count, run = count + 1, 1", "count, run = count + 1, 0"),
        (
            "two-senders",
            "guard.py",
            "self._reported, self._due = True, now",
            "self._reported, self._due = False, now",
        ),
    ),
)


def chosen(names: Sequence[str]) -> list[Mutant]:
    """Return the faults whose names begin with one of these; all if there are none."""
    return [each for each in MUTANTS if not names or any(each.name.startswith(name) for name in names)]


def copied(folder: Path) -> None:
    """Copy what git knows of the checkout."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.split("\0"):
        if name and (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


def roots_of(folder: Path) -> Iterator[Path]:
    """Yield the folders of a copy that hold packages."""
    yield folder
    yield folder / "runtime"
    yield from sorted(each for each in (folder / "plugins").iterdir() if each.is_dir())


def passes(folder: Path, tests: Sequence[str]) -> bool:
    """Return whether the tests of a copy pass; whatever ends them otherwise finds the fault, too."""
    env = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(map(str, roots_of(folder))),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    there = [each for each in tests if (folder / each).exists()]
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-x",
        "-n",
        "2",
        "--dist",
        "loadgroup",
        "-p",
        "no:cacheprovider",
    ]
    ended = subprocess.run([*command, *there], cwd=folder, env=env, capture_output=True, text=True)
    if ended.returncode not in (0, 1, 2):  # 2: xdist calls a first failure an interrupt
        raise SystemExit(ended.stdout + ended.stderr)
    return ended.returncode == 0


def survives(mutant: Mutant, folder: Path) -> bool:
    """Return whether a fault is put into a copy without a test that fails; mend the copy."""
    file = folder / mutant.file
    text = file.read_text()
    if text.count(mutant.old) != 1:
        raise SystemExit(
            f"{mutant.name}: stands {text.count(mutant.old)} times in {mutant.file}: {mutant.old}"
        )
    try:
        file.write_text(text.replace(mutant.old, mutant.new))
        return passes(folder, mutant.tests)
    finally:
        file.write_text(text)


def main(names: Sequence[str]) -> int:
    """Try the faults of these names; return how many no test finds."""
    alive = 0
    with tempfile.TemporaryDirectory() as folder:
        copied(Path(folder))
        for tests in dict.fromkeys(each.tests for each in chosen(names)):
            if not passes(Path(folder), tests):
                raise SystemExit(f"without a fault, tests fail: {' '.join(tests)}")
        for mutant in chosen(names):
            survived = survives(mutant, Path(folder))
            alive += survived
            print(f"{'SURVIVES' if survived else 'killed  '}  {mutant.name}", flush=True)
    return alive


if __name__ == "__main__":
    sys.exit(1 if main(sys.argv[1:]) else 0)
