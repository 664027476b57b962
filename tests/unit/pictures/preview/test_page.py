"""The page stands by itself and holds no code but its own."""

import json
import re
from html.parser import HTMLParser

from mmrs_core.cli.preview import write_pictures
from mmrs_core.pictures.preview.page import page

HOSTILE = "</script><script>alert(1)</script><!--\u2028"


class Reader(HTMLParser):
    """Collects what a browser would act on."""

    def __init__(self):
        super().__init__()
        self.tags, self.texts, self.links = [], {}, []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.links += [value for name, value in attrs if name in ("href", "src", "action", "data")]
        self.links += [name for name, _ in attrs if name.startswith("on")]

    def handle_data(self, data):
        if self.tags:
            self.texts.setdefault(self.tags[-1], []).append(data)


def read(markup):
    reader = Reader()
    reader.feed(markup)
    return reader


def test_the_page_refers_to_nothing_outside(picture):
    markup = page(picture)
    assert read(markup).links == []
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", markup)
    assert "@import" not in markup


def test_the_page_forbids_the_browser_to_fetch(picture):
    assert "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'" in page(picture)


def test_hostile_names_add_no_script(picture, picture_named):
    plain, hostile = page(picture), page(picture_named(Alba=HOSTILE, road=HOSTILE, mission=HOSTILE))
    assert read(hostile).tags.count("script") == read(plain).tags.count("script") == 2
    assert "alert(1)</script>" not in hostile


def test_the_player_gets_every_leg(picture):
    markup = page(picture)
    data = json.loads(re.search(r'id="data">(.*?)</script>', markup).group(1))
    assert [len(robot["legs"]) for robot in data["robots"]] == [len(robot.legs) for robot in picture.robots]
    assert data["axis"]["end"] == picture.makespan


def test_every_robot_and_layer_can_be_switched(picture):
    markup = page(picture)
    assert markup.count("data-toggle-robot=") == 2
    layers = set(re.findall(r'data-toggle="(\w+)"', markup))
    assert layers <= set(re.findall(r'data-layer="(\w+)"', markup))


def test_assumptions_are_told(picture):
    assert "terrain is taken as flat" in page(picture)


def test_the_same_picture_gives_the_same_bytes(picture, picture_named):
    assert page(picture) == page(picture_named())


def test_both_files_are_written(picture, tmp_path):
    written = write_pictures(picture, tmp_path / "new" / "folder")
    assert [path.name for path in written] == ["preview.html", "preview.svg"]
    assert all(path.stat().st_size > 1000 for path in written)
