"""A kind of robot that names no vehicle is refused by its name, by each target of this plug-in."""

from dataclasses import replace

import pytest
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.targets.ada.target import ADA
from mmrs_auv.targets.can_c.target import CAN_C
from mmrs_auv.targets.can_python.target import CAN_PYTHON
from mmrs_imc.target import IMC
from mmrs_moos.target import MOOS
from mmrs_multicopter.testing import robot_program, target_input

from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.testing.programs import program

EEL = ("urn:eels:1.0", "Eel")


@pytest.mark.parametrize("target", [ADA, CAN_C, CAN_PYTHON, IMC, MOOS], ids=lambda each: each.name)
@pytest.mark.parametrize("lossy", [False, True])
def test_a_kind_without_a_vehicle_is_refused_by_its_name(target, lossy, swimmer):
    eels = replace(swimmer(), name="Eel", metaclasses=(EEL, *swimmer().metaclasses))
    given = target_input(program(robot_program("alpha", [], type_name="Eel")), [eels])
    kind = replace(AUV_KIND, name="eel", metaclass=EEL, vehicle="")
    with pytest.raises(UnsupportedError) as error:
        render(target, replace(given, robot_kinds={EEL: kind}), allow_lossy=lossy)
    if not lossy:
        assert any(
            "'alpha': is of kind 'eel', which names no vehicle" in each for each in error.value.elements
        )
