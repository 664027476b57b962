"""Faults that a policy has a robot bear, where its backend has broken off what it did."""

from math import inf

import pytest
from live_runs import Flight, Script, Walker, do

from mmrs_core.contributions.execution import Fault
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import program, robot
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")


class Breaking(Walker):
    """A robot that does nothing more once something has gone wrong, until it is to bear that."""

    bears = True

    def bear(self, now):
        if self.bears:
            self.trouble, self.done = None, True
        return self.bears


class Breakable(Script):
    @property
    def factory(self):
        return VehicleFactory("breaking", "a robot of the test", lambda given: Breaking(given, self))


@pytest.fixture
def flying(kinds):
    """Return a function that begins a run of a robot that walks, with policies."""

    def fly(*policies):
        behaviour = program(robot("r", [do("walk"), do("rest")], policies=policies))
        run = Flight(behaviour, Breakable(walk=inf), kinds)
        run.wait_for_step("r begin walk")
        return run, run.script.robots["r"]

    return fly


def test_what_was_broken_off_counts_as_done_where_the_fault_is_borne(flying):
    run, walker = flying(Policy("BATTERY_LOW", "CONTINUE"))
    walker.fail("BATTERY_LOW")
    ending = run.end()
    assert ending.outcome is Outcome.SUCCESS
    assert walker.stops == []


def test_what_cannot_be_gone_on_with_ends_the_program_all_the_same(flying):
    run, walker = flying(Policy("LINK_LOST", "CONTINUE"))
    walker.bears = False
    walker.fail("LINK_LOST")
    assert run.end().faults["r"].which == "LINK_LOST"


def test_a_response_that_a_fault_brings_along_goes_before_policies(flying):
    run, walker = flying(Policy("POSITION_LOST", "CONTINUE"))
    walker.trouble = Fault("POSITION_LOST", "says the test", "LAND")
    walker.given.live.wake()
    assert run.end().faults["r"].which == "POSITION_LOST"
    assert walker.stops == ["LAND"]


def test_a_backend_announces_what_concerns_no_robot_alone_without_a_name(flying):
    run, walker = flying()
    walker.given.live.say("of mine")
    walker.given.live.announce("of all")
    walker.done = True
    walker.given.live.wake()
    run.end()
    assert run.said[:2] == ["'r': of mine", "of all"]
