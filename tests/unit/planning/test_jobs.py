import pytest
from plain_scenes import control, robot, scene, visit

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.jobs import Choice, jobs_of

HERE = visit((9.0, 9.0, 9.0))


def jobs(names, after, forks=(), joins=()):
    controls = [control(name, "Fork") for name in forks] + [control(name, "Join") for name in joins]
    return {
        job.name: job
        for job in jobs_of(scene([robot()], dict.fromkeys(names, HERE), after=after, controls=controls))
    }


def test_jobs_keep_the_missions_order_where_they_may():
    assert list(jobs("abc", [("c", "a")])) == ["b", "c", "a"]


def test_control_tasks_dissolve_into_who_waits_for_whom():
    found = jobs("abcd", [("a", "f"), ("f", "b"), ("f", "c"), ("b", "j"), ("c", "j"), ("j", "d")], "f", "j")
    assert {name: job.after for name, job in found.items()} == {
        "a": (),
        "b": ("a",),
        "c": ("a",),
        "d": ("b", "c"),
    }


def test_a_join_straight_after_a_fork_passes_on_what_came_before():
    found = jobs("ab", [("a", "f"), ("f", "j"), ("j", "b")], "f", "j")
    assert found["b"].after == ("a",)


def test_a_choice_gathers_all_up_to_where_its_arms_meet():
    found = jobs(
        "abcde",
        [("f", "a", "x"), ("a", "b"), ("f", "c"), ("b", "j"), ("c", "j"), ("j", "d"), ("e", "f")],
        "f",
        "j",
    )
    assert found["f"].choice == Choice("f", (("x", ("a", "b")), (None, ("c",))))
    assert found["f"].after == ("e",)
    assert found["d"].after == ("f",)
    assert set(found) == {"e", "f", "d"}


def test_a_choice_within_an_arm_is_an_item_of_it():
    after = [
        ("f", "a", "x"),
        ("a", "g"),
        ("g", "b", "y"),
        ("g", "k"),
        ("b", "k"),
        ("k", "j"),
        ("f", "c"),
        ("c", "j"),
    ]
    found = jobs("abc", after, "fg", "jk")
    assert found["f"].choice == Choice(
        "f", (("x", ("a", Choice("g", (("y", ("b",)), (None, ()))))), (None, ("c",)))
    )
    assert list(found) == ["f"]


def test_what_an_arm_waits_for_outside_is_waited_for_before_the_choice():
    found = jobs("abc", [("f", "a", "x"), ("f", "b"), ("c", "a")], "f")
    assert found["f"].after == ("c",)


def test_a_circle_is_named():
    with pytest.raises(InfeasibleError, match=r"in a circle: (a → b → c → a|b → c → a → b|c → a → b → c)$"):
        jobs("abc", [("a", "b"), ("b", "c"), ("c", "a")])


def test_a_condition_elsewhere_than_after_a_fork_is_refused():
    with pytest.raises(InfeasibleError, match="task 'a' has a condition"):
        jobs("ab", [("a", "b", "x")])


def test_two_else_arms_are_refused():
    with pytest.raises(InfeasibleError, match="fork 'f' has 2 outgoing dependencies without a condition"):
        jobs("abc", [("f", "a", "x"), ("f", "b"), ("f", "c")], "f")
