"""Laws that constraints keep whatever the model."""

from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from math import inf

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.analysis.constraints import CONSTRAINTS
from mmrs_core.analysis.constraints.sketch import Sketch
from mmrs_core.geometry.segments import legs_of, prism_distance
from mmrs_core.grounding.frame import cycles_among
from mmrs_core.languages import context, mission
from mmrs_core.languages.modelset import ModelSet

CIRCLES = [each for each in CONSTRAINTS if each.code == "MML040"]
CLOSED = [each for each in CONSTRAINTS if each.code in ("MML048", "MML050")]
same_project = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)

edges = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)).filter(lambda e: e[0] != e[1]), max_size=14)


def ordered(models, links):
    tasks = [mission.Join(name=str(number)) for number in range(7)]
    models.mission.tasks = tasks
    models.mission.taskDependencies = [
        mission.TaskDependency(from_=tasks[before], to=tasks[after]) for before, after in links
    ]


@same_project
@given(edges)
def test_tasks_wait_for_themselves_exactly_where_no_order_exists(fresh_models, links):
    models = fresh_models()
    ordered(models, links)
    sorter = TopologicalSorter()
    for before, after in links:
        sorter.add(after, before)
    try:
        sorter.prepare()
        circular = False
    except CycleError:
        circular = True
    assert bool(models.faults(CIRCLES)) == circular


@same_project
@given(edges)
def test_every_circle_that_is_named_is_one(fresh_models, links):
    models = fresh_models()
    ordered(models, links)
    for fault in models.faults(CIRCLES):
        way = [int(name) for name in fault.message.rpartition(": ")[2].split(" → ")]
        assert way[0] == way[-1]
        assert set(pairwise(way)) <= set(links)


@same_project
@given(st.lists(st.integers(0, 3), min_size=1, max_size=4), st.booleans())
def test_arms_that_meet_in_a_join_are_closed(fresh_models, lengths, nested):
    models = fresh_models()
    fork, join = mission.Fork(name="f"), mission.Join(name="j")
    tasks, links = [fork, join], [(fork, join, None)]
    for number, length in enumerate(lengths):
        arm = [
            models.trial("Visit", name=f"{number}.{n}", point=models.at(n, number, 20)) for n in range(length)
        ]
        if nested and arm:
            inner, outer = mission.Fork(name=f"f{number}"), mission.Join(name=f"j{number}")
            links += [(inner, outer, None), (inner, arm[-1], "x"), (arm[-1], outer, None)]
            tasks += [arm[-1], inner, outer]
            arm = [*arm[:-1], inner, outer]
            links += [(*pair, None) for pair in pairwise(arm) if pair != (inner, outer)]
            tasks += arm[:-2]
        else:
            links += [(*pair, None) for pair in pairwise(arm)]
            tasks += arm
        if arm:
            links += [(fork, arm[0], f"c{number}"), (arm[-1], join, None)]
    models.mission.tasks, models.mission.taskDependencies = tasks, []
    for before, after, condition in links:
        models.link(before, after, condition)
    assert models.faults(CLOSED) == ()


coordinates = st.floats(-100, 100)


@given(
    st.tuples(coordinates, coordinates, coordinates),
    st.one_of(st.just(-inf), st.floats(-50, 0)),
    st.one_of(st.just(inf), st.floats(1, 50)),
)
def test_distance_of_an_area_is_that_of_the_prism_as_drawn(position, low, high):
    ring = ((0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (20.0, 10.0), (0.0, 30.0))
    place = context.Context(
        obstacles=[
            context.Obstacle(
                shell=[mission.RelativeCoordinate(x=x, y=y) for x, y in ring],
                minHeight=None if low == -inf else low,
                maxHeight=None if high == inf else high,
            )
        ]
    )
    home = mission.Robot(home=mission.RelativeCoordinate(x=0.0, y=0.0))
    drawn = Sketch(ModelSet(mission.Mission(team=mission.Team(robots=[home])), place, {}, ()))
    ((_, found),) = drawn.distances(position)
    (expected,) = prism_distance(legs_of([position, position]), ring, low, high)
    assert found == pytest.approx(float(expected), abs=1e-9)


@given(st.lists(st.integers(-1, 7), min_size=8, max_size=8))
def test_circles_among_coordinates_are_all_found_once(references):
    made = [mission.RelativeCoordinate(x=0.0, y=0.0) for _ in references]
    for each, target in zip(made, references, strict=True):
        each.reference = made[target] if target >= 0 else None

    def on_circle(start):
        current = references[start]
        for _ in made:
            if current in (-1, start):
                break
            current = references[current]
        return current == start

    found = list(cycles_among(made, lambda each: each.reference))
    members = [each for circle in found for each in circle]
    assert len(members) == len(set(members))
    assert {made.index(each) for each in members} == {n for n in range(8) if on_circle(n)}
