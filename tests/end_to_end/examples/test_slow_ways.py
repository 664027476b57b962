"""The pool's gate is a slow task: the vehicle goes there slowly, through every stage."""

import pytest

pytestmark = pytest.mark.together("examples")


@pytest.fixture
def pool(taken):
    return taken("pool")


@pytest.fixture
def cruise(pool):
    return pool.scene.robots[0].kinematics.cruise


def test_the_way_to_the_slow_task_is_commanded_slower_than_cruise(pool, cruise):
    moves = [move for move in pool.program.robots[0].moves if move.task == "gate" and move.kind == "GoTo"]
    assert moves
    assert all(0.0 < move.speed < cruise for move in moves)


def test_all_other_ways_to_tasks_are_at_cruise(pool):
    ways = [
        move
        for move in pool.program.robots[0].moves
        if move.rule == "transit" and move.task != "gate" and move.kind == "GoTo"
    ]
    assert ways
    assert {move.speed for move in ways} == {None}


def test_the_simulated_vehicle_comes_through_the_gate_when_the_plan_says(pool):
    gate = (
        pool.program.robots[0]
        .moves[next(i for i, move in enumerate(pool.program.robots[0].moves) if move.task == "gate")]
        .target.position
    )
    there = next(
        sample.time
        for sample in pool.run.tracks["Naiad"]
        if max(abs(a - b) for a, b in zip((sample.east, sample.north, sample.up), gate, strict=True)) < 1e-3
    )
    assert there == pytest.approx(pool.plan.begins["gate"], abs=0.1)
