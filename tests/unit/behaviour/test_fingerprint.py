"""What tells one plan of a mission from another."""

from dataclasses import replace

from mmrs_multicopter.testing import two_drones

from mmrs_core.diagnostics import Place


def with_first_move(**changes):
    program = two_drones()
    robot = program.robots[0]
    moves = (replace(robot.moves[0], **changes), *robot.moves[1:])
    return replace(program, robots=(replace(robot, moves=moves), *program.robots[1:]))


def test_plans_that_are_the_same_have_the_same_fingerprint_wherever_they_were_read_from():
    assert two_drones().fingerprint == with_first_move(place=Place("elsewhere.json", 7)).fingerprint


def test_plans_that_differ_in_anything_have_different_fingerprints():
    plans = [two_drones(), with_first_move(speed=3.25), with_first_move(attributes={"duration": 7.0})]
    plans.append(replace(two_drones(), minimum_separation=12.5))
    assert len({plan.fingerprint for plan in plans}) == len(plans)
