import signal
import subprocess
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from c_drives import STRICT, Compared, compiled, happenings, need_compiler, told, written
from can_hub import Raw, running
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mmrs_auv.targets.can_c.target import CAN_C, block, files_of, number
from ports import free_port
from vessel_sheets import sheet, sheets, thruster

from auv_vessel.body.devices import pressure_of_depth
from auv_vessel.wire.catalogue import EMERGENCIES
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame, check_of
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.testing.programs import sample_of

HOSTILE = (
    '*/ int x = "; /*',
    "/*/",
    "??/",
    "*??/ /",
    "ünï ☃ 名",
    "#include <x>",
    "%n%s",
    "//",
    "'",
    "*" * 64,
)


IMPATIENT = sheet(3, extra={"deadman.time": 0.25})


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    return compiled(sheet(3), tmp_path_factory.mktemp("three"), "-fsanitize=undefined,address")


@pytest.fixture(scope="module")
def impatient(tmp_path_factory):
    return compiled(IMPATIENT, tmp_path_factory.mktemp("impatient"), "-fsanitize=undefined,address")


def agree(program, compared):
    assert told(program, compared.script) == compared.expected


@pytest.mark.parametrize(
    "seed", [*range(4), *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(4, 60))]
)
def test_drives_do_what_those_of_the_simulated_vehicle_do(impatient, seed):
    compared = happenings(IMPATIENT, seed, 8.0)
    agree(impatient, compared)
    states = {line[-6:-4] for lines in compared.expected for line in lines if line.startswith("s")}
    assert len(states) >= 3, "the script must bring about most states"


@pytest.mark.thorough
@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
@given(vehicle=sheets().filter(lambda each: each.thrusters), seed=st.integers(0, 999))
def test_drives_of_any_vehicle_do(vehicle, seed, tmp_path_factory):
    program = compiled(vehicle, tmp_path_factory.mktemp("any"))
    agree(program, happenings(vehicle, seed, 2.0))


def test_drives_say_what_they_draw_at_any_thrust(tmp_path):
    most = (0.01, 7.77, 32767.0)
    thrusters = (thruster(i, operating_thrust=each, max_thrust=each) for i, each in enumerate(most))
    vehicle = sheet(0, thrusters=tuple(thrusters))
    agree(compiled(vehicle, tmp_path), happenings(vehicle, 1, 9.0, emergencies=False))


def test_a_command_is_obeyed_until_its_watchdog_runs_out(three):
    compared, codec = Compared(sheet(3)), Codec(sheet(3))
    for at in (0, 5, 10):
        compared.hear(at, codec.encode("Thruster1Command", Thrust=20.0, Enable=True))
    for at in range(10, 80, 5):
        compared.tick(at)
    agree(three, compared)
    pushes = ["o 1 20" in lines for lines in told(three, compared.script)]
    assert pushes == [False, True, True, *[True] * 10, *[False] * 4]


def test_one_frame_for_ever_moves_nothing(three):
    compared = Compared(sheet(3))
    frame = Codec(sheet(3)).encode("Thruster0Command", Thrust=20.0, Enable=True)
    for at in range(0, 300, 5):
        compared.hear(at, frame)
    agree(three, compared)
    assert all("o 0 0" in lines for lines in told(three, compared.script))


@pytest.mark.parametrize("name", EMERGENCIES)
def test_an_emergency_of_any_node_stops_all_for_good_and_drops_the_weight_once(three, name):
    compared, codec = Compared(sheet(3)), Codec(sheet(3))
    for at in range(0, 100, 5):
        compared.hear(at, codec.encode("Thruster0Command", Thrust=-9.0, Enable=True))
        if at in (20, 40):
            compared.hear(at, codec.encode(name, Reason="LEAK", Release=True))
    agree(three, compared)
    lines = told(three, compared.script)
    assert sum(each.count("r") for each in lines) == 1
    assert "o 0 -9" in lines[4]
    assert all("o 0 0" in each for each in lines[5:])


def test_an_emergency_for_no_reason_that_is_known_stops_nothing(three):
    compared, codec = Compared(sheet(3)), Codec(sheet(3))
    sound = codec.encode("DecisionEmergency", Reason="LEAK", Release=True)
    data = bytes([200, *sound.data[1:-1]])
    for at in range(0, 100, 5):
        compared.hear(at, codec.encode("Thruster0Command", Thrust=-9.0, Enable=True))
        compared.hear(at, Frame(sound.id, data + bytes([check_of(sound.id, data)])))
    agree(three, compared)
    assert "o 0 -9" in told(three, compared.script)[-1]


def test_any_thruster_may_have_any_name(tmp_path):
    need_compiler()
    names = [name for name in HOSTILE if not set('"\\') & set(name)]
    vehicle = sheet(0, robot="*/ #error /*", thrusters=tuple(thruster(i, id=n) for i, n in enumerate(names)))
    made = written(vehicle, tmp_path)
    done = subprocess.run(["make", "-C", str(made)], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("name", HOSTILE)
def test_a_comment_ends_where_it_is_to_end(name, tmp_path):
    need_compiler()
    source = tmp_path / "x.c"
    source.write_text(f"/* {block(name)} */\nextern int x;\nint x = 1;\n")
    words = ["gcc", *STRICT, "-pedantic", "-c", str(source), "-o", str(tmp_path / "x.o")]
    assert subprocess.run(words, capture_output=True, timeout=60).stderr == b""


@given(st.text())
def test_no_text_ends_a_comment(text):
    shown = block(text)
    assert shown.isascii()
    assert shown.isprintable()
    assert not [ends for ends in ("*/", "/*", "??/") if ends in shown]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "1", True, None])
def test_what_is_no_number_in_c_is_refused(value):
    with pytest.raises(ValueError, match="is not a number in C"):
        number(value)


def test_a_robot_without_thrusters_on_a_bus_is_refused():
    with pytest.raises(UnsupportedError) as refusal:
        render(CAN_C, sample_of("plain_robot").plain)
    assert refusal.value.elements[0] == "robot 'alpha': is not an underwater vehicle"
    given = sample_of("auv").plain
    with pytest.raises(UnsupportedError, match="type 'Kind' is not known"):
        render(CAN_C, replace(given, types={}))


def test_how_deep_is_deep_depends_on_the_water():
    salty, fresh = ({"waterDensity": density} for density in (1028.0, 998.0))
    deep = []
    for water in (salty, fresh):
        files = {
            file.path: file for file in render(CAN_C, replace(sample_of("auv").plain, environment=water))
        }
        header = files["drives_alpha/vehicle.h"].content.decode()
        deep.append(float(header.partition("VEHICLE_DEEP ")[2].split()[0]))
    assert deep == pytest.approx([101_325.0 + each * 9.80665 * 0.5 for each in (1028.0, 998.0)])


def test_vehicles_share_all_but_their_thrusters_and_outputs():
    paths = [spec.path for spec in files_of({"one": sheet(2), "two": sheet(2), "three": sheet(3)})]
    assert len(paths) == len(set(paths))
    own = ["vehicle.h", "vehicle.c", "Makefile", "outputs.c"]
    assert [path for path in paths if path.startswith("two/")] == [f"two/{name}" for name in own]
    assert {path for path in paths if path.endswith("bus.c")} == {"bus/bus.c", "bus_2/bus.c"}


def test_what_is_the_users_is_said_to_be_so():
    files = {file.path: file for file in render(CAN_C, sample_of("auv").plain)}
    assert [path for path, file in files.items() if file.once] == ["drives_alpha/outputs.c"]
    assert files["drives_alpha/outputs.c"].asks
    assert "drives_alpha/" in files["README.md"].content.decode()


def abandoned(pressure, patience=5.0):
    """Return drives that are commanded for a tenth of a second, at a pressure, and then no more."""
    vehicle = sheet(3, extra={"deadman.time": patience})
    compared, codec = Compared(vehicle), Codec(vehicle)
    compared.hear(0, codec.encode("Pressure", Pressure=pressure, Temperature=10.0))
    for at in (0, 5, 10):
        compared.hear(at, codec.encode("Thruster0Command", Thrust=9.0, Enable=True))
    for at in range(20, 700, 10):
        compared.tick(at)
    return compared


def test_the_drop_weight_falls_once_nobody_commands_a_vehicle_down_there(three):
    compared = abandoned(120_000.0)
    agree(three, compared)
    falls = [
        line for line, lines in zip(compared.script.lines, compared.expected, strict=True) if "r" in lines
    ]
    assert falls == ["t 5100000"]


@pytest.mark.parametrize("pressure", [101_325.0, pressure_of_depth(sheet(3)) // 1])
def test_the_drop_weight_stays_where_it_is_not_deep(three, pressure):
    compared = abandoned(pressure)
    agree(three, compared)
    assert not any("r" in lines for lines in compared.expected)


def test_the_drop_weight_is_held_for_ever_where_a_sheet_says_so(tmp_path):
    vehicle = sheet(3, extra={"deadman.time": 0.0})
    compared = abandoned(120_000.0, patience=0.0)
    agree(compiled(vehicle, tmp_path), compared)
    assert not any("r" in lines for lines in compared.expected)


def test_a_dead_mans_time_that_drives_cannot_measure_is_refused():
    with pytest.raises(UnsupportedError, match=r"deadman.time: 5000 s is more than 2000 s"):
        list(files_of({"drives": sheet(1, extra={"deadman.time": 5000.0})}))


@pytest.fixture(scope="module")
def program(tmp_path_factory) -> Path:
    need_compiler()
    made = written(sheet(2), tmp_path_factory.mktemp("program"))
    subprocess.run(["make", "-C", str(made)], check=True, capture_output=True, timeout=120)
    return made / "drives"


@contextmanager
def started(program, port):
    """Start the program at a hub's port; end it if it does not end by itself."""
    with subprocess.Popen([program, "127.0.0.1", str(port)], stderr=subprocess.PIPE) as drives:
        try:
            yield drives
        finally:
            drives.kill()


def stop(drives):
    """Tell the program to end, and return its exit code."""
    drives.send_signal(signal.SIGTERM)
    return drives.wait(10)


def statuses(client, codec, wanted):
    """Hear until a status of the first thruster is as wanted; return it."""
    for _ in range(2000):
        heard = codec.decode(_frame(client.word()))
        if heard is not None and heard.name == "Thruster0Status" and wanted(heard.values):
            return heard.values
    raise AssertionError("no such status")


def _frame(word):
    _, _, id, _, *data = word.split()
    octets = bytes.fromhex(data[0]) if data[0] != ">" else b""
    return Frame(int(id, 16), octets)


def say(client, frame):
    data = " ".join(f"{byte:x}" for byte in frame.data)
    client.say(f"< send {frame.id:x} {len(frame.data)} {data} >")


def test_the_program_is_a_node_of_the_bus(program):
    codec = Codec(sheet(2))
    with running() as hub, Raw(hub.port) as client, started(program, hub.port) as drives:
        statuses(client, codec, lambda status: status["Drive"] == "OFF")
        for _ in range(3):
            say(client, codec.encode("Thruster0Command", Thrust=12.5, Enable=True))
        found = statuses(client, codec, lambda status: status["Drive"] == "RUNS")
        assert (found["Thrust"], found["Power"] > 0.0) == (pytest.approx(12.5), True)
        found = statuses(client, codec, lambda status: status["Drive"] == "WATCHDOG")
        assert (found["Thrust"], found["Power"]) == (0.0, 0.0)
        assert not codec.faults
        assert stop(drives) == 0


def test_a_program_that_was_stopped_does_not_take_its_own_lateness_for_silence(tmp_path):
    need_compiler()
    vehicle = sheet(1, extra={"deadman.time": 0.7})
    made, codec = written(vehicle, tmp_path), Codec(vehicle)
    outputs = made / "outputs.c"
    deep = outputs.read_text().replace("return told;", "return told || true;")
    release = '#include <stdio.h>\nvoid outputs_release(void)\n{\n    (void)fputs("released\\n", stderr);'
    outputs.write_text(deep.replace("void outputs_release(void)\n{", release))
    subprocess.run(["make", "-C", str(made)], check=True, capture_output=True, timeout=120)

    with running() as hub, Raw(hub.port) as client, started(made / "drives", hub.port) as drives:

        def command(times):
            for _ in range(times):
                say(client, codec.encode("Thruster0Command", Thrust=12.5, Enable=True))
                time.sleep(0.05)

        command(3)
        statuses(client, codec, lambda status: status["Drive"] == "RUNS")
        drives.send_signal(signal.SIGSTOP)
        command(20)
        drives.send_signal(signal.SIGCONT)
        command(2)
        assert statuses(client, codec, lambda status: True)["Drive"] == "RUNS"
        drives.send_signal(signal.SIGTERM)
        assert drives.communicate(timeout=10)[1] == b""


def test_the_program_ends_with_the_bus(program):
    with running() as hub, started(program, hub.port) as drives:
        with Raw(hub.port) as client:
            statuses(client, Codec(sheet(2)), lambda status: True)
        hub.stop()
        _, said = drives.communicate(timeout=10)
        assert said == f"drives: the bus at 127.0.0.1, port {hub.port}, is gone\n".encode()
        assert drives.returncode == 3


def test_the_program_waits_for_the_hub_a_while(program):
    port = free_port()
    with started(program, port) as drives:
        with pytest.raises(subprocess.TimeoutExpired):
            drives.wait(0.3)
        with running(port=port), Raw(port) as client:
            statuses(client, Codec(sheet(2)), lambda status: True)
            assert stop(drives) == 0


def test_the_program_says_that_there_is_no_hub(program):
    port = str(free_port())
    done = subprocess.run([program, "127.0.0.1", port], capture_output=True, timeout=20)
    assert (done.returncode, done.stderr) == (3, f"drives: no hub at 127.0.0.1:{port}\n".encode())


def test_the_program_says_how_it_is_called(program):
    done = subprocess.run([program], capture_output=True, timeout=10)
    assert (done.returncode, done.stderr) == (2, b"usage: drives HOST PORT [CHANNEL]\n")
