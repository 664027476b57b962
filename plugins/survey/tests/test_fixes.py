import shutil
from pathlib import Path

import pytest

from mmrs_core.testing.conformance.missions import run_command

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.parametrize(
    ("project", "file", "right", "wrong"),
    [
        ("mixed-team", "mission.xmi", 'sideOverlap="0.7"', 'sideOverlap="70"'),
        ("drone-and-rover", "mission.xmi", 'frontOverlap="0.7"', 'frontOverlap="70"'),
    ],
)
def test_a_figure_that_can_only_be_meant_in_one_way_is_mended(project, file, right, wrong, tmp_path):
    folder = tmp_path / project
    shutil.copytree(EXAMPLES / project, folder)
    sound = (folder / file).read_text(encoding="utf-8")
    assert right in sound
    (folder / file).write_text(sound.replace(right, wrong, 1), encoding="utf-8")
    run_command("validate", folder, "--fix", "--yes")
    assert (folder / file).read_text(encoding="utf-8") == sound
