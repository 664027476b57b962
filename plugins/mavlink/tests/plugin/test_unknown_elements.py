"""What nobody has taught a MAVLink target is refused by every one of them, with its place."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.testing.programs import photo, program
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

STRANGE = replace(photo(), metaclasses=(("urn:x:1.0", "Sing"), (BEHAVIOUR, "Action")))
SPIRAL = replace(go_to("a", (0.0, 9.0, 20.0)), metaclasses=(("urn:x:1.0", "Spiral"), (BEHAVIOUR, "GoTo")))

WORDS = {"mavlink-python": "is not known to this target"}
"""Why an action is refused; where nothing is said here, a plan cannot say it."""

every_target = pytest.mark.parametrize("target", [MAVLINK_PYTHON, QGC_PLAN, WPL], ids=lambda each: each.name)


def refused(target, *moves):
    with pytest.raises(UnsupportedError) as error:
        render(target, target_input(program(robot_program("alpha", moves))))
    return error.value.elements


@every_target
def test_a_move_of_an_unknown_kind_is_refused_even_if_it_extends_a_known_one(target):
    assert refused(target, take_off("up", 20.0), SPIRAL, LAND) == (
        "robot 'alpha', move 'a': Spiral is not known to this target",
    )


@every_target
def test_an_unknown_action_is_refused(target):
    (fault,) = refused(target, take_off("up", 20.0), replace(LAND, before=(STRANGE,)))
    why = WORDS.get(target.name, "has no form in a plan")
    assert fault == f"robot 'alpha', move 'down': action Sing {why}"
