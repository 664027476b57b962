from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from mmrs_core.testing.conformance.missions import run_command

EXAMPLE = Path(__file__).parents[3] / "examples" / "solar-park"


@pytest.mark.parametrize(
    ("file", "right", "wrong"),
    [
        ("mission.xmi", 'frontOverlap="0.85"', 'frontOverlap="85"'),
        ("context.xmi", 'azimuth="202"', 'azimuth="-158"'),
        ("context.xmi", 'azimuth="202"', 'azimuth="562"'),
    ],
)
def test_a_figure_that_can_only_be_meant_in_one_way_is_mended(file, right, wrong, tmp_path):
    folder = tmp_path / "park"
    shutil.copytree(EXAMPLE, folder)
    sound = (folder / file).read_text(encoding="utf-8").replace('azimuth="202.0"', 'azimuth="202"')
    assert right in sound
    (folder / file).write_text(sound.replace(right, wrong), encoding="utf-8")
    run_command("validate", folder, "--fix", "--yes")
    assert (folder / file).read_text(encoding="utf-8") == sound
