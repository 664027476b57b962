"""The bus within a process."""

import pytest

from mmrs_core.testing.small_programs import program, robot
from mmrs_runtime.bus.messages import CommandId, SlotState
from mmrs_runtime.slots import LocalSlots

A, B = ("a", "s"), ("b", "s")


@pytest.fixture
def bus():
    return LocalSlots(program(robot("a", [], slots=("s",)), robot("b", [], slots=("s",))).executable)


def notify(bus, number, *slots, active=True, sender="b", incarnation="0", lamport=1):
    delivery = bus.prepare(CommandId("run", sender, incarnation, number), slots, active)
    assert delivery.lamport is not None
    delivery.send(max(lamport, delivery.lamport))
    assert delivery.waiting == ()
    return delivery


def test_slots_are_inactive_at_the_beginning(bus):
    assert bus.state(A) == SlotState(active=False, version=0)


def test_a_command_sets_all_its_slots(bus):
    notify(bus, 0, A, B)
    assert bus.state(A).active
    assert bus.state(B) == SlotState(active=True, version=1, lamport=1, writer="b")


def test_a_notify_that_a_log_tells_of_again_is_applied_once(bus):
    first, second = notify(bus, 0, A), notify(bus, 1, A, active=False)
    bus.apply("b", (A,), True, first.lamport)
    bus.apply("b", (A,), False, second.lamport)
    assert not bus.state(A).active
    assert bus.state(A).version == 2


def test_a_restarted_sender_may_count_from_the_beginning_again(bus):
    notify(bus, 5, A)
    notify(bus, 0, A, active=False, incarnation="1")
    assert not bus.state(A).active


def test_setting_a_slot_that_is_active_keeps_it_active(bus):
    notify(bus, 0, A)
    notify(bus, 1, A)
    assert bus.state(A).active


def test_a_command_with_an_unknown_slot_changes_nothing(bus):
    with pytest.raises(KeyError):
        notify(bus, 0, A, ("c", "s"))
    assert not bus.state(A).active


def test_a_notify_is_ordered_after_all_that_has_happened_to_its_slots(bus):
    notify(bus, 0, A, lamport=3)
    assert bus.passed((A,), 7)
    delivery = bus.prepare(CommandId("run", "b", "0", 1), (A, B), False)
    assert delivery.lamport == 8
    with pytest.raises(ValueError, match="logical time 7"):
        delivery.send(7)


def test_a_wait_is_not_passed_at_a_time_at_which_its_slot_was_not_set_yet(bus):
    notify(bus, 0, A, lamport=3)
    assert not bus.passed((A,), 3)
    assert bus.state(A).lamport == 3


def test_a_wait_is_not_passed_before_all_its_slots_are_active(bus):
    notify(bus, 0, A)
    assert not bus.passed((A, B), 9)
    assert bus.state(A).lamport == 1


def test_a_robot_that_has_left_is_lost(bus):
    bus.leave("b")
    bus.leave("b")
    assert bus.lost(("a", "b")) == ("b",)
