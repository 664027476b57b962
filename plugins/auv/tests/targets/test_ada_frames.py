"""The interpreter, decision centres in Ada and drives in C say and read the same frames."""

import json
import os
import re
import shutil
from math import dist
from random import Random

import pytest
from ada_crafts import (
    FIGURES,
    MESSAGES,
    OBJECTS,
    OWNER,
    Compared,
    bits,
    compiled,
    happenings,
    meant,
    real,
    said,
    some_datagram,
    some_frame,
    some_value,
    told,
    words_of,
)
from ada_ways import lines_of, places_of, some_place, some_robot, some_track
from c_drives import Script
from c_drives import compiled as drives
from c_drives import told as done_by
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.targets.ada.policies import EVENTS, LASTING, RESPONSES
from mmrs_auv.targets.places import templates_of
from sample_vessels import heavy_sheet, pool_sheet, torpedo_sheet
from vessel_sheets import sheet

from auv_vessel.decision.duty_control import COMES_UP
from auv_vessel.eyes import Detections
from auv_vessel.wire.catalogue import EMERGENCIES, REASONS
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame
from mmrs_mavlink.program import Local
from mmrs_runtime.controllers.return_paths import way_back
from mmrs_runtime.engine.responses import Responses
from mmrs_runtime.faults import LINK_LOST, PEER_LOST
from mmrs_runtime.policies import OVERTAKES, SURFACE, in_precedence
from mmrs_runtime.vehicle import Fault

COUNTS = [100, pytest.param(5000, marks=pytest.mark.thorough)]
SEEDS = [0, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(1, 12))]


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    if shutil.which("gnatmake") is None:
        message = "gnatmake is not installed: compiles decision centres in Ada"
        pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)
    return compiled(tmp_path_factory.mktemp("craft"))


def differing(program, lines, expected):
    """Return what the program does otherwise: line, its answer, what is wanted."""
    answers = told(program, lines)
    return [each for each in zip(lines, answers, expected, strict=True) if each[1] != each[2]]


@pytest.mark.parametrize("count", COUNTS)
def test_values_become_the_same_bytes_or_are_refused_alike(program, count):
    random, codec = Random(count), Codec(sheet())
    lines, expected = [], []
    for number, message in enumerate(MESSAGES):
        counter = 0
        for _ in range(count):
            values = [some_value(part, random) for part in message.fields]
            frame = said(codec, message, values)
            lines.append(f"e {number} {counter} {' '.join(map(bits, values))}")
            expected.append("refused" if frame is None else words_of([frame]))
            counter = (counter + (frame is not None)) % 256
    assert differing(program, lines, expected) == []
    assert 0.02 < expected.count("refused") / len(expected) < 0.4


@pytest.mark.parametrize("count", COUNTS)
def test_bytes_mean_the_same_or_nothing(program, count):
    random, codec = Random(count), Codec(sheet())
    lines, expected = [], []
    for number, message in enumerate(MESSAGES):
        for _ in range(count):
            frame = some_frame(codec, message, random)
            lines.append(f"d {number} {frame.id} {frame.data.hex()}")
            expected.append(meant(codec, message, frame) if frame.id == message.id else "none")
    assert differing(program, lines, expected) == []
    assert 0.2 < expected.count("none") / len(expected) < 0.8


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("make", [pool_sheet, torpedo_sheet, heavy_sheet, sheet])
def test_what_is_said_and_known_is_the_same_whatever_happens(program, make, seed):
    vehicle = make()
    assert list(happenings(vehicle, seed, 300).differences(program)) == []


@pytest.mark.parametrize("name", EMERGENCIES)
def test_an_emergency_of_any_node_is_obeyed(program, name):
    compared, codec = Compared(sheet()), Codec(sheet())
    compared.hear(1.0, codec.encode(name, Reason="LEAK", Release=True))
    compared.tick(1.0)
    assert list(compared.differences(program)) == []
    assert compared.craft.state().emergency == "LEAK"


@pytest.mark.parametrize("deepest", [0.5, 655.35, 655.36, 1311.0, 6000.0, 8388.607])
def test_depths_are_written_in_the_steps_of_each_vehicle(program, deepest):
    assert list(happenings(sheet(max_depth=deepest), 3, 60).differences(program)) == []


@pytest.mark.parametrize("metres", [0.5, 100.0, 400.0])
def test_the_place_is_lost_where_the_sheet_says_so(program, metres):
    told = happenings(sheet(extra={"position.lost": metres}), 4, 100)
    assert list(told.differences(program)) == []


@pytest.mark.parametrize("count", COUNTS)
def test_objects_are_seen_at_the_same_places(program, count):
    now, random = [0.0], Random(count)
    lines, expected = [f"b {json.dumps(OWNER)}"], [""]
    with Detections(clock=lambda: now[0], robot=OWNER) as eyes:
        for number in range(count):
            now[0] += random.choice([0.0, 0.1, 0.5, 3.0])
            data = some_datagram(random, number * 0.1)
            eyes.take(data)
            lines.append(f"n {bits(now[0])} {data.decode().rstrip()}")
            expected.append("")
            for name in OBJECTS:
                found = eyes.place(name)
                lines.append(f"w {bits(now[0])} {json.dumps(name)}")
                expected.append("none" if found is None else " ".join(map(bits, found)))
    assert differing(program, lines, expected) == []
    assert 0.2 < expected.count("none") / len(expected) < 0.6


@pytest.mark.parametrize("count", COUNTS)
def test_the_way_back_is_that_of_controllers_in_python(program, count):
    random = Random(count)
    lines, wanted = [], []
    for _ in range(count):
        start = some_place(random)
        robot = some_robot(random, start)
        track = some_track(random, robot, start)
        here = random.choice([some_place(random), track[-1][1]])
        lines += lines_of(robot, track, here)
        found = way_back(robot, "RETURN", track, here)
        wanted.append([places_of(each) for each in found if isinstance(each, Local)])
    answers = [answer for line, answer in zip(lines, told(program, lines), strict=True) if line[0] == "k"]
    assert len(answers) == count
    assert sum(len(each) > 1 for each in wanted) > count / 5
    for answer, places in zip(answers, wanted, strict=True):
        numbers = list(map(real, answer.split()))
        found = [numbers[index : index + 3] for index in range(0, len(numbers), 3)]
        assert len(found) == len(places)
        assert all(dist(a, b) < 1e-6 for a, b in zip(found, places, strict=True))


@pytest.mark.parametrize("release", [True, False])
def test_drives_in_c_stop_by_what_a_decision_centre_in_ada_says(program, release, tmp_path):
    """Each emergency as it is written, and with one bit turned in each byte."""
    (number,) = (index for index, each in enumerate(MESSAGES) if each.name == "DecisionEmergency")
    stop = drives(sheet(1), tmp_path)
    reasons = [bits(float(reason)) for reason in range(len(REASONS))]
    lines = [f"e {number} 255 {reason} {bits(float(release))}" for reason in reasons]
    for answer in told(program, lines):
        id, data = answer.split()
        sound = Frame(int(id), bytes.fromhex(data))
        for place in [None, *range(len(sound.data))]:
            script = Script()
            script.hear(0, sound if place is None else _turned(sound, place))
            ((*happened, _),) = done_by(stop, script)
            assert happened == (["r"] if release and place is None else [])


def test_the_tables_of_a_decision_centre_are_those_of_the_runtime(program):
    """Responses to what no model says anything of are those of the engine, for a vehicle of the kind."""
    answers = Responses(in_precedence(kind=AUV_KIND.policies), live=True)
    found = dict(zip(EVENTS, told(program, [f"r {event}" for event in EVENTS]), strict=True))
    assert {event: words.split()[0] for event, words in found.items()} == {
        event: RESPONSES[SURFACE if event in COMES_UP else answers.response(Fault(event))].upper()
        for event in EVENTS
    }
    assert {event for event, words in found.items() if words.split()[1] == "COMES_UP"} == {
        LINK_LOST,
        PEER_LOST,
    }
    assert told(program, [f"u {event}" for event in LASTING]) == [
        str(event in OVERTAKES or event == LINK_LOST).upper() for event in LASTING
    ]


def test_the_figures_of_a_decision_centre_are_those_of_the_vehicle_in_python(program):
    (answer,) = told(program, ["p"])
    assert list(map(real, answer.split())) == list(FIGURES.values())


def test_no_figure_is_written_by_hand_that_an_interpreter_goes_by_too():
    """What stands in sources in Ada is about Ada, a polynomial, or how a gateway is spoken to."""
    figure = re.compile(r"^ *(\w+) *: constant(?: Long_Float| Duration| Unsigned_8)? := [\d._E#A-F]+;", re.M)
    sources = templates_of("ada").glob("*.ad[bs]")
    found = {f"{source.stem}.{name}" for source in sources for name in figure.findall(source.read_text())}
    assert found == {
        "clocks.Most", "craft.Most_Frames", "decision_centre.Most", "gateway.Later", "gateway.Sign",
        "options.Most_Port", "wire.Polynomial",
    }  # fmt: skip


def _turned(frame: Frame, place: int) -> Frame:
    data = bytearray(frame.data)
    data[place] ^= 1
    return Frame(frame.id, bytes(data))
