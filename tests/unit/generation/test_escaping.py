import ast
import io
import keyword
import tokenize
from math import inf, nan

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mmrs_core.generation.escaping import (
    Call,
    cell,
    comment,
    file_stems,
    identifier,
    json_literal,
    name,
    python_lines,
    python_literal,
)

HOSTILE = [
    '"; import os',
    "a\nb",
    "*/",
    "${x}",
    "{{7*7}}",
    "\\u000a",
    "\u202eabc",
    "class",
    "",
    "'''",
    '"""',
    "\x00",
]
texts = st.text(st.characters(exclude_categories=()), max_size=40)
plain = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | texts,
    lambda inner: st.lists(inner, max_size=3).map(tuple),
    max_leaves=6,
)


@given(plain)
def test_a_python_literal_evaluates_to_its_value(value):
    assert ast.literal_eval(python_literal(value)) == value


@given(texts)
def test_a_python_literal_is_one_line_that_can_be_read(text):
    literal = python_literal(text)
    assert literal.isprintable()
    assert len(literal.splitlines()) == 1


def test_names_stay_as_people_write_them():
    assert python_literal("Ärger") == '"Ärger"'
    assert comment("Bucht \u202eÄrger") == "Bucht /u202eÄrger"


@pytest.mark.parametrize("number", [inf, -inf, nan])
def test_a_number_that_is_not_finite_has_no_literal(number):
    with pytest.raises(ValueError, match="not finite"):
        python_literal(number)


def test_an_object_has_no_literal():
    with pytest.raises(ValueError, match="not a plain value"):
        python_literal(object())


def test_a_call_is_written_with_its_arguments():
    inner = Call("Local", (1.0, "a'b"))
    assert python_literal(Call("GoTo", (inner,), (("speed", 2.0),))) == 'GoTo(Local(1.0, "a\'b"), speed=2.0)'


@given(plain, st.integers(0, 100))
def test_a_value_laid_out_in_lines_is_still_the_value(value, indent):
    assert ast.literal_eval(python_lines(value, indent).strip()) == value


def test_lines_are_broken_only_where_they_are_too_long():
    short, long = ("a", "b"), tuple("abcdefghij" * 3)
    laid_out = python_lines(Call("f", (short,), (("g", long),)), 4)
    assert laid_out.splitlines()[:3] == ["f(", '        ("a", "b"),', "        g=("]


@given(texts)
def test_a_comment_stays_a_comment(text):
    source = f"# {comment(text)}\nx = 1\n"
    assert ast.dump(ast.parse(source)) == ast.dump(ast.parse("x = 1"))
    kinds = [token.type for token in tokenize.generate_tokens(io.StringIO(source).readline)]
    assert kinds.count(tokenize.COMMENT) == 1


@given(texts)
def test_a_comment_ends_no_docstring(text):
    source = f'"""About {comment(text)}."""\nx = 1\n'
    module = ast.parse(source)
    assert len(module.body) == 2


@given(texts)
@example("*\n")
@example("*\\")
def test_a_comment_ends_no_block_comment(text):
    assert "*/" not in comment(text)


@given(st.lists(texts, unique=True, max_size=12))
def test_identifiers_are_injective(names):
    made = [identifier(each) for each in names]
    assert len(set(made)) == len(names)
    assert all(each.isidentifier() and each.isascii() and not keyword.iskeyword(each) for each in made)


def test_an_identifier_that_looks_digested_is_digested_again():
    forged = identifier("a b")[2:]
    assert identifier(forged) != identifier("a b")


@given(st.lists(texts | st.sampled_from(["a", "A", "a_", "drone-1", "Drone-1"]), unique=True, max_size=12))
def test_file_stems_differ_even_where_case_is_ignored(names):
    stems = file_stems(names)
    assert list(stems) == names
    assert len({stem.casefold() for stem in stems.values()}) == len(names)
    assert all(
        stem and set(stem) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")
        for stem in stems.values()
    )


def test_plain_names_are_their_own_file_stems():
    assert file_stems(["alpha", "drone-1"]) == {"alpha": "alpha", "drone-1": "drone-1"}


def test_a_name_that_imitates_the_digest_of_another_gets_its_own_stem():
    stem = file_stems(["a b"])["a b"]
    stems = file_stems(["a b", stem])
    assert len(set(stems.values())) == 2


@pytest.mark.parametrize("text", [*HOSTILE, "a b", "1a", "a-b"])
def test_only_names_of_our_own_are_written_as_they_are(text):
    if text == "class":
        assert name(text) == "class"
        return
    with pytest.raises(ValueError, match="is not a name"):
        name(text)


@given(texts)
def test_a_cell_keeps_its_table(text):
    written = cell(text)
    assert "\n" not in written
    assert "|" not in written.replace("\\|", "")
    assert "<" not in written.replace("\\<", "")


def test_json_refuses_numbers_that_are_not_finite():
    with pytest.raises(ValueError, match="JSON compliant"):
        json_literal({"a": nan})
