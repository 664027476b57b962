"""The page about the languages is the one that the metamodels give."""

import re
from pathlib import Path

import pytest
from lxml import etree

from mmrs_core.cli import run
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.pictures.pages.languages import pages

ROOT = Path(__file__).parents[2]
PLUGINS = {
    "auv": ("auv", "auv-tasks"),
    "multicopter": ("multicopter",),
    "rover": ("rover",),
    "solar": ("solar",),
    "survey": ("survey",),
}


@pytest.fixture(scope="module")
def registry():
    """Return the core's languages and those of the plug-ins in this checkout, as when all are installed."""
    return registry_with(
        MetamodelSource(etree.parse(file).getroot().get("nsURI"), file, f"mmrs-{name}")
        for name, languages in PLUGINS.items()
        for language in languages
        for file in [ROOT / "plugins" / name / f"mmrs_{name}" / "metamodels" / f"{language}.ecore"]
    )


@pytest.fixture(scope="module")
def made(registry):
    return pages(registry)


def test_the_committed_page_is_current(made):
    stale = [path for path, content in made.items() if (ROOT / "docs" / path).read_text("utf-8") != content]
    assert stale == [], "run: mmrs metamodel docs docs"


def test_no_diagram_is_left_over(made):
    assert {f"diagrams/{path.name}" for path in (ROOT / "docs" / "diagrams").iterdir()} | {
        "languages.md"
    } == set(made)


def test_every_class_has_a_section(made, registry):
    headings = set(re.findall(r"^### (.+)$", made["languages.md"], re.MULTILINE))
    classes = {f"{package.name}.{each.name}" for package in registry.packages for each in package.metaclasses}
    enumerations = {
        f"{package.name}.{each.name}" for package in registry.packages for each in package.enumerations
    }
    assert headings == classes | enumerations


def test_every_feature_has_a_row_with_its_meaning(made, registry):
    rows = made["languages.md"].splitlines()
    for package in registry.packages:
        for metaclass in package.metaclasses:
            for feature in metaclass.features:
                found = [row for row in rows if row.startswith(f"| `{feature.name}` |")]
                assert found, feature
                assert all(row.rstrip("| ").count(" | ") == 4 for row in found), feature


def test_every_diagram_shows_every_class_and_feature(made, registry):
    for package in registry.packages:
        words = [text for text in etree.fromstring(made[f"diagrams/{package.name}.svg"].encode()).itertext()]
        for metaclass in package.metaclasses:
            assert metaclass.name in words
            own = [feature for feature in metaclass.features if feature.owner is metaclass]
            assert [f for f in own if not any(word.startswith(f"{f.name}: ") for word in words)] == []


def test_boxes_of_a_diagram_do_not_overlap(made):
    for path, content in made.items():
        if not path.endswith(".svg"):
            continue
        rects = [
            tuple(float(rect.get(side)) for side in ("x", "y", "width", "height"))
            for rect in etree.fromstring(content.encode()).iter("{http://www.w3.org/2000/svg}rect")
            if rect.get("x")
        ]
        for i, (x, y, w, h) in enumerate(rects):
            for a, b, c, d in rects[i + 1 :]:
                assert x + w <= a or a + c <= x or y + h <= b or b + d <= y, (path, x, y)


def test_the_pages_can_be_written_anywhere(tmp_path):
    assert run(["metamodel", "docs", str(tmp_path / "new")]) == 0
    assert (tmp_path / "new" / "languages.md").is_file()
    assert (tmp_path / "new" / "diagrams" / "mission.svg").is_file()
