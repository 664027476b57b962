"""The commands as processes: what shells and pipes see, and what they cost."""

import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

from mmrs_core.resources import shipped

PROGRAMS = Path(sys.executable).parent
MOST_RUNS = 12


def call(*arguments, **options):
    command = [str(PROGRAMS / arguments[0]), *map(str, arguments[1:])]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, **options)


def cpu_seconds(*arguments):
    """Return the processor time of a command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert call(*arguments).returncode == 0
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def costs(*arguments, at_most):
    """Return whether a command takes at most a multiple of the processor time of importing geometry.

    That takes a third of a second on the machine of the gate; busy neighbours make both slower, now the
    one and now the other, so that the least of several runs counts, and as many runs as it takes.
    """
    imports = ("python", "-c", "import numpy, pyproj, shapely")
    least = unit = float("inf")
    for _ in range(MOST_RUNS):
        least, unit = min(least, cpu_seconds(*arguments)), min(unit, cpu_seconds(*imports))
        if least <= at_most * unit:
            return True
    return False


def test_help_costs_less_than_a_quarter_of_a_second():
    assert costs("mmrs", "--help", at_most=0.75)


@pytest.mark.parametrize(
    "example", [pytest.param("carbon-dioxide", marks=pytest.mark.thorough), "mixed-team"]
)
def test_validating_an_example_costs_less_than_a_second_and_a_quarter(example):
    assert costs("mmrs", "validate", shipped("examples") / example, at_most=3.5)


def test_help_imports_nothing_heavy():
    heavy = ("numpy", "shapely", "pyproj", "pyecore", "jinja2", "pymavlink", "rich", "matplotlib")
    heavy += ("mmrs_core.scene", "mmrs_core.languages.registry", "mmrs_core.cli.bus")
    code = (
        "import sys; from mmrs_core.cli import run; run(['--help']);"
        f"print([m for m in {heavy!r} if m in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stderr == "[]\n"


HELP_OF_EVERY_COMMAND = """
import io, re, sys
from contextlib import redirect_stdout
from mmrs_core.cli import run

def printed(*arguments):
    with redirect_stdout(io.StringIO()) as out:
        run([*arguments, "--help"])
    return out.getvalue()

names = re.findall(r"(?m)^  ([a-z]+)  ", printed().partition("Commands:")[2])
for name in names:
    assert f"mmrs {name}" in printed(name)
print(len(names), [each for each in sys.argv[1:] if each in sys.modules])
"""


def test_help_of_every_command_imports_nothing_that_only_running_it_needs():
    heavy = ("numpy", "shapely", "pyproj", "pyecore", "pymavlink", "zenoh", "cv2", "cantools")
    done = call("python", "-c", HELP_OF_EVERY_COMMAND, *heavy)
    number, _, imported = done.stdout.partition(" ")
    assert int(number) > 20, done.stderr
    assert imported == "[]\n"


def test_validating_imports_nothing_that_other_commands_need():
    others = ("pydantic", "jinja2", "rich", "mmrs_core.analysis.checks", "mmrs_core.behaviour.program")
    others += ("mmrs_core.scene.plans", "mmrs_core.planning.coverage", "mmrs_core.languages.json_form.reader")
    code = (
        "import sys; from mmrs_core.cli import run; run(['validate', sys.argv[1]]);"
        f"print([m for m in {others!r} if m in sys.modules])"
    )
    command = [sys.executable, "-c", code, shipped("examples") / "mixed-team"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines()[-1] == "[]"


def test_python_dash_m_is_mmrs():
    done = subprocess.run(
        [sys.executable, "-m", "mmrs_core", "--version"], capture_output=True, text=True, timeout=60
    )
    assert done.stdout.startswith("mmrs ")


def test_a_pipe_that_closes_early_is_quiet():
    command = (
        f"'{PROGRAMS / 'mmrs'}' show '{shipped('examples') / 'carbon-dioxide' / 'mission.xmi'}' | head -n 1"
    )
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60)
    assert done.stdout.startswith("Mission ")
    assert done.stderr == ""


def test_standard_output_holds_one_object_with_json():
    done = call("mmrs", "check", shipped("examples") / "handwritten", "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["safe"] is True


def test_output_works_where_the_terminal_knows_only_ascii():
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0", "LC_ALL": "C"}
    done = call("mmrs", "show", shipped("examples") / "pool" / "mission.xmi", env=environment)
    assert done.returncode == 0
    assert done.stdout.isascii()
