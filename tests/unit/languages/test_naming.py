"""Names that people can read."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.languages.naming import unreadable

NAMES = st.text(max_size=12)


@pytest.mark.parametrize(
    "name",
    [
        "visit",
        "cliché",
        "पर्यावरण",
        "پایگاه\u200cها",
        "👨\u200d👩\u200d👧",
        "\U0001f3f4\U000e0067\U000e0062\U000e0065\U000e006e\U000e0067\U000e007f",
        "N\u00a05",
        "שדה\u200f 5",
    ],
)
def test_names_of_any_script_with_joiners_and_emoji_are_read(name):
    assert unreadable(name) == ""


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("a\tb", "U+0009"),
        ("a\nb", "U+000A"),
        ("a\x85b", "U+0085"),
        ("a\u2028b", "U+2028"),
        ("a\u2029b", "U+2029"),
        ("a\u202eb", "U+202E"),
        ("a\u2066b", "U+2066"),
    ],
)
def test_what_breaks_lines_or_turns_text_round_is_not_read(name, code):
    assert unreadable(name) == f"holds the character {code}"


@pytest.mark.parametrize("name", ["", " ", "\u00a0", "\u200d\u200b"])
def test_a_name_with_nothing_to_see_is_blank(name):
    assert unreadable(name) == "is blank"


@given(NAMES, NAMES)
def test_readable_names_put_together_are_readable(task, robot):
    whole = unreadable(f"{task} ended by {robot}")
    assert bool(whole) == any("holds" in unreadable(each) for each in (task, robot))
