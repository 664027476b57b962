"""Every distribution is under the licence of the project, and the page on licences is true."""

import re
import tomllib
from importlib.metadata import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[3]
PROJECTS = [ROOT, ROOT / "runtime", *(path.parent for path in sorted(ROOT.glob("plugins/*/pyproject.toml")))]
PAGE = (ROOT / "docs" / "licences.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| ([\w.-]+) \| `(\S+)` \| (.+) \|$", PAGE, re.MULTILINE)
FAMILY = re.compile(r"0BSD|LGPL|BSD|MIT|Apache|EPL|Eclipse|Zlib|CC0|MPL|Mozilla|GNU")
ALSO = {"Eclipse": "EPL", "GNU": "LGPL", "Mozilla": "MPL"}


def described(project: Path) -> dict[str, object]:
    """Return what a distribution says of itself."""
    found = tomllib.loads((project / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert isinstance(found, dict)
    return found


def needed() -> set[tuple[str, str]]:
    """Return (distribution, by what it is needed) of all that is imported."""
    found = set()
    for project in map(described, PROJECTS):
        extras = {f"[{name}]": each for name, each in project.get("optional-dependencies", {}).items()}
        for extra, lines in {"": project["dependencies"], **extras}.items():
            names = (Requirement(line).name for line in lines)
            found |= {(name, f"{project['name']}{extra}") for name in names if extra != "[dev]"}
    return {each for each in found if not each[0].startswith(("mmrs-", "auv-vessel", "auv-vision"))}


def families(text: str) -> set[str]:
    return {ALSO.get(name, name) for name in FAMILY.findall(text)}


@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_a_distribution_states_and_carries_the_licence(project):
    assert (described(project)["license"], described(project)["license-files"]) == ("Apache-2.0", ["LICENSE"])
    assert (project / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_the_licence_is_the_apache_licence_as_it_stands():
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert "Apache License\n                           Version 2.0, January 2004\n" in text
    assert "END OF TERMS AND CONDITIONS" in text


def test_the_page_lists_everything_that_is_imported():
    assert {(name, by) for name, by, _ in ROWS} == needed()


@pytest.mark.parametrize(("name", "licence"), [(name, licence) for name, _, licence in ROWS])
def test_the_page_names_the_licence_that_a_distribution_states(name, licence):
    stated = metadata(name)
    classifiers = " ".join(each for each in stated.get_all("Classifier", []) if each.startswith("License"))
    text = stated["License-Expression"] or stated["License"] or classifiers
    assert families(text)
    assert families(licence) == families(text)
