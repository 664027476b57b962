import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_multicopter.testing import target_input, two_drones

from mmrs_core.contributions.targets import FileSpec, Target, TracedStep
from mmrs_core.errors import InternalError
from mmrs_core.generation.render import render
from mmrs_core.generation.tracing import MARK, Served, taken_out

A = TracedStep("item 1", "alpha", "a1", "photos", "by_hand")
B = TracedStep("item 2", "alpha", "a4")
HOME = TracedStep("home", "alpha", "")


@pytest.fixture
def traced(tmp_path):
    """Return a function that renders a template, and gives the text and the trace of the manifest."""

    def made(template, declared=(), **view):
        (tmp_path / "t.jinja").write_text(template, "utf-8")
        spec = FileSpec("t.txt", "t.jinja", view, trace=declared)
        target = Target("t", "a test", tmp_path, lambda given: [spec], lambda given: [])
        file, manifest = render(target, target_input(two_drones()))
        return file.content.decode(), json.loads(manifest.content)["trace"]

    return made


def lines(trace):
    return [(entry["step"], entry["lines"]) for entry in trace]


def test_a_step_has_the_lines_that_the_tag_surrounds(traced):
    text, trace = traced("head\n{% serves a %}\none\ntwo\n{% endserves %}\ntail\n", a=A)
    assert text == "head\none\ntwo\ntail\n"
    assert lines(trace) == [("item 1", [2, 3])]


def test_a_tag_within_a_line_counts_that_line(traced):
    text, trace = traced("head\n<{% serves a %}x{% endserves %}>\n", a=A)
    assert text == "head\n<x>\n"
    assert lines(trace) == [("item 1", [2, 2])]


def test_steps_in_a_loop_have_a_line_each(traced):
    template = "{% for s in steps %}\n{% serves s %}\n{{ s.move | py }}{% if not loop.last %},{% endif %}\n\n"
    text, trace = traced(template + "{% endserves %}\n{% endfor %}\n", steps=[A, B])
    assert text == '"a1",\n"a4"\n'
    assert lines(trace) == [("item 1", [1, 1]), ("item 2", [2, 2])]


def test_a_tag_within_another_serves_both(traced):
    _, trace = traced("{% serves h %}\n1\n{% serves a %}\n2\n{% endserves %}\n{% endserves %}\n", h=HOME, a=A)
    assert lines(trace) == [("home", [1, 2]), ("item 1", [2, 2])]


def test_a_tag_takes_several_steps(traced):
    _, trace = traced("{% serves every %}\nx\n{% endserves %}\n", every=[A, B])
    assert lines(trace) == [("item 1", [1, 1]), ("item 2", [1, 1])]


def test_a_tag_on_something_else_is_an_error(traced):
    with pytest.raises(InternalError, match="takes a TracedStep"):
        traced("{% serves 3 %}x{% endserves %}")


def test_a_declared_step_that_no_tag_marks_has_no_lines(traced):
    _, trace = traced("{% serves a %}x{% endserves %}", declared=(A, B), a=A)
    assert lines(trace) == [("item 1", [1, 1]), ("item 2", None)]


def test_the_behaviour_says_what_comes_after_a_move_and_what_it_sets(traced):
    _, trace = traced("{% serves steps %}x{% endserves %}", steps=[B, TracedStep("s", "beta", "b1")])
    assert (trace[0]["then"], trace[0]["sets"]) == (["back"], ["beta.go"])
    assert (trace[1]["then"], trace[1]["waits"]) == (["b2"], ["go"])


@given(st.text(alphabet=f"{MARK};[]1ab\n", max_size=20))
def test_no_value_forges_a_mark(value):
    text = f"1\n{MARK}[];{value.replace(MARK, MARK + MARK)}{MARK};"
    assert taken_out(text) == ("1\n" + value, ())


@given(st.text(alphabet="x\n", max_size=20), st.text(alphabet="y\n", max_size=20))
def test_lines_are_those_of_the_text_without_marks(before, body):
    step = json.dumps([("s", "r", "m", "", "")])
    text, (served,) = taken_out(f"{before}{MARK}{step};{body}{MARK};end")
    first = before.count("\n") + 1
    assert text == before + body + "end"
    assert served == Served(TracedStep("s", "r", "m"), first, served.last)
    whole = body.count("\n") + 1 - ((before + body).endswith("\n") and body != "")
    assert served.last == first + max(0, whole - 1)
