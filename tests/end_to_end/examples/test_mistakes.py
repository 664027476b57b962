"""Mistakes that an operator might make in an example, and what he is told."""

import shutil

import pytest

from mmrs_core import pipeline
from mmrs_core.errors import InfeasibleError, InvalidModelError

pytestmark = pytest.mark.together("examples")

MISTAKES = [
    ("carbon-dioxide", "mission.xmi", 'altitude="15.0" grid', 'altitude="150.0" grid', "MUL009"),
    ("carbon-dioxide", "mission.xmi", "gridResolution=", 'footprintWidth="5.0" gridResolution=', "SUR001"),
    ("carbon-dioxide", "mission.xmi", '"SampleGas"', '"Sniff"', "MML064"),
    ("carbon-dioxide", "mission.xmi", 'key="seconds"', 'key="minutes"', "SUR014"),
    ("carbon-dioxide", "context.xmi", 'windSpeed="3.5"', 'windSpeed="12.0"', "MUL008"),
    ("carbon-dioxide", "robots/quad-650.xmi", 'propellers="4"', 'propellers="2"', "MUL004"),
    ("pool", "mission.xmi", 'depth="3.0"', 'depth="90.0"', "AUV004"),
    ("pool", "mission.xmi", 'deviceId="bottom-camera" ', "", "SUR009"),
    ("pool", "robots/pool-auv.xmi", 'maxThrust="35.0"', 'maxThrust="3.5"', "AUV005"),
    ("pool", "robots/pool-auv.xmi", 'id="T2"', 'id="T1"', "AUV003"),
]


@pytest.fixture
def changed(folder_of, tmp_path):
    """Return a copy of an example in which the first text of a file is replaced by the second."""

    def change(name, file, before, after):
        shutil.copytree(folder_of(name), tmp_path / name)
        path = tmp_path / name / file
        text = path.read_text(encoding="utf-8")
        assert before in text
        path.write_text(text.replace(before, after), encoding="utf-8")
        return tmp_path / name

    return change


@pytest.mark.parametrize(
    ("name", "file", "before", "after", "code"), MISTAKES, ids=lambda value: str(value)[:20]
)
def test_a_mistake_is_reported_with_file_line_and_hint(
    changed, contributions, name, file, before, after, code
):
    with pytest.raises(InvalidModelError) as refused:
        pipeline.valid_models(changed(name, file, before, after), contributions)
    faults = [fault for fault in refused.value.diagnostics if fault.code == code]
    assert faults
    assert all(fault.place.file.endswith(".xmi") and fault.place.line > 1 and fault.hint for fault in faults)


def test_a_reserve_that_leaves_nothing_is_refused_with_what_is_short(changed, contributions):
    folder = changed("drone-and-rover", "mission.xmi", 'reserve="0.25"', 'reserve="0.99"')
    models, _ = pipeline.valid_models(folder, contributions)
    scene = pipeline.expand(pipeline.ground(models), contributions)
    with pytest.raises(InfeasibleError) as refused:
        pipeline.plan(scene)
    assert refused.value.reasons
    assert any(name in reason for reason in refused.value.reasons for name in ("Kestrel", "Badger"))


def test_homes_inside_a_no_fly_area_are_refused_with_its_name(changed, contributions):
    nearer, wider = 'name="school" safetyDistance="10.0"', 'name="school" safetyDistance="300.0"'
    folder = changed("carbon-dioxide", "context.xmi", nearer, wider)
    with pytest.raises(InvalidModelError) as refused:
        pipeline.valid_models(folder, contributions)
    assert any("school" in fault.message for fault in refused.value.diagnostics)
