from __future__ import annotations

from datetime import UTC, datetime
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.datatypes import parse_real, render_real
from mmrs_core.languages.ecore_api.bridge import from_pyecore, to_pyecore
from mmrs_core.languages.element import contents, held, metaclass_of
from mmrs_core.languages.metaclass import Enumeration
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.writing import to_xmi

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").rglob("*.xmi"))
RELAXED = settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)

TEXTS = st.text(
    st.characters(
        codec="utf-8",
        exclude_categories=("Cs",),
        exclude_characters=[chr(code) for code in (*range(9), 11, 12, *range(14, 32), 0xFFFE, 0xFFFF)],
    ),
    max_size=12,
)
VALUES = {
    str: TEXTS,
    float: st.floats(allow_nan=False, allow_infinity=False),
    int: st.integers(-128, 127),
    bool: st.booleans(),
    bytes: st.binary(max_size=4),
    Decimal: st.decimals(allow_nan=False, allow_infinity=False, places=3),
    datetime: st.datetimes(datetime(1970, 1, 2), datetime(2100, 1, 1)).map(
        lambda date: date.replace(microsecond=date.microsecond // 1000 * 1000, tzinfo=UTC, fold=0)
    ),
}


@st.composite
def models(draw, registry, kinds=lambda metaclass: True):
    """A random tree with random references inside it; identifiers are left out, since they must differ."""
    usable = [
        metaclass
        for package in registry.packages
        for metaclass in package.metaclasses
        if metaclass.implementation and kinds(metaclass)
    ]
    elements = []

    def tree(metaclass, depth):
        element = metaclass.interface()
        elements.append(element)
        for feature in metaclass.features:
            if feature.containment and depth < 2:
                choices = [kind for kind in usable if feature.type.key in kind.ancestry]
                count = draw(st.integers(0, 2 if feature.many else 1)) if choices else 0
                made = [tree(draw(st.sampled_from(choices)), depth + 1) for _ in range(count)]
                setattr(element, feature.attribute, made if feature.many else made[0] if made else None)
            elif not feature.is_reference and not feature.is_id and feature.stored and draw(st.booleans()):
                setattr(element, feature.attribute, draw(values(feature)))
        return element

    root = tree(draw(st.sampled_from(usable)), 0)
    for element in elements:
        for feature in metaclass_of(element).features:
            targets = [target for target in elements if feature.is_reference and feature.type.accepts(target)]
            if targets and not feature.containment and not feature.is_container and draw(st.booleans()):
                chosen = draw(st.lists(st.sampled_from(targets), unique_by=id, max_size=2))
                setattr(element, feature.attribute, chosen if feature.many else (chosen or [None])[0])
    return root


def values(feature):
    kind = feature.type
    if isinstance(kind, Enumeration):
        single = st.sampled_from(kind.names)
    elif kind.name == "EChar":
        single = st.characters(max_codepoint=0x7E, min_codepoint=0x20)
    else:
        single = VALUES[kind.python]
    return st.lists(single, max_size=3, unique=feature.unique) if feature.many else single


def picture(element):
    """Return all that a model says, as plain data, for comparing."""
    numbers = {id(element): 0}
    pending = [element]
    ordered = []
    while pending:
        current = pending.pop()
        ordered.append(current)
        for inner in contents(current):
            numbers[id(inner)] = len(numbers)
            pending.append(inner)
    return [
        (
            metaclass_of(each).key,
            [
                (feature.name, [numbers.get(id(value), repr(value)) for value in held(each, feature)])
                for feature in metaclass_of(each).features
                if feature.stored
            ],
        )
        for each in ordered
    ]


def reading_gives_back_what_was_written(registry, data):
    root = data.draw(models(registry))
    text = to_xmi([root], registry)
    again = read_text(text, "again.xmi", registry)
    assert again.diagnostics == ()
    assert says(again.roots[0]) == says(root)
    assert to_xmi(again.roots, registry) == text


@RELAXED
@given(data=st.data())
def test_reading_gives_back_what_was_written(registry, data):
    reading_gives_back_what_was_written(registry, data)


@pytest.mark.thorough
@settings(RELAXED, max_examples=1500)
@given(data=st.data())
def test_reading_gives_back_what_was_written_in_many_models(registry, data):
    reading_gives_back_what_was_written(registry, data)


def says(root):
    """Return the picture without what only repeats a default, which files leave out."""
    return [
        (key, [(name, values) for name, values in features if values])
        for key, features in picture(without_defaults(root))
    ]


def without_defaults(root):
    pending = [root]
    while pending:
        element = pending.pop()
        pending.extend(contents(element))
        for feature in metaclass_of(element).features:
            if not feature.is_reference and not feature.many and not feature.unsettable:
                value = held(element, feature)
                if value and repr(value[0]) == repr(feature.default):
                    type(element)._mmrs_slots[feature.attribute].__delete__(element)
    return root


@RELAXED
@given(data=st.data())
def test_pyecore_gives_back_what_it_was_given(registry, data):
    root = data.draw(models(registry, kinds=lambda metaclass: metaclass.name != "Odd"))
    back = from_pyecore(to_pyecore(Model("m", (root,)), registry), registry)
    assert to_xmi(back.roots, registry) == to_xmi([root], registry)


@RELAXED
@given(data=st.data())
def test_what_conforms_in_memory_conforms_when_read(registry, data):
    root = data.draw(models(registry))
    before = [fault.message for fault in check_conformance(Model("m", (root,)), registry)]
    again = read_text(to_xmi([root], registry), "again.xmi", registry)
    assert sorted(fault.message for fault in check_conformance(again, registry)) == sorted(before)


@given(st.floats())
def test_every_real_number_survives_as_text(number):
    assert repr(parse_real(render_real(number))) == repr(number)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: "/".join(path.parts[-3:]))
def test_every_example_survives_both_round_trips(registry, example):
    model = read_model(example, registry, root=example.parents[1])
    assert model.diagnostics == ()
    assert check_conformance(model, registry) == ()
    text = to_xmi(model.roots, registry, file=example)
    assert to_xmi(read_text(text, "again.xmi", registry).roots, registry) == text
    back = from_pyecore(to_pyecore(model, registry), registry)
    assert to_xmi(back.roots, registry) == text


def test_there_are_examples_to_test():
    assert len(EXAMPLES) > 10
