"""What is written by name says the same as what is written by path."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import descendants, held, metaclass_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.references.by_name import ReferenceNames
from mmrs_core.languages.references.spelling import one_of_many, references_in, spelt
from mmrs_core.languages.writing import to_json, to_xmi
from mmrs_core.testing.instances import instances_of

RELAXED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
ODD = ("a", "b", "a b", "b  a", "'", "'a'", "it's", "a' b", "/", "//@animals.0", "#a", "a#b", "x y#a", " a",
       "a:b", "x\ny", "x\ty", "é\u00a0ü", "k1", "")  # fmt: skip
NAMES = st.sampled_from(ODD) | st.text(st.sampled_from("ab '/#:.@\n"), max_size=6)


ROOTS = (
    ("urn:test:zoo", "Zoo"),
    ("urn:mmrs:mission:1.0", "Mission"),
    ("urn:mmrs:behaviour:1.0", "Behaviour"),
)


def models(registry):
    """Draw models whose texts are few and strange, so that many elements have one name."""
    values = {(ECORE, "EString"): st.sampled_from(("a", "b")) | NAMES}
    whole = [(package.ns_uri, "") for package in registry.packages if package.ns_uri != ECORE]
    return st.sampled_from((*ROOTS, *ROOTS, *whole)).flatmap(
        lambda root: instances_of(registry, *root, values=values)
    )


def references(root):
    """Return how many references a model has that do not contain and that files hold."""
    features = [
        (element, feature)
        for element in (root, *descendants(root))
        for feature in metaclass_of(element).features
        if feature.stored and feature.is_reference and not (feature.containment or feature.is_container)
    ]
    return sum(len(held(element, feature)) for element, feature in features)


@RELAXED
@given(data=st.data(), write=st.sampled_from([to_xmi, to_json]))
def test_names_lead_where_paths_lead(registry, data, write):
    root = data.draw(models(registry))
    names = ReferenceNames([root])
    text = write([root], registry, names=names)
    again = read_text(text, f"again.{write.__name__[3:]}", registry)
    assert again.diagnostics == ()
    assert write(again.roots, registry) == write([root], registry)
    assert write(again.roots, registry, names=ReferenceNames(again.roots)) == text
    assert names.named + names.left.total() <= references(root)


@given(names=st.lists(NAMES))
def test_names_in_a_list_are_read_as_they_are(names):
    text = " ".join(spelt(name, many=True) for name in names)
    assert list(references_in(text, many=True)) == names


@given(name=NAMES)
def test_a_name_alone_is_read_as_it_is(name):
    for many, text in ((False, spelt(name, many=False)), (True, one_of_many(spelt(name, many=False)))):
        assert list(references_in(text, many)) == [name]
