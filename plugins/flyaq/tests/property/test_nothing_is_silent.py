"""Whatever a source says shows: in the models that come of it, or in the report."""

import json
from copy import deepcopy

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

FILES = ("orchard-mission.json", "orchard-context.json", "round.json", "drones.json")
ROUNDS = settings(
    deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True
)


def places(value, path=()):
    """Yield the path of every value in JSON that is no container."""
    items = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    )
    if items is None:
        yield path
        return
    for key, inner in items:
        yield from places(inner, (*path, key))


def at(value, path):
    for key in path:
        value = value[key]
    return value


def changed(value):
    if isinstance(value, bool):
        return not value
    return value + 1 if isinstance(value, int | float) else f"{value}1"


def says(path):
    """Return whether a value is the model's own: no namespace, and not the class of what is pointed to."""
    return "@ns" not in path and not (path[-1] == "eClass" and path[-2:-1] in (("from",), ("to",), ("slot",)))


@pytest.fixture(scope="module")
def sources(flyaq):
    texts = {name: json.loads((flyaq / name).read_text()) for name in FILES}
    return {name: (text, [path for path in places(text) if says(path)]) for name, text in texts.items()}


def change(owner, key):
    owner[key] = changed(owner[key])


def leave_out(owner, key):
    del owner[key]


@ROUNDS
@given(data=st.data(), edit=st.sampled_from((change, leave_out)))
def test_a_changed_or_missing_value_shows(said, sources, flyaq, data, edit):
    name = data.draw(st.sampled_from(FILES))
    text, every = sources[name]
    # a class may be left out where the feature decides it
    path = data.draw(st.sampled_from([path for path in every if edit is change or path[-1] != "eClass"]))
    other = deepcopy(text)
    edit(at(other, path[:-1]), path[-1])
    heron = flyaq / "Heron.xmi"
    assert said("a.json", json.dumps(other), heron) != said("a.json", json.dumps(text), heron), path
