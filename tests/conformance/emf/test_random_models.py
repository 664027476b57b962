"""Random models, made by EMF for us and by us for EMF."""

import shutil
from collections import Counter
from functools import cache

import pytest
from emf_description import model_lines
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from mmrs_core.diagnostics import Severity
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import descendants, metaclass_of
from mmrs_core.languages.metamodels.export import export_metamodels, schema_locations
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import write_model
from mmrs_core.languages.xmi import quick_reader, quick_writer
from mmrs_core.testing.instances import drafts_of, instances_of
from mmrs_core.testing.strategies import WORDS

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]

SEED = 20261121
COUNTS = [pytest.param(100), pytest.param(1000, marks=pytest.mark.thorough)]
VALUES = {  # of types that we keep as texts
    ("urn:test:suite", "Foreign"): WORDS,
    ("urn:test:zoo", "Colour"): WORDS,
}
UNCHECKED = ("urn:test:suite", "urn:test:parts")
"""Of these, EMF checks the keys of map entries as well."""
RANDOM = settings(deadline=None, database=None, phases=[Phase.generate], suppress_health_check=[*HealthCheck])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("models")


@pytest.fixture(autouse=True)
def compiled_early(monkeypatch):
    """Have small models go through the compiled readers and writers of large ones as well."""
    monkeypatch.setattr(quick_reader, "_OFTEN", 2)
    monkeypatch.setattr(quick_writer, "_OFTEN", 2)


@pytest.fixture(scope="module")
def exported_folder(registry, tmp_path_factory):
    folder = tmp_path_factory.mktemp("metamodels")
    export_metamodels(registry, folder)
    return folder


@pytest.mark.parametrize("count", COUNTS)
def test_what_emf_writes_we_read_and_write_back_equal(referee, registry, tmp_path, tell, count):
    made, lost = [], 0
    theirs, ours = tmp_path / "theirs", tmp_path / "ours"
    theirs.mkdir()
    for number in range(count):
        answer = referee.ask("make", SEED + number, theirs, f"model{number}")
        assert answer.faults == []
        made += answer.all("MADE")
        lost += len(answer.all("LOST"))
    assert lost < 0.1 * len(made)  # what EMF itself cannot read again
    shutil.copytree(theirs, ours)
    kinds = Counter()
    for name in made:
        model = read_model(ours / name, registry)
        assert [fault for fault in model.diagnostics if fault.severity is Severity.ERROR] == []
        assert list(model_lines(model.roots, name)) == described(referee, theirs / name)
        kinds.update(metaclass_of(element).key for element in model.elements())
    for name in made:
        write_model(read_model(ours / name, registry).roots, ours / name, registry)
    different = [
        name for name in made if "EQUAL" not in referee.ask("equal", theirs / name, ours / name).lines
    ]
    assert different == []
    assert len(kinds) > 0.9 * concrete(registry)
    tell(
        f"EMF to us: {len(made)} files of {kinds.total()} elements of {len(kinds)} classes read, found the "
        f"same to the bit, written back, found equal by EMF; {lost} more that EMF itself cannot read again "
        f"(seeds {SEED} to {SEED + count - 1})"
    )


def concrete(registry):
    return sum(
        kind.implementation is not None for package in registry.packages for kind in package.metaclasses
    )


@pytest.mark.parametrize("count", COUNTS)
def test_what_we_write_emf_reads_without_a_word_and_finds_equal(
    referee, registry, folder, exported_folder, tell, count
):
    elements = Counter()

    @seed(SEED)
    @settings(RANDOM, max_examples=count)
    @given(data=st.data())
    def check(data):
        root = data.draw(instance(registry))
        for file, places in ((folder / "plain.xmi", None), (folder / "located.xmi", exported_folder)):
            locations = places and schema_locations(registry, places, file)
            write_model([root], file, registry, schema_location=locations)
        assert described(referee, folder / "plain.xmi") == list(model_lines([root], "plain.xmi"))
        assert described(referee, folder / "located.xmi", "alone") == list(model_lines([root], "located.xmi"))
        elements.update(metaclass_of(element).key for element in (root, *descendants(root)))

    check()
    tell(
        f"us to EMF: {count} files of {elements.total()} elements of {len(elements)} classes, read by EMF "
        f"without a warning, registered and by schema location alone, and found the same to the bit "
        f"(seed {SEED})"
    )


@pytest.mark.parametrize("count", COUNTS)
def test_emf_and_we_miss_values_in_the_same_models(referee, registry, folder, tell, count):
    verdicts = Counter()
    languages = [each.ns_uri for each in registry.packages if not each.ns_uri.startswith(UNCHECKED)]

    @seed(SEED)
    @settings(RANDOM, max_examples=count)
    @given(data=st.data())
    def check(data):
        ns_uri = data.draw(st.sampled_from(languages))
        drawn = drafts(registry, ns_uri) if data.draw(st.booleans()) else instances(registry, ns_uri)
        write_model([data.draw(drawn)], folder / "draft.xmi", registry)
        model = read_model(folder / "draft.xmi", registry)
        ours = (*model.diagnostics, *check_conformance(model, registry))
        theirs = referee.ask("check", folder / "draft.xmi").faults
        assert bool(ours) == bool(theirs), (ours, theirs)
        verdicts["refused" if ours else "accepted"] += 1

    check()
    assert min(verdicts.values()) > count // 10
    tell(
        f"both: {verdicts['accepted']} models accepted and {verdicts['refused']} refused by EMF's "
        f"Diagnostician and by us alike (seed {SEED})"
    )


def described(referee, file, *how):
    """Return what EMF finds in a file, which must be without fault."""
    judged, *lines = referee.ask(*how, "dump", file).lines
    assert judged == f"JUDGED {file.name}"
    return lines


@st.composite
def instance(draw, registry):
    return draw(instances(registry, draw(st.sampled_from([each.ns_uri for each in registry.packages]))))


@cache
def drafts(registry, ns_uri):
    return drafts_of(registry, ns_uri, values=VALUES)


@cache
def instances(registry, ns_uri):
    return instances_of(registry, ns_uri, values=VALUES)
