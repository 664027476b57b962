"""A mapping file with mistakes in it is refused, or it is one: no model breaks what was accepted."""

import re

from counts import many
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mmrs_flyaq.migrate import migrate
from mmrs_flyaq.plugin import FLYAQ_2015
from mmrs_flyaq.rules.mapping_file import read_mapping

from mmrs_core.errors import UnreadableError

ROUNDS = settings(
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    derandomize=True,
    max_examples=many(3000),
)
FILES = (
    "orchard-mission.json",
    "orchard-context.json",
    "round.json",
    "round.xmi",
    "Heron.xmi",
    "drones.json",
)
RULES = FLYAQ_2015.read_text(encoding="utf-8")
BEGIN = RULES.index("[rules.")
VALUES = re.compile(r'"[^"\n]*"|\btrue\b|\bfalse\b|\b\d+(?:\.\d+)?\b')
WORDS = re.compile(r"\b[A-Za-z]\w*\b")
PLACES = [match.span() for pattern in (VALUES, WORDS) for match in pattern.finditer(RULES, BEGIN)]
OTHERS = sorted(
    {RULES[begin:end] for begin, end in PLACES} | {'""', "[]", "{}", "nan", "-1", '"{x}"', '"a.b[0]"'}
)


@ROUNDS
@given(data=st.data())
def test_a_mapping_with_mistakes_is_refused_or_works(contributions, flyaq, tmp_path, data):
    text = RULES
    for _ in range(data.draw(st.integers(1, 3))):
        begin, end = data.draw(st.sampled_from(PLACES))
        text = text[:begin] + data.draw(st.sampled_from(OTHERS)) + text[end:]
    file = tmp_path / "m.toml"
    file.write_text(text, encoding="utf-8")
    try:
        mapping = read_mapping(file, contributions.languages)
    except UnreadableError:
        return
    migrate([flyaq / name for name in FILES], mapping, contributions.languages)
