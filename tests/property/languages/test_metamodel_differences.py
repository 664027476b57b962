"""Where a comparison of metamodels says that old models load, they do."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from metamodel_edits import EDITS, ZOO, edited

from mmrs_core.diagnostics import has_errors
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.evolution.differences import differences
from mmrs_core.languages.evolution.effects import Effect
from mmrs_core.languages.evolution.versions import version_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import core_registry
from mmrs_core.languages.writing import to_xmi
from mmrs_core.testing.instances import instances_of

HARMLESS = [name for name, (_, _, verdict) in EDITS.items() if verdict != "incompatible"]
RELAXED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


@RELAXED
@given(data=st.data())
def test_old_models_load_where_that_is_said(tmp_path_factory, data):
    names = data.draw(st.lists(st.sampled_from(HARMLESS), min_size=1, max_size=3, unique=True))
    file = tmp_path_factory.getbasetemp() / "new.ecore"
    file.write_text(edited(*names), encoding="utf-8")
    old, new = version_of(str(ZOO), core_registry()), version_of(str(file), core_registry())
    if any(each.verdict is Effect.INCOMPATIBLE for each in differences(old, new)):
        return  # two edits of one part
    root = data.draw(instances_of(old.registry, "urn:test:zoo"))
    text = to_xmi([root], old.registry)
    model = read_text(text, "old.xmi", new.registry)
    assert not has_errors((*model.diagnostics, *check_conformance(model, new.registry)))
