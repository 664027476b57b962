"""Figures in the file of a robot type."""

import pytest

from mmrs_core.errors import InvalidModelError, UnreadableError, UnsupportedError
from mmrs_core.languages.reading import read_model
from mmrs_core.resources import shipped
from mmrs_mavlink.calibration.figures import Figure
from mmrs_mavlink.calibration.type_file import type_in

QUAD = (shipped("examples") / "carbon-dioxide" / "robots" / "quad-650.xmi").read_bytes()
FIGURES = (
    Figure("maxAcceleration", "m/s²", "STEP", (2.4, 2.451, 2.5)),
    Figure("maxJerk", "m/s³", "STEP", (5.0,)),
    Figure("settlingTime", "s", "STEP", (-0.2, -0.1, 0.0)),
    Figure("maxJerk", "m/s³", "MISSION", (1.0,)),
    Figure("maxClimbRate", "m/s", "MISSION", (), "no upright leg"),
    Figure("maxTurnRate", "°/s", "", (52.0,)),
    Figure("meanPower", "W", "", (300.0,)),
    Figure("lifetime", "s", "", (2005.4,)),
)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "quad.xmi"
    path.write_bytes(QUAD)
    return path


@pytest.fixture(scope="module")
def languages(contributions):
    return contributions.languages


def capabilities(path, languages):
    model = read_model(path, languages)
    assert model.diagnostics == ()
    return model.roots[0].movementCapabilities


def test_figures_are_written_and_all_else_stays(file, languages):
    type_in(file, languages, 0.0).write(FIGURES)
    unloaded, loaded = capabilities(file, languages)
    assert (unloaded.lifetime, unloaded.maxTurnRate, unloaded.maxAcceleration) == (2010.0, 52.0, 3.0)
    step, mission = unloaded.legTimings
    assert (step.flownAs, step.maxAcceleration, step.maxJerk, step.settlingTime) == ("STEP", 2.45, 5.0, 0.0)
    assert (mission.flownAs, mission.maxJerk, mission.eIsSet("maxClimbRate")) == ("MISSION", 1.0, False)
    assert len(loaded.legTimings) == 0
    before, after = QUAD.splitlines(), file.read_bytes().splitlines()
    assert [line for line in before if line not in after] == [before[_line("<movementCapabilities")]]
    assert len(after) == len(before) + 2


def _line(start):
    return next(n for n, line in enumerate(QUAD.splitlines()) if line.strip().startswith(start.encode()))


def test_a_second_flight_replaces_the_figures_of_the_first(file, languages):
    type_in(file, languages, 0.0).write(FIGURES)
    first = file.read_bytes()
    given = type_in(file, languages, 0.0)
    assert (given.current("maxJerk", "STEP"), given.current("maxTurnRate")) == (5.0, 52.0)
    assert given.current("cornerRadius", "MISSION") is None
    given.write(FIGURES)
    assert file.read_bytes() == first


def test_the_payload_selects_the_capability(file, languages):
    type_in(file, languages, 0.8).write(FIGURES)
    unloaded, loaded = capabilities(file, languages)
    assert (len(unloaded.legTimings), len(loaded.legTimings)) == (0, 2)
    with pytest.raises(UnsupportedError, match=r"payload of 3 kg; known are 0, 0\.8"):
        type_in(file, languages, 3.0)


def test_a_capability_without_content_gets_some(file, languages):
    begin, end = (QUAD.index(each) for each in (b"<movementCapabilities", b"<policies"))
    begin, end = (QUAD.index(each) for each in (b"<movementCapabilities", b"<policies"))
    capability = b'<movementCapabilities lifetime="9.0"><speed max="12.0" min="0.0"/></movementCapabilities>'
    file.write_bytes(QUAD[:begin] + capability + QUAD[end:])
    type_in(file, languages, 0.0).write(FIGURES)
    (only,) = capabilities(file, languages)
    assert (only.lifetime, len(only.legTimings)) == (2010.0, 2)


def test_the_capacity_is_that_of_all_batteries(file, languages):
    battery = float(QUAD.split(b'<batteries capacity="')[1].split(b'"')[0])
    assert type_in(file, languages, 0.0).capacity == pytest.approx(battery * 3.6)


def test_what_changed_meanwhile_is_not_overwritten(file, languages):
    given = type_in(file, languages, 0.0)
    file.write_bytes(QUAD + b"\n")
    with pytest.raises(UnreadableError, match="was changed meanwhile; nothing was written"):
        given.write(FIGURES)
    assert file.read_bytes() == QUAD + b"\n"


def test_faulty_figures_change_nothing(file, languages):
    given = type_in(file, languages, 0.0)
    with pytest.raises(InvalidModelError, match="has faults with these figures"):
        given.write((Figure("maxTurnRate", "°/s", "", (float("inf"),)),))
    assert file.read_bytes() == QUAD


def test_other_files_are_refused(file, languages, tmp_path):
    mission = shipped("examples") / "carbon-dioxide" / "mission.xmi"
    with pytest.raises(UnsupportedError, match="not a robot type"):
        type_in(mission, languages, 0.0)
    with pytest.raises(UnsupportedError, match="into XMI only"):
        type_in(tmp_path / "quad.json", languages, 0.0)
    with pytest.raises(UnreadableError, match="no such file"):
        type_in(tmp_path / "none.xmi", languages, 0.0)
    file.write_bytes(QUAD.replace(b'lifetime="', b'lifetime="soon'))
    with pytest.raises(InvalidModelError, match="not valid"):
        type_in(file, languages, 0.0)
