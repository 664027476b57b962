"""The order in which faults are told."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.diagnostics import Diagnostic, Place, Severity, in_order


def fault(path="", line=1, severity=Severity.ERROR, message="is wrong", file="mission.xmi"):
    return Diagnostic("MML001", severity, message, Place(file, line, path))


def test_elements_on_one_line_are_told_as_they_are_counted():
    found = in_order([fault("/tasks[106]"), fault("/tasks[7]"), fault("/tasks[7]/shell[10]")])
    assert [each.place.path for each in found] == ["/tasks[7]", "/tasks[7]/shell[10]", "/tasks[106]"]


def test_names_in_messages_are_told_as_they_are_counted():
    found = in_order([fault(message="Fork 'f106': is wrong"), fault(message="Fork 'f7': is wrong")])
    assert [each.message[6:-11] for each in found] == ["f7", "f106"]


def test_errors_are_told_first_then_lines():
    late, early = fault(line=10), fault(line=9)
    warning = fault(line=1, severity=Severity.WARNING)
    assert in_order([warning, late, early, late]) == (early, late, warning)


@given(st.lists(st.text("ab019/[]", max_size=6)))
def test_any_paths_have_an_order(paths):
    found = [each.place.path for each in in_order([fault(path) for path in paths])]
    assert sorted(found) == sorted(set(paths))
    assert all(in_order([fault(b), fault(a)])[0].place.path == a for a, b in pairwise(found))


@given(st.integers(0, 10**30), st.integers(0, 10**30))
def test_figures_are_told_by_their_value(one, other):
    found = in_order([fault(f"/tasks[{one}]"), fault(f"/tasks[{other}]")])
    assert found[0].place.path == f"/tasks[{min(one, other)}]"


def test_a_fault_is_told_with_its_path_what_was_expected_and_a_hint():
    place = Place("m.xmi", 3, "/tasks[1]")
    told = str(Diagnostic("MML001", Severity.ERROR, "it is odd", place, "mend it", "it is even"))
    assert told.splitlines() == [
        "m.xmi:3: error: it is odd [MML001]",
        "    at: /tasks[1]",
        "    expected: it is even",
        "    hint: mend it",
    ]


def test_a_root_is_told_without_a_path():
    assert str(Diagnostic("MML001", Severity.NOTE, "odd", Place("m", 1, "/"))) == "m:1: note: odd [MML001]"
