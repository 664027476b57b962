"""A model means the same in whichever form it was written; and no file, however odd, breaks the migration."""

from random import Random

import pytest
from counts import many
from dialect_models import as_json, as_xmi, random_model
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

ROUNDS = settings(
    deadline=None,
    suppress_health_check=[
        HealthCheck.function_scoped_fixture,
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
    ],
    derandomize=True,
)
ROOTS = ("mission.Mission", "context.Context", "drone.Drone", "behaviour.Behaviour")


@pytest.fixture(scope="module")
def forms(mapping):
    """Return a function that writes a random model in every form, by its seed."""
    uris = {package: spelled[0] for package, spelled in mapping.dialect.uris.items()}

    def write(seed):
        random = Random(seed)
        model = random_model(random, mapping.structure, random.choice(ROOTS))
        spelled = (as_json(model, uris, spelling) for spelling in ("prefix", "uri", "file"))
        return as_xmi(model, uris), *spelled

    return write


@ROUNDS
@given(seed=st.integers(0, 2**32))
def test_every_form_of_a_model_becomes_the_same(said, forms, seed):
    found = [said("a.txt", text) for text in forms(seed)]
    assert found[0][2] == [""]
    for each in found[1:]:
        assert each[0] == found[0][0]
        assert sorted(map(str, each[1])) == sorted(map(str, found[0][1]))


FILES = (
    "orchard-mission.json",
    "orchard-context.json",
    "round.json",
    "drones.json",
    "round.xmi",
    "Heron.xmi",
)
ODD = (
    b"",
    b"\0",
    b"{",
    b"]",
    b'"',
    b"<",
    b"/",
    b"9" * 400,
    b"null",
    b"\xff",
    b"//@drones.7",
    b"-0",
    b"&#0;",
    b"1e999",
)


@settings(ROUNDS, max_examples=many(5000))
@given(data=st.data())
def test_a_damaged_file_is_migrated_or_told(said, flyaq, data):
    text = (flyaq / data.draw(st.sampled_from(FILES))).read_bytes()
    for _ in range(data.draw(st.integers(1, 4))):
        begin = data.draw(st.integers(0, len(text)))
        end = min(len(text), begin + data.draw(st.integers(0, 12)))
        middle = data.draw(st.sampled_from(ODD) | st.binary(max_size=4) | st.just(text[end : end + 30]))
        text = text[:begin] + middle + text[end:]
    models_found, _, faults = said("a.txt", text)
    assert faults[0] or models_found or said("a.txt", text)[1]
