"""Behaviours derived from an example are safe, and no longer so once anything in them is altered."""

from dataclasses import replace

import pytest

from mmrs_core import pipeline
from mmrs_core.analysis.checks import CHECKS
from mmrs_core.analysis.verdicts import refuses, verify
from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.resources import shipped
from mmrs_core.scene import AreaUse

NOTIFY = ("urn:mmrs:behaviour:1.0", "Notify")
HOLD = ("urn:mmrs:behaviour:1.0", "HoldPosition")
LAND = ("urn:mmrs:multicopter:1.0", "Land")


@pytest.fixture(scope="module")
def derived(contributions):
    """Return the input of checks on what is derived from the first example."""
    models, _ = pipeline.valid_models(shipped("examples") / "carbon-dioxide", contributions)
    scene = pipeline.expand(pipeline.ground(models), contributions)
    behaviour, _ = pipeline.transform(scene, pipeline.plan(scene), contributions)
    place = pipeline.place_of_scene(scene)
    program = pipeline.program_of(behaviour, contributions)
    return CheckInput(
        program=program,
        types=place.types,
        robot_kinds=contributions.robot_kinds,
        move_kinds=contributions.move_kinds,
        areas=place.areas,
        environment=place.environment,
    )


def altered(given, robot, index, move):
    """Return the input with one move replaced by another."""
    moves = (*robot.moves[:index], move, *robot.moves[index + 1 :])
    mine = [replace(each, moves=moves) if each.id == robot.id else each for each in given.program.robots]
    return replace(given, program=replace(given.program, robots=tuple(mine)), shared={})


def places(given, wanted):
    """Yield every robot and move of which something holds."""
    for robot in given.program.robots:
        for index, move in enumerate(robot.moves):
            if wanted(move):
                yield robot, index, move


def violations(given, name):
    check = next(check for check in CHECKS if check.name == name)
    return [verdict for verdict in check.run(given) if verdict.status is Status.VIOLATED]


def notifies(move):
    return any(action.is_a(NOTIFY) for action in (*move.before, *move.after))


def without_notifies(move):
    before = tuple(action for action in move.before if not action.is_a(NOTIFY))
    return replace(move, before=before, after=tuple(a for a in move.after if not a.is_a(NOTIFY)))


def test_what_is_derived_is_safe(derived):
    assert refuses(verify(replace(derived, shared={}), CHECKS), derived.program.accepted_unknowns) == ()


def test_leaving_out_any_notify_strands_somebody(derived):
    found = list(places(derived, notifies))
    assert found
    for robot, index, move in found:
        mutant = altered(derived, robot, index, without_notifies(move))
        told = {owner for action in (*move.before, *move.after) for owner, _ in action.sets}
        assert told & {verdict.robot for verdict in violations(mutant, "synchronisation")}


def test_turning_round_any_notify_strands_somebody(derived):
    found = list(places(derived, notifies))
    assert found
    for robot, index, move in found:
        after = tuple(replace(action, active=False) for action in move.after)
        before = tuple(replace(action, active=False) for action in move.before)
        assert violations(
            altered(derived, robot, index, replace(move, before=before, after=after)), "synchronisation"
        )


def test_leading_any_move_into_the_middle_of_an_area_is_violated_by_name(derived):
    area = next(area for area in derived.areas if area.use is AreaUse.FORBIDDEN)
    middle = [sum(corner[i] for corner in area.shell) / len(area.shell) for i in (0, 1)]
    chosen = list(places(derived, lambda move: move.target is not None))[::25]
    assert chosen
    for robot, index, move in chosen:
        target = replace(move.target, position=(*middle, move.target.position[2]))
        found = violations(altered(derived, robot, index, replace(move, target=target)), "clearance")
        assert area.name in {verdict.area for verdict in found}
        assert {verdict.robot for verdict in found} == {robot.id}
        assert {verdict.move for verdict in found if verdict.area == area.name} <= {
            move.id,
            *(robot.moves[way].id for way in robot.transitions[index].next_moves),
        }


def test_a_landing_that_is_left_out_is_violated(derived):
    landings = list(places(derived, lambda move: move.is_a(LAND)))
    assert landings
    for robot, index, move in landings:
        held = replace(
            move, metaclasses=(("urn:mmrs:behaviour:1.0", "HoldPosition"),), attributes={"duration": 1.0}
        )
        assert violations(altered(derived, robot, index, held), "states")


def test_half_the_lifetime_is_too_little(derived):
    def weak(robot_type):
        lives = [replace(each, lifetime=each.lifetime / 2) for each in robot_type.capabilities]
        return replace(robot_type, capabilities=tuple(lives))

    types = {name: weak(robot_type) for name, robot_type in derived.types.items()}
    assert violations(replace(derived, types=types, shared={}), "endurance")
    assert violations(replace(derived, types=types, shared={}), "energy")
