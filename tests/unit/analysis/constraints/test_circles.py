"""What waits for itself."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.analysis.constraints.dependencies import cycles_in
from mmrs_core.analysis.constraints.sketch import remembering, sketch_of

GRAPHS = st.lists(st.sets(st.integers(0, 7)), min_size=8, max_size=8).map(
    lambda ways: {node: sorted(following) for node, following in enumerate(ways)}
)


def leads_to_itself(node, after):
    found, pending = set(), [each for each in after[node] if each != node]
    while pending:
        each = pending.pop()
        if each not in found:
            found.add(each)
            pending.extend(after[each])
    return node in found


@given(GRAPHS)
def test_circles_are_closed_ways_that_share_no_node(after):
    circles = list(cycles_in(after))
    nodes = [node for circle in circles for node in circle]
    assert len(nodes) == len(set(nodes))
    assert all(b in after[a] for circle in circles for a, b in pairwise((*circle, circle[0])))
    assert all(len(circle) > 1 for circle in circles)


@given(GRAPHS)
def test_without_the_circles_nothing_waits_for_itself(after):
    gone = {node for circle in cycles_in(after) for node in circle}
    left = {
        node: [each for each in ways if each not in gone and each != node]
        for node, ways in after.items()
        if node not in gone
    }
    assert not any(leads_to_itself(node, left) for node in left)


def test_a_circle_begins_with_the_first_of_its_nodes_and_is_a_shortest():
    assert list(cycles_in({"a": ["b"], "b": ["c", "d"], "c": ["a"], "d": ["c"]})) == [("a", "b", "c")]


def test_a_long_way_is_followed_without_recursion():
    after = {node: [(node + 1) % 5000] for node in range(5000)}
    assert [len(circle) for circle in cycles_in(after)] == [5000]


def test_the_order_of_tasks_is_found_once_while_models_are_checked(models):
    found = models.as_set
    with remembering():
        assert sketch_of(found).order is sketch_of(found).order


def test_the_ways_of_a_choice_meet_in_the_nearest_join_behind_both(models):
    order = sketch_of(models.as_set).order
    assert order.meeting(models.task("either")) is models.task("closing")
    assert order.meeting(models.task("fork")) is models.task("join")


def test_ways_of_which_one_ends_elsewhere_do_not_meet(models):
    gone = models.way("extra", "closing")
    models.mission.taskDependencies.remove(gone)
    assert sketch_of(models.as_set).order.meeting(models.task("either")) is None
