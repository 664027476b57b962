import pytest
from mmrs_multicopter.conditions import CONDITIONS

from mmrs_core.contributions.execution import RobotState

ABOVE_100 = next(each for each in CONDITIONS if each.identifier == "energy_above_100_kJ")


@pytest.mark.parametrize(("joules", "holds"), [(100_001.0, True), (100_000.0, False), (0.0, False)])
def test_energy_above_holds_only_above_its_figure(joules, holds):
    assert ABOVE_100.holds(RobotState(0.0, (0.0, 0.0, 0.0), 0.0, 0.0, joules)) is holds


def test_unknown_energy_is_a_fault_and_not_false():
    with pytest.raises(ValueError, match="not known"):
        ABOVE_100.holds(RobotState(0.0, (0.0, 0.0, 0.0), 0.0, 0.0, None))
