import shutil
from pathlib import Path

import pytest

from mmrs_core.testing.conformance.missions import run_command

RIGHT = {"mission.xmi": 'frontOverlap="0.85"', "context.xmi": 'azimuth="202"'}
EXAMPLE = Path(__file__).parents[3] / "examples" / "solar-park"


@pytest.mark.parametrize(
    "wrong",
    [{"mission.xmi": 'frontOverlap="85"', "context.xmi": 'azimuth="-158"'}, {"context.xmi": 'azimuth="562"'}],
)
def test_figures_that_can_only_be_meant_in_one_way_are_fixed(wrong, tmp_path):
    folder = tmp_path / "park"
    shutil.copytree(EXAMPLE, folder)
    for file, figure in wrong.items():
        sound = (folder / file).read_text(encoding="utf-8").replace('azimuth="202.0"', 'azimuth="202"')
        assert RIGHT[file] in sound
        (folder / file).write_text(sound.replace(RIGHT[file], figure), encoding="utf-8")
        (folder / f"{file}.sound").write_text(sound, encoding="utf-8")
    run_command("validate", folder, "--fix", "--yes")
    for file in wrong:
        assert (folder / file).read_bytes() == (folder / f"{file}.sound").read_bytes()
