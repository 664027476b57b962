"""The site builds without a warning, and needs no network to be read."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from lxml import html

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Return the folder of the built site."""
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)],
        cwd=ROOT,
        env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return folder


@pytest.fixture(scope="module")
def trees(site):
    """Return every page of the site, by its path."""
    return {path.relative_to(site).as_posix(): html.parse(str(path)) for path in site.rglob("*.html")}


def test_every_page_of_the_documentation_is_on_the_site(site):
    pages = {path.relative_to(ROOT / "docs").with_suffix(".html") for path in (ROOT / "docs").rglob("*.md")}
    assert {page for page in pages if not (site / page).is_file()} == set()


def test_nothing_that_a_page_loads_comes_from_elsewhere(trees):
    loading = "//script/@src | //link[@rel='stylesheet' or @rel='icon' or @rel='preload']/@href | //img/@src"
    foreign = {(page, url) for page, tree in trees.items() for url in tree.xpath(loading) if "//" in url}
    assert foreign == set()


def test_no_style_sheet_loads_from_elsewhere(site):
    foreign = [
        (path.name, url)
        for path in site.rglob("*.css")
        for url in re.findall(r"(?:url\(|@import )['\"]?(?:https?:)?//[^)'\"]+", path.read_text("utf-8"))
    ]
    assert foreign == []


def test_every_link_inside_the_site_leads_somewhere(site, trees):
    anchors = {page: set(tree.xpath("//@id")) for page, tree in trees.items()}
    broken = []
    for page, tree in trees.items():
        if page == "404.html":
            continue  # it stands for any address: its links begin at the root
        for link in tree.xpath("//article//a/@href"):
            path, _, anchor = link.partition("#")
            if "://" in path or path.startswith("mailto:"):
                continue
            goal = (site / page).parent.joinpath(path).resolve() if path else site / page
            name = goal.relative_to(site.resolve()).as_posix() if path else page
            if not goal.is_file() or (anchor and name in anchors and anchor not in anchors[name]):
                broken.append((page, link))
    assert broken == []


def test_the_site_can_be_searched_without_a_server(site):
    index = (site / "search" / "search_index.js").read_text("utf-8")
    assert "turningRadius" in index
