"""The bus within a process."""

from __future__ import annotations

import pytest

from mmrs_core.contributions.execution import CommandId, SlotCommand, SlotState
from mmrs_core.errors import InternalError
from mmrs_core.runtime.slots import InProcessBus
from mmrs_core.testing.small_programs import program, robot

A, B = ("a", "s"), ("b", "s")


@pytest.fixture
def bus():
    return InProcessBus(program(robot("a", [], slots=("s",)), robot("b", [], slots=("s",))))


def command(number, *slots, active=True, sender="b", incarnation="0", lamport=1):
    return SlotCommand(CommandId("run", sender, incarnation, number), slots, active, lamport)


def test_slots_are_inactive_at_the_beginning(bus):
    assert bus.state(A) == SlotState(active=False, version=0)


def test_a_command_sets_all_its_slots(bus):
    bus.notify(command(0, A, B))
    assert bus.state(A).active
    assert bus.state(B) == SlotState(active=True, version=1, lamport=1, writer="b")


def test_a_command_that_arrives_twice_is_applied_once(bus):
    bus.notify(command(0, A))
    bus.notify(command(1, A, active=False))
    bus.notify(command(0, A))
    bus.notify(command(1, A, active=False))
    assert not bus.state(A).active
    assert bus.state(A).version == 2


def test_a_restarted_sender_may_count_from_the_beginning_again(bus):
    bus.notify(command(5, A))
    bus.notify(command(0, A, active=False, incarnation="1"))
    assert not bus.state(A).active


def test_setting_a_slot_that_is_active_keeps_it_active(bus):
    bus.notify(command(0, A))
    bus.notify(command(1, A))
    assert bus.state(A).active


def test_a_command_with_an_unknown_slot_changes_nothing(bus):
    with pytest.raises(InternalError, match=r"c\.s: no such slot"):
        bus.notify(command(0, A, ("c", "s")))
    assert not bus.state(A).active


def test_a_wait_that_was_passed_orders_later_notifies_after_it(bus):
    bus.notify(command(0, A, lamport=3))
    bus.passed((A,), 7)
    assert bus.state(A).lamport == 7
    bus.passed((A,), 4)
    assert bus.state(A).lamport == 7
