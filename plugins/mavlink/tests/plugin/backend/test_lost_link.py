"""What vehicles are told to do by themselves about a lost link, while robots go through their waits."""

from dataclasses import replace

from mmrs_multicopter.testing import LAND, robot_program, take_off, target_input

from mmrs_core.testing.programs import program
from mmrs_mavlink.driving.lost_link import LostLink
from mmrs_mavlink.plugin.controllers import robot_of
from mmrs_mavlink.program import Policy
from mmrs_mavlink.steps.responses import BLOCKED
from mmrs_mavlink.vehicles.dry import DryVehicle
from mmrs_runtime.clock import Clock

BEHAVIOUR = program(robot_program("r", [take_off("up", 20.0), LAND]))
HOLDS = replace(
    robot_of(BEHAVIOUR.robots[0], target_input(BEHAVIOUR)), policies=(Policy("LINK_LOST", "HOLD", 5.0),)
)
LANDS = (Policy("LINK_LOST", "LAND", 3.0),)
FLEES = (Policy("LINK_LOST", "EMERGENCY_AREA"),)
RETURNS = (Policy("LINK_LOST", "RETURN"),)


class Told(DryVehicle):
    """Remembers what it was told to do by itself."""

    def __init__(self):
        super().__init__(Clock(1e6), HOLDS.home, lambda: None)
        self.answers = []

    def answer_lost_link(self, response, after=None):
        self.answers.append((response, after))


def told(robot=HOLDS):
    """Return what keeps a vehicle's answer, the vehicle's own answers, and what people were told."""
    vehicle, said = Told(), []
    return LostLink(robot, vehicle, said.append), vehicle.answers, said


def test_nothing_is_due_before_the_vehicle_was_told_anything():
    lost_link, answers, _ = told()
    lost_link.follow(LANDS)
    lost_link.tell_what_is_due()
    assert answers == []


def test_the_policies_of_a_wait_count_while_it_lasts_and_are_told_once():
    lost_link, answers, _ = told()
    lost_link.tell()
    for policies in (LANDS, LANDS, (), ()):
        lost_link.follow(policies)
        lost_link.tell_what_is_due()
    assert answers == [("HOLD", 5.0), ("LAND", 3.0), ("HOLD", 5.0)]


def test_a_vehicle_that_has_started_anew_in_a_wait_is_told_what_counts_there():
    lost_link, answers, _ = told()
    lost_link.tell()
    lost_link.follow(LANDS)
    lost_link.tell()
    assert answers == [("HOLD", 5.0), ("LAND", 3.0)]
    assert not lost_link.is_due


def test_people_are_told_where_the_way_out_that_a_wait_wants_is_blocked():
    lost_link, answers, said = told(replace(HOLDS, straight=False))
    lost_link.tell()
    assert said == []
    lost_link.follow(FLEES)
    lost_link.tell_what_is_due()
    assert (answers[-1], said) == (("RETURN", None), [BLOCKED])


def test_people_are_told_so_also_where_the_vehicle_does_the_same_as_before():
    lost_link, _, said = told(replace(HOLDS, straight=False, policies=RETURNS))
    lost_link.tell()
    lost_link.follow(FLEES)
    lost_link.tell_what_is_due()
    assert said == [BLOCKED]
