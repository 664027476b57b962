"""Which folders a run may be gone on with in."""

import pytest
import typer
from mmrs_multicopter.testing import two_drones

from mmrs_core.cli.flying import resumed_steps
from mmrs_core.cli.run_options import RunOptions
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord

_ALPHA = two_drones().robot("alpha")
START = _ALPHA.moves[_ALPHA.start].id


@pytest.mark.parametrize("name", ["alpha.blackbox.ndjson", "alpha.slots.ndjson"])
def test_a_run_in_which_nothing_began_is_tried_again(tmp_path, name):
    (tmp_path / name).write_text("")
    assert resumed_steps(two_drones(), RunOptions(tmp_path, "mavlink", resume=True), ("alpha",)) == ()


@pytest.mark.parametrize("name", ["beta.blackbox.ndjson", "notes.txt"])
def test_a_folder_that_knows_nothing_of_the_robots_is_refused(tmp_path, name):
    (tmp_path / name).write_text("")
    with pytest.raises(typer.BadParameter, match="no logs in"):
        resumed_steps(two_drones(), RunOptions(tmp_path, "mavlink", resume=True), ("alpha",))


def test_a_run_whose_robots_were_refused_before_it_began_is_not_gone_on_with_without_them(tmp_path):
    with LogWriter(tmp_path) as writer:
        writer.write(StepRecord("run-0", "alpha", 0, 1, 2.0, "fault", START, "REFUSED"))
    with pytest.raises(typer.BadParameter, match="nothing had begun"):
        resumed_steps(two_drones(), RunOptions(tmp_path, "mavlink", resume=True), ("alpha", "beta"))
