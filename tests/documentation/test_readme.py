"""What the README tells to type works, in the order in which it tells it."""

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from code_blocks import environment
from warm_python import programs

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```console\n(.*?)```", README, re.DOTALL)
COMMANDS = [line[2:] for block in BLOCKS for line in block.splitlines() if line.startswith("$ ")]
SET_UP = ["python3 -m venv .venv && .venv/bin/pip install -r requirements-dev.txt", ".venv/bin/mmrs demo"]
INSTALLATION = "python3 -m venv .venv && .venv/bin/pip install --no-compile -r requirements.txt"
TESTS = ".venv/bin/pytest -n 6 --dist loadgroup"


def test_the_first_commands_are_the_whole_set_up():
    assert COMMANDS[:2] == SET_UP
    assert (ROOT / "requirements-dev.txt").is_file()


def test_the_tests_are_one_command():
    assert COMMANDS[2] == TESTS


def test_an_installation_for_use_is_one_command_without_development_tools():
    assert f"```text\n{INSTALLATION}\n```" in README
    folders = re.findall(r"^\./?(\S*)$", (ROOT / "requirements.txt").read_text(), re.MULTILINE)
    editable = re.findall(r"^-e ([^\s[]+)", (ROOT / "requirements-dev.txt").read_text(), re.MULTILINE)
    assert {each or "." for each in folders} == set(editable) - {"plugins/auv-vision"}


def test_every_line_of_a_console_block_is_a_command():
    lines = [line for block in BLOCKS for line in block.splitlines()]
    assert [line for line in lines if not line.startswith("$ ")] == []


def test_every_page_that_the_readme_names_exists():
    links = re.findall(r"\]\((\S+?)\)", README)
    assert links
    assert [link for link in links if not (ROOT / link.partition("#")[0]).exists()] == []


def test_every_command_of_the_readme_works_and_the_demo_leaves_what_is_promised(tmp_path):
    promised = re.findall(r"^\| `(\S+?)` \|", README, re.MULTILINE)
    assert len(promised) == 6
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    for command in [COMMANDS[1], *COMMANDS[3:]]:
        done = subprocess.run(
            shlex.split(command.replace(".venv/bin/", "")),
            cwd=tmp_path,
            env=environment(programs()),
            capture_output=True,
            text=True,
            timeout=240,
        )
        if done.returncode != 0:
            pytest.fail(f"{command}: ends with {done.returncode}\n{done.stdout}\n{done.stderr}")
        assert [name for name in promised if not (tmp_path / "mmrs-demo" / name).exists()] == []
