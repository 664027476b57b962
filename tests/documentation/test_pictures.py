"""The pictures on the pages are what the commands draw now."""

from pathlib import Path

from mmrs_core.cli import run
from mmrs_core.resources import shipped

MAP = Path(__file__).parents[2] / "docs" / "assets" / "drone-and-rover.svg"


def test_the_map_on_the_first_page_is_the_one_that_preview_draws(tmp_path, update_golden, capsys):
    assert run(["preview", str(shipped("examples") / "drone-and-rover"), "-o", str(tmp_path)]) == 0
    drawn = (tmp_path / "preview.svg").read_text(encoding="utf-8")
    if update_golden:
        MAP.write_text(drawn, encoding="utf-8", newline="\n")
    assert MAP.read_text(encoding="utf-8") == drawn
