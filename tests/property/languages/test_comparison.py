"""Two models have no changes between them if and only if they are written alike."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.languages.comparison.changes import changes_between
from mmrs_core.languages.element import descendants, held, metaclass_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_xmi
from mmrs_core.testing.instances import instances_of
from mmrs_core.testing.strategies import values_of

LANGUAGES = ("urn:mmrs:mission:1.0", "urn:mmrs:robot:1.0", "urn:mmrs:behaviour:1.0", "urn:test:zoo")
RELAXED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def edit(data, root):
    """Change something in a model, or nothing: a value, the order of a list, or what a list holds."""
    element = data.draw(st.sampled_from([root, *descendants(root)]))
    features = [f for f in metaclass_of(element).features if f.stored and not f.is_container]
    if not features:
        return
    feature = data.draw(st.sampled_from(features))
    values = list(held(element, feature))
    if feature.many and values:
        kept = data.draw(st.permutations(values)) if data.draw(st.booleans()) else values[1:]
        setattr(element, feature.attribute, kept)
    elif not feature.is_reference and not feature.is_id:
        setattr(element, feature.attribute, data.draw(values_of(feature, None)))


@pytest.mark.thorough
@RELAXED
@given(data=st.data())
def test_changes_are_told_if_there_are_any(registry, data):
    drawn = data.draw(st.sampled_from(LANGUAGES).flatmap(lambda ns_uri: instances_of(registry, ns_uri)))
    text = to_xmi([drawn], registry)
    one, other = (read_text(text, "a.xmi", registry).roots for _ in range(2))
    assert changes_between(one, other) == ()
    edit(data, other[0])
    try:
        differs = to_xmi(other, registry) != text
    except ValueError:  # what others refer to is gone, or a text no XML can hold
        return
    assert bool(changes_between(one, other)) == differs
    assert bool(changes_between(other, one)) == differs
