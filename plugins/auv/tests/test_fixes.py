import shutil
from pathlib import Path

import pytest

from mmrs_core.testing.conformance.missions import run_command

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("project", "file", "right", "wrong"),
    [
        (
            "mixed-team",
            "robots/inspection-auv.xmi",
            'operatingThrust="40.0" maxThrust="70.0"',
            'operatingThrust="70.0" maxThrust="40.0"',
        ),
        (
            "mixed-team",
            "robots/inspection-auv.xmi",
            'operatingPower="150.0" maxPower="350.0"',
            'operatingPower="350.0" maxPower="150.0"',
        ),
        ("outfall", "mission.xmi", 'overlap="0.2"', 'overlap="20"'),
        ("outfall", "mission.xmi", 'minDepth="2.0" maxDepth="14.0"', 'minDepth="14.0" maxDepth="2.0"'),
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
