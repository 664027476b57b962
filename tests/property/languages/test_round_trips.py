import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.datatypes import parse_real, render_real
from mmrs_core.languages.ecore_api.bridge import from_pyecore, to_pyecore
from mmrs_core.languages.element import contents, descendants, held, metaclass_of
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.writing import to_xmi
from mmrs_core.testing.instances import drafts_of, instances_of

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").rglob("*.xmi"))
RELAXED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def models(registry):
    """Draw elements of any class, half done or whole."""
    packages = st.sampled_from(registry.packages)
    whole = packages.flatmap(lambda package: instances_of(registry, package.ns_uri))
    return whole | packages.flatmap(lambda package: drafts_of(registry, package.ns_uri))


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


@RELAXED
@given(data=st.data())
def test_reading_gives_back_what_was_written(registry, data):
    root = data.draw(models(registry))
    text = to_xmi([root], registry)
    again = read_text(text, "again.xmi", registry)
    assert again.diagnostics == ()
    assert says(again.roots[0]) == says(root)
    assert to_xmi(again.roots, registry) == text


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
    root = data.draw(models(registry))
    assume(all(metaclass_of(each).name != "Odd" for each in (root, *descendants(root))))
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
def test_every_example_survives_both_round_trips(registry, example, tmp_path):
    place = tmp_path / "project"
    shutil.copytree(example.parents[1], place)
    copy = place / example.relative_to(example.parents[1])
    model = read_model(copy, registry, root=place)
    assert model.diagnostics == ()
    assert check_conformance(model, registry) == ()
    text = to_xmi(model.roots, registry, file=copy)
    copy.write_bytes(text)
    assert to_xmi(read_model(copy, registry, root=place).roots, registry, file=copy) == text
    if not model.linked:  # pyecore's objects do not say which file they stand in
        back = from_pyecore(to_pyecore(model, registry), registry)
        assert to_xmi(back.roots, registry) == text


def test_there_are_examples_to_test():
    assert len(EXAMPLES) > 10
