"""The tutorial leads where it says: its files are written and its commands run, in its order."""

import re
import subprocess
import sys
import sysconfig
import venv
from itertools import pairwise
from pathlib import Path

import pytest
import same_examples
import warm_python
from code_blocks import Reader, blocks_of, environment
from type_checks import mypy

pytestmark = [pytest.mark.long, pytest.mark.timeout(600)]
TUTORIAL = Path(__file__).parents[2] / "docs" / "tutorial"
PAGES = sorted(TUTORIAL.glob("[0-9]-*.md"))
PICTURE = re.compile(r"<!-- picture: (?P<made>\S+) is (?P<shown>\S+) -->")
PROGRAMS = {
    "pip": "from pip._internal.cli.main import main",
    "pytest": f"sys.path.append({str(Path(same_examples.__file__).parent)!r})\n"
    "sys.argv[1:1] = ['-p', 'same_examples']\nfrom pytest import main",
}
COMMAND = """import site, sys
site.addsitedir({packages!r})
from mmrs_core.cli import main
sys.exit(main())
"""
OFFLINE = {
    "PIP_NO_DEPS": "1",
    "PIP_NO_INDEX": "1",
    "PIP_NO_BUILD_ISOLATION": "0",
    "PIP_NO_WARN_SCRIPT_LOCATION": "1",
}


@pytest.fixture(scope="module")
def terminal(tmp_path_factory):
    """The variables of a virtual environment in which everything is installed that is here."""
    home = tmp_path_factory.mktemp("environment")
    venv.create(home, with_pip=False)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(home)}))
    here = sysconfig.get_path("purelib")
    (packages / "here.pth").write_text(f"import site; site.addsitedir({here!r})\n", encoding="utf-8")
    for name, entry in PROGRAMS.items():
        script = home / "bin" / name
        script.write_text(f"#!{home}/bin/python\nimport sys\n{entry}\nsys.exit(main())\n", encoding="utf-8")
        script.chmod(0o755)
    (home / "mmrs.py").write_text(COMMAND.format(packages=str(packages)), encoding="utf-8")
    script = home / "bin" / "mmrs"
    script.write_text(f'#!/bin/sh\nexec {warm_python.python()} {home}/mmrs.py "$@"\n', encoding="utf-8")
    script.chmod(0o755)
    return environment(home / "bin") | OFFLINE


@pytest.fixture(scope="module")
def followed(tmp_path_factory, terminal):
    """The folder in which a reader is who has done what all pages say, and seen what they show."""
    reader = Reader(tmp_path_factory.mktemp("tutorial"), terminal)
    for page in PAGES:
        for block in blocks_of(page.read_text(encoding="utf-8"), page.name):
            reader.follow(block)
    return reader.folder


def test_readers_see_the_pictures_of_the_pages(followed, update_golden):
    for page in PAGES:
        for picture in PICTURE.finditer(page.read_text(encoding="utf-8")):
            made, shown = followed / picture["made"], page.parent / picture["shown"]
            if update_golden:
                shown.write_bytes(made.read_bytes())
            assert made.read_bytes() == shown.read_bytes(), f"{page.name}: {shown.name}"


@pytest.mark.parametrize(
    "tool",
    [
        ("ruff", "check", "--no-cache", "mmrs_panels", "tests"),
        ("ruff", "format", "--no-cache", "--check", "mmrs_panels", "tests"),
    ],
)
def test_what_readers_have_written_is_as_clean_as_the_core(followed, terminal, tool):
    command = [sys.executable, "-m", *tool]
    done = subprocess.run(command, capture_output=True, text=True, cwd=followed, env=terminal, timeout=240)
    assert done.returncode == 0, f"{done.stdout}{done.stderr}"


def test_what_readers_have_written_is_typed_as_strictly_as_the_core(followed):
    done = mypy("mmrs_panels", folder=followed)
    assert done.returncode == 0, f"{done.stdout}{done.stderr}"


def test_pages_are_linked_in_their_order():
    index = (TUTORIAL / "index.md").read_text(encoding="utf-8")
    linked = re.findall(r"\]\((\d-\S+?\.md)\)", index)
    assert linked == [page.name for page in PAGES]
    for page, following in pairwise(PAGES):
        assert page.read_text(encoding="utf-8").rstrip().endswith(f"]({following.name})")


def test_what_pages_link_to_exists():
    for page in (*PAGES, TUTORIAL / "index.md"):
        links = re.findall(r"\]\(([^)#]+?)\)", page.read_text(encoding="utf-8"))
        assert [link for link in links if not (page.parent / link).exists()] == []
