"""Moves to a distance from their target."""

import pytest

from mmrs_core.languages import behaviour


def complaints(models):
    return [fault.message for fault in models.faults() if fault.code == "BL052"]


def lead_through(models, move, **ways):
    """Put a move between Start and the first GoTo."""
    walker, go = models.behaviour.robots[0], models.move("go")
    models.transition("start").to = move
    walker.moves.append(move)
    walker.moveTransitions.append(behaviour.MoveTransition(from_=move, to=go, **ways))


def test_a_move_is_begun_where_the_one_before_ended(models):
    near = behaviour.RelativeCoordinate(name="near", x=50.0, y=50.0, z=22.0)
    models.behaviour.targets.append(near)
    lead_through(models, behaviour.GoTo(name="there", target=near))
    models.move("go").distance = 3.0
    assert complaints(models) == ["GoTo 'go': is to end 3 m from its target, but begins at most 2 m from it"]


def test_a_stay_in_between_changes_nothing(models):
    models.move("go").distance = 80.0
    lead_through(models, behaviour.HoldPosition(name="pause", duration=1.0))
    assert len(complaints(models)) == 1


@pytest.mark.parametrize(("distance", "count"), [(75.0, 0), (76.0, 1)])
def test_the_tolerance_of_an_object_counts_in_favour(models, distance, count):
    thing = models.behaviour.targets[2]  # expected within 2 m of where it is 73.5 m from home
    models.put(models.move("go"), target=thing, distance=distance)
    assert len(complaints(models)) == count


def test_an_object_that_is_expected_nowhere_is_not_known_to_be_near(models):
    thing = behaviour.ObjectTarget(name="other", description="buoy")
    models.behaviour.targets.append(thing)
    models.put(models.move("go"), target=thing, distance=1e6)
    assert complaints(models) == []


def test_from_several_places_nothing_is_known_of_the_last_stay(models):
    pause = behaviour.HoldPosition(name="pause", duration=1.0)
    lead_through(models, pause)
    models.move("go").distance = 80.0
    walker = models.behaviour.robots[0]
    walker.moveTransitions.append(behaviour.MoveTransition(from_=models.move("hold"), to=pause))
    assert complaints(models) == []
