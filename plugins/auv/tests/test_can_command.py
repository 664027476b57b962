"""``mmrs can`` as people call it."""

import json
import os
import signal
import subprocess
import threading
import time
from pathlib import Path

import can
import cantools
import pytest
from can_hub import Raw, running
from mmrs_auv.commands.can import app
from mmrs_auv.commands.watching import Monitor
from typer.main import get_command
from vessel_sheets import sheet, thruster
from warm_python import python

from auv_vessel.sheet import to_json
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.database import dbc_of
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.ports import open_port
from mmrs_core.cli import run as mmrs
from mmrs_core.errors import LinkLostError, UnreadableError, UnsupportedError

SHEET = sheet()


def main(words: list[str]) -> object:
    return get_command(app)(words, standalone_mode=False)


@pytest.fixture
def vehicle(tmp_path: Path) -> str:
    path = tmp_path / "sub1.json"
    path.write_text(to_json(SHEET))
    return str(path)


def test_the_database_is_written_and_printed(
    vehicle: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["dbc", vehicle, "-o", str(tmp_path / "sub1.dbc")]) == 0
    assert (tmp_path / "sub1.dbc").read_text() == dbc_of(SHEET)
    capsys.readouterr()
    assert main(["dbc", vehicle]) == 0
    assert capsys.readouterr().out == dbc_of(SHEET)
    assert cantools.database.load_file(tmp_path / "sub1.dbc").version == "sub1"


def test_it_is_a_command_of_mmrs(vehicle: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert mmrs(["can", "load", vehicle]) == 0
    assert "by design: " in capsys.readouterr().out
    assert mmrs(["can", "--help"]) == 0
    told = capsys.readouterr().out
    assert all(word in told for word in ("dbc", "hub", "monitor", "load"))
    assert mmrs(["can", "hub", "--los", "0.5"]) == 2
    assert mmrs(["can", "nosuch"]) == 2
    assert mmrs(["can", "hub", "--loss", "1.5"]) == 2


def test_all_that_is_wrong_with_a_vehicle_is_listed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bad.json"
    wrong = sheet(thrusters=(thruster(0, max_thrust=float("nan")), thruster(1, id='a"b')))
    path.write_text(to_json(wrong))
    with pytest.raises(UnsupportedError) as caught:
        main(["dbc", str(path), "-o", str(tmp_path / "out.dbc")])
    assert caught.value.elements == (
        "thruster 0 ('T1'): max_thrust: nan is not a finite number",
        "thruster 1 ('a\"b'): id: 'a\"b' has '\"'",
    )
    assert not (tmp_path / "out.dbc").exists()
    assert mmrs(["can", "dbc", str(path)]) == 1
    assert "thruster 0 ('T1'): max_thrust: nan is not a finite number" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"thrusters": 1}', "\x00"])
def test_files_that_are_no_vehicle(text: str, tmp_path: Path) -> None:
    path = tmp_path / "no.json"
    path.write_text(text)
    with pytest.raises(UnreadableError, match=r"no\.json"):
        main(["dbc", str(path)])


def test_where_nothing_can_be_written(vehicle: str, tmp_path: Path) -> None:
    with pytest.raises(UnreadableError, match="No such file"):
        main(["dbc", vehicle, "-o", str(tmp_path / "none" / "x.dbc")])


def test_messages_are_told_with_what_was_missed_and_not_believed(
    vehicle: str, capsys: pytest.CaptureFixture[str]
) -> None:
    codec = Codec(SHEET)
    said = [codec.encode("Depth", Depth=depth, Uncertainty=0.5, Trusted=True) for depth in (1.0, 2.0, 3.0)]
    broken = Frame(said[0].id, said[0].data[:-1] + bytes((said[0].data[-1] ^ 1,)))
    with running() as hub:
        channel = f"can0@127.0.0.1:{hub.port}"

        def speak() -> None:
            with open_port("socketcand", channel) as port:
                while hub.hub.clients < 2:
                    time.sleep(0.01)
                time.sleep(0.2)
                for frame in (
                    said[0],
                    said[2],
                    broken,
                    Frame(0x7FF, b"\1"),
                    codec.encode("SensorsEmergency", Reason="LEAK", Release=False),
                ):
                    port.send(frame)
                time.sleep(0.2)

        speaker = threading.Thread(target=speak)
        speaker.start()
        assert main(["monitor", vehicle, "--channel", channel, "--for", "1.5"]) == 0
        speaker.join()
    told = capsys.readouterr()
    lines = [line.split(maxsplit=1)[1] for line in told.out.splitlines()]
    assert lines == [
        "Depth Depth=1m Uncertainty=0.5m Trusted=yes",
        "Depth Depth=3m Uncertainty=0.5m Trusted=yes",
        f"Depth [{broken.data.hex(' ')}] not believed: wrong length, check or value",
        "7FF [01] no message of this vehicle",
        "SensorsEmergency Reason=LEAK Release=no",
    ]
    assert told.err.splitlines() == [
        "5 frames",
        "of no message of this vehicle: 1",
        "not believed: 1 Depth",
        "missed: 1 Depth",
    ]


def test_only_what_was_asked_for_is_told(vehicle: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert mmrs(["can", "monitor", vehicle, "--only", "Dept"]) == 2
    assert "no such message; there are Acceleration" in capsys.readouterr().err


def test_counters_that_begin_again_miss_nothing() -> None:
    codec, monitor = Codec(SHEET), Monitor(SHEET)
    for _ in range(600):
        monitor.line(codec.encode("Fix", North=0.0, East=0.0))
    assert monitor.missed["Fix"] == 0


def test_a_bus_that_is_not_there_or_goes_away(vehicle: str) -> None:
    with running() as hub:
        channel = f"can0@127.0.0.1:{hub.port}"
        threading.Timer(0.5, hub.stop).start()
        with pytest.raises(LinkLostError, match="has ended the connection"):
            main(["monitor", vehicle, "--channel", channel])


def test_load_by_design_from_a_log_and_as_json(
    vehicle: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    codec, log = Codec(SHEET), tmp_path / "bus.log"
    with can.CanutilsLogWriter(log) as writer:
        for number in range(200):
            frame = codec.encode("Position", North=number * 1.0, East=0.0)
            writer.on_message_received(
                can.Message(
                    timestamp=100 + number * 0.01,
                    arbitration_id=frame.id,
                    data=frame.data,
                    is_extended_id=False,
                )
            )
    assert main(["load", vehicle, "--log", str(log), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["heard"]["frames"] == 200
    assert 200 * 111 / 500_000 / 1.99 < found["heard"]["mean"] < 200 * 135 / 500_000 / 1.99
    assert main(["load", vehicle, "--log", str(log), "--messages"]) == 0
    told = capsys.readouterr().out
    assert "Thruster5Command     0x105    50 ms    87-105" in told
    assert "as measured: " in told


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bus.log", b""),
        ("bus.log", b"nonsense\n"),
        ("bus.log", b"(1.0) can0 100#XX\n"),
        ("bus.log", b"\xff\xfe"),
        ("bus.csv", b"nonsense" * 20),
        ("bus.md", b"# Log\n"),
    ],
)
def test_logs_that_are_none(name: str, text: bytes, vehicle: str, tmp_path: Path) -> None:
    log = tmp_path / name
    log.write_bytes(text)
    with pytest.raises((UnreadableError, LinkLostError)):
        main(["load", vehicle, "--log", str(log)])


def test_load_of_a_bus_that_is_listened_to(vehicle: str, capsys: pytest.CaptureFixture[str]) -> None:
    codec = Codec(SHEET)
    with running() as hub, Raw(hub.port) as said:
        word = codec.encode("Fix", North=1.0, East=2.0)
        text = f"< send {word.id:x} 8 {word.data.hex(' ')} >"
        stop = threading.Event()

        def speak() -> None:
            while not stop.wait(0.01):
                said.say(text)

        speaker = threading.Thread(target=speak)
        speaker.start()
        channel = f"can0@127.0.0.1:{hub.port}"
        assert main(["load", vehicle, "--interface", "socketcand", "--channel", channel, "--for", "1"]) == 0
        stop.set()
        speaker.join()
    assert "as measured: " in capsys.readouterr().out


class HubProcess:
    def __init__(self, *options: str) -> None:
        self.process = subprocess.Popen(
            [python(), "-m", "mmrs_core", "can", "hub", "--port", "0", *options],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, bufsize=1,
        )  # fmt: skip
        assert self.process.stdout is not None
        self.port = int(self.process.stdout.readline().split()[2].rpartition(":")[2].rstrip(";"))

    def order(self, line: str) -> str:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(line + "\n")
        return self.process.stdout.readline().rstrip("\n")


def test_the_hub_as_a_process(tmp_path: Path) -> None:
    log = tmp_path / "bus.log"
    hub = HubProcess("--log", str(log), "--seed", "3")
    try:
        with Raw(hub.port) as said, Raw(hub.port) as heard:
            said.say("< send 100 2 1 2 >")
            assert heard.word().startswith("< frame 100 ")
            assert hub.order("cut") == "loss 1, delay 0 s, corruption 0"
            said.say("< send 101 0 >< echo >")
            assert said.word() == "< echo >"
            assert hub.order("clear") == "loss 0, delay 0 s, corruption 0"
            assert hub.order("delay 0.05") == "loss 0, delay 0.05 s, corruption 0"
            assert hub.order("loss 7").startswith("loss 7: loss 7.0 is not 0 to 1")
            assert hub.order("explode").startswith("explode: expected loss SHARE")
            said.say("< send 102 0 >")
            assert heard.word().startswith("< frame 102 ")
        os.kill(hub.process.pid, signal.SIGTERM)
        out, err = hub.process.communicate(timeout=20)
    finally:
        hub.process.kill()
        hub.process.wait()
    assert hub.process.returncode == 0
    assert out.splitlines()[-1] == "3 frames, 1 lost"
    assert "no arbitration" in err
    with can.LogReader(log) as reader:
        assert [(each.arbitration_id, bytes(each.data)) for each in reader] == [
            (0x100, b"\1\2"),
            (0x102, b""),
        ]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_log_that_is_full_is_told_once_and_the_hub_goes_on() -> None:
    hub = HubProcess("--log", "/dev/full")
    try:
        with Raw(hub.port) as said, Raw(hub.port) as heard:
            for number in range(3):
                said.say(f"< send 10{number} 0 >")
                assert heard.word().startswith(f"< frame 10{number} ")
        hub.process.terminate()
        out, _ = hub.process.communicate(timeout=20)
    finally:
        hub.process.kill()
        hub.process.wait()
    assert out.splitlines() == ["no log from here on: No space left on device", "3 frames"]


def test_a_port_that_is_taken_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with running() as hub:
        assert mmrs(["can", "hub", "--port", str(hub.port)]) == 5
        assert f"no hub at 127.0.0.1:{hub.port}: address already in use; choose" in capsys.readouterr().err


def test_it_ends_by_itself_and_warns_where_others_can_reach_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert mmrs(["can", "hub", "--port", "0", "--host", "0.0.0.0", "--for", "0.2"]) == 0
    told = capsys.readouterr()
    assert "0 frames" in told.out
    assert "every computer that reaches 0.0.0.0 can send on it" in told.err
