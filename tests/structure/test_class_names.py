"""One name, one thing: no two public classes of a distribution share a name."""

import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = [
    path.parent
    for pattern in ("*/__init__.py", "*/*/__init__.py", "plugins/*/*/__init__.py")
    for path in sorted(ROOT.glob(pattern))
    if (path.parents[1] / "pyproject.toml").exists()
]


def homonyms_in(package: Path) -> dict[str, list[str]]:
    """Return the modules of a package with a public class of the same name, by that name."""
    places = defaultdict(list)
    for source in sorted(package.rglob("*.py")):
        if "tests" not in source.parts:
            for name in re.findall(r"^class ([A-Za-z]\w*)", source.read_text("utf-8"), re.MULTILINE):
                places[name].append(source.relative_to(package).as_posix())
    return {name: found for name, found in places.items() if len(found) > 1}


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.name)
def test_no_two_public_classes_share_a_name(package):
    assert homonyms_in(package) == {}


def test_every_distribution_is_looked_at():
    assert {"mmrs_core", "mmrs_runtime", "mmrs_mavlink", "auv_vessel"} <= {each.name for each in PACKAGES}


def test_two_classes_of_one_name_are_found(tmp_path):
    for name in ("a.py", "b.py"):
        (tmp_path / name).write_text("class Twin:\n    pass\n", "utf-8")
    assert homonyms_in(tmp_path) == {"Twin": ["a.py", "b.py"]}
