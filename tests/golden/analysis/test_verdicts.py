"""What checks say of two fleets, word for word; `--update-golden` writes it anew."""

from dataclasses import replace
from pathlib import Path

import pytest
from checking import given, kind, land, recharge, rover, square, strange, take_off

from mmrs_core.analysis.checks import CHECKS
from mmrs_core.analysis.verdicts import verify
from mmrs_core.behaviour.program import MoveTarget
from mmrs_core.scene import Part
from mmrs_core.testing.small_programs import go, hold, notify, robot, use

EXPECTED = Path(__file__).parent / "expected"
WEATHER = {"windSpeed": 4.0, "temperature": 15.0, "waterDensity": 1000.0}
AREAS = (square("crane", at=(20.0, 8.0), high=12.0, distance=1.0), square("school", at=(60.0, 60.0)))
TYPE = rover(
    attributes={
        "communicationRange": 200.0,
        "positionHold": 8.0,
        "maxOperatingPressure": 120_000.0,
        "operatingTemperature": Part((), {"min": -5.0, "max": 40.0}),
    },
    devices={"camera": {"shoot": 2.0}},
    max_payload=1.0,
)


def sound():
    """Return two flights that are in order: one lands, recharges and flies again."""
    shoot = (use("camera", "shoot"),)
    a = [
        take_off("up", 10.0),
        go("to the field", (40.0, 0.0, 10.0), after=shoot, speed=3.0),
        go("back", (0.0, 0.0, 10.0)),
        land("down", after=(notify("b.turn"),)),
        recharge("charge", 90.0),
        take_off("up again", 10.0),
        land("down again"),
    ]
    b = [
        take_off("up", 14.0),
        go("over the crane", (40.0, 8.0, 14.0)),
        go("home", (0.0, 9.0, 14.0)),
        land("down"),
    ]
    return robot("a", a), robot("b", b, waits={"start": ["turn"]}, home=(0.0, 9.0, 0.0))


def broken():
    """Return three robots that are wrong in nearly every way that checks know."""
    a = [
        go("too early", (20.0, 8.0, 5.0), speed=9.0),
        take_off("up", 300.0, after=(use("lamp", "shine"),)),
        hold("long", 2000.0),
        recharge("charge", 10.0),
    ]
    lost = replace(go("to the boat", (0.0, 0.0, 0.0)), target=MoveTarget(None, "boat", None))
    b = [take_off("up", 10.0), lost, land("down"), strange("dig")]
    c = [hold("fork"), hold("tell", after=(notify("a.go"),)), go("under", (0.0, 0.0, -30.0))]
    return (
        replace(robot("a", a, waits={"start": ["go"]}), payload=0.0),
        robot("b", b, waits={"dig": ["never"]}, home=(5.0, 0.0, 0.0)),
        robot("c", c, choices={"fork": ("c", "tell", "under")}, home=(0.0, 30.0, 0.0)),
    )


@pytest.mark.parametrize("fleet", [sound, broken])
def test_words_stay_as_people_know_them(fleet, update_golden):
    made = given(
        *fleet(),
        type=TYPE,
        robot_kind=kind(launches=True, floor=1.0, ceiling=60.0),
        areas=AREAS,
        environment=WEATHER,
        minimum_separation=3.0,
    )
    words = "".join(f"{_line(verdict)}\n" for verdict in verify(made, CHECKS))
    file = EXPECTED / f"{fleet.__name__}.txt"
    if update_golden:
        file.parent.mkdir(exist_ok=True)
        file.write_text(words, encoding="utf-8", newline="\n")
    assert words == file.read_text(encoding="utf-8")


def _line(verdict):
    margin = "" if verdict.margin is None else f" {verdict.margin:.3f} {verdict.unit}"
    return f"{verdict.property}: {verdict.status.value}{margin}\n    {verdict.message}"
