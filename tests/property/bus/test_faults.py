"""Whatever happens to messages and processes, the logs together tell a possible story, to its end."""

from random import Random

from bus_world import World, spoil
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.behaviour.replay import replay
from mmrs_core.testing.random_programs import programs
from mmrs_runtime.records.steps import merge

SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]


def check(program, seed, faults):
    world = World(program, Random(seed))
    spoil(world, faults)
    records = world.records()
    assert {record.robot for record in records} == {robot.id for robot in program.robots}
    result = replay(program, records)
    assert result.complaints == (), "\n".join(map(str, result.complaints))
    for process in world.processes:
        for walker in process.walkers:
            assert walker.delivery is None, "a notify is still on its way"
            if not walker.point.is_final:
                check_slots(process.node, walker.program, records)
    return world.said


def check_slots(node, robot, records):
    """Check that slots are as the merged logs say; one that has ended need not be told any more."""
    for slot in robot.slots:
        assert node.state((robot.id, slot)).active == last_value(records, robot.id, slot)


def last_value(records, robot, slot):
    """Return what the merged logs say that a slot is in the end."""
    value = False
    for record in merge(records):
        if record.label == "ntf" and f"{robot}.{slot}" in record.slot[1:].split():
            value = record.slot[0] == "+"
    return value


PROGRAMS = programs(robots=(2, 4), moves=(1, 4))
LATCHED = programs(robots=(2, 4), moves=(1, 4), resets=False)


@given(PROGRAMS, st.integers(0, 2**32), st.integers(0, 60))
@settings(suppress_health_check=SLOW)
def test_histories_of_faults_replay(program, seed, faults):
    check(program, seed, faults)


@given(LATCHED, st.integers(0, 2**32), st.integers(0, 60))
@settings(suppress_health_check=SLOW)
def test_histories_of_faults_replay_where_no_slot_is_ever_reset(program, seed, faults):
    assert not check(program, seed, faults) & {"prepare", "abort"}
