"""Compiled readers and writers do what the careful ones do, faults and messages included."""

import re
from contextlib import contextmanager

from counts import many
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Element, Unknown, held, metaclass_of, path_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_xmi
from mmrs_core.languages.xmi import quick_reader, quick_writer
from mmrs_core.languages.xmi.quick_writer import writer_for
from mmrs_core.languages.xmi.writer import XmiWriter
from mmrs_core.testing.instances import drafts_of

NEVER = 10**9
LANGUAGES = ("urn:mmrs:mission:1.0", "urn:mmrs:robot:1.0", "urn:mmrs:behaviour:1.0", "urn:test:zoo")
RELAXED = settings(
    deadline=None,
    max_examples=many(3000),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
JUNK = (
    *("", "x", "1_0", " 5 ", "5", "-0.0", "NaN", "nan", "inf", "1.5d", "1e400", "\u0663.5", "true", "True"),
    *("//@nope.3", "//@animals.0", "//@animals.0 //@animals.1", "//@animals.\u0661", "//@animals.-1", "/9"),
    *(
        "#//@robots.0",
        "//@robots.0/@moves.1",
        "//@keepers.00",
        "other.xmi#/",
        "a &amp; b",
        "&#10;",
        "is-hungry",
    ),
)
WORDS = (
    "name",
    "zoo",
    "target",
    "href",
    "xmi:id",
    "xsi:type",
    "xmi:type",
    "xsi:nil",
    "teeth",
    "bogus",
    "weight",
)


@contextmanager
def compiled_after(count):
    modules = quick_reader, quick_writer
    before = [module._OFTEN for module in modules]
    for module in modules:
        module._OFTEN = count
    try:
        yield
    finally:
        for module, often in zip(modules, before, strict=True):
            module._OFTEN = often


def read(text, registry, often):
    with compiled_after(often):
        try:
            model = read_text(text, "a.xmi", registry)
        except UnreadableError as refusal:
            return str(refusal)
    broken = {(path_of(element), element._mmrs_line, name) for element, name in model.broken}
    return model.diagnostics, broken, [described(element) for element in model.elements()]


def described(element):
    where = type(element).__name__, element._mmrs_line, path_of(element), element._mmrs_source.file
    if isinstance(element, Unknown):
        return *where, element._mmrs_xml, element._mmrs_type
    features = metaclass_of(element).features
    return *where, [[shown(value) for value in held(element, feature)] for feature in features]


def shown(value):
    return (path_of(value), value._mmrs_line) if isinstance(value, Element) else repr(value)


def written(writer):
    try:
        return writer.document({})
    except ValueError as fault:
        return str(fault)


@st.composite
def forests(draw, registry):
    """Several roots of one language, the same classes again and again; values may be of wrong types."""
    ns_uri = draw(st.sampled_from(LANGUAGES))
    roots = [draw(drafts_of(registry, ns_uri))]
    again = read_text(repeated(to_xmi(roots, registry).decode(), 3), "a.xmi", registry)
    elements = list(again.elements())
    for element in draw(st.lists(st.sampled_from(elements), max_size=2)):
        features = [each for each in metaclass_of(element).features if not each.linked and not each.many]
        if features:
            value = draw(st.sampled_from((None, 0, 3, True, -0.0, 1e9, "", 'a"<&\n', "a\x01", [], roots[0])))
            setattr(element, draw(st.sampled_from(features)).attribute, value)
    return again.roots


def repeated(text, times):
    """Return a document that holds the root of another several times."""
    declaration, _, root = text.partition("\n")
    wrapper = '<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI">'
    return f"{declaration}\n{wrapper}\n{root * times}</xmi:XMI>".encode()


@st.composite
def faulty_texts(draw, registry):
    """Texts of models with a few things put where they do not belong."""
    root = draw(drafts_of(registry, draw(st.sampled_from(LANGUAGES))))
    text = repeated(to_xmi([root], registry).decode(), draw(st.integers(2, 4))).decode()
    for _ in range(draw(st.integers(0, 3))):
        text = draw(st.sampled_from(EDITS))(draw, text)
    return text.encode()


def another_value(draw, text):
    return replaced(draw, text, r'"[^"<>]*"(?=[^<]*>)', f'"{draw(st.sampled_from(JUNK))}"')


def another_name(draw, text):
    return replaced(draw, text, r" [a-zA-Z]+=", f" {draw(st.sampled_from(WORDS))}=")


def no_type(draw, text):
    return replaced(draw, text, r' xsi:type="[^"]*"', "")


def type_at_the_end(draw, text):
    return replaced(draw, text, r'( xsi:type="[^"]*")([^>/]*)', r"\2\1")


def a_stray_text(draw, text):
    return replaced(draw, text, r">\n", ">\nstray")


def another_meaning_of_prefixes(draw, text):
    uri = draw(st.sampled_from(("urn:test:zoo", "urn:mmrs:behaviour:1.0", "urn:far")))
    return replaced(draw, text, r"(<[a-z][A-Za-z]*)", rf'\1 xmlns:zoo="{uri}" xmlns:behaviour="{uri}"')


def an_element_twice(draw, text):
    return replaced(draw, text, r"( *<[a-zA-Z]+ [^>]*/>\n)", r"\1\1")


EDITS = (
    another_value,
    another_name,
    no_type,
    type_at_the_end,
    a_stray_text,
    another_meaning_of_prefixes,
    an_element_twice,
)


def replaced(draw, text, pattern, by):
    found = list(re.finditer(pattern, text))
    if not found:
        return text
    match = draw(st.sampled_from(found))
    return f"{text[: match.start()]}{match.expand(by)}{text[match.end() :]}"


@RELAXED
@given(data=st.data())
def test_compiled_readers_read_what_the_careful_one_reads(registry, data):
    text = data.draw(faulty_texts(registry))
    assert read(text, registry, 1) == read(text, registry, NEVER)


@RELAXED
@given(data=st.data())
def test_compiled_writers_write_what_the_careful_one_writes(registry, data):
    roots = data.draw(forests(registry))
    with compiled_after(1):
        quickly = written(writer_for(roots, registry, None))
    assert quickly == written(XmiWriter(roots, registry, None))
