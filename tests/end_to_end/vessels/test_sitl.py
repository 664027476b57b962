"""Simulated vehicles to which happens what is typed."""

import os
import queue
import signal
import subprocess
import sys
import threading
from contextlib import closing
from pathlib import Path

import pytest
from mmrs_auv.commands.modelled import sheets_in
from patience import wait_for
from ports import free_port
from vessel_processes import Ear

from auv_vessel.wire.catalogue import EMERGENCIES
from auv_vessel.wire.ports import open_port

pytestmark = pytest.mark.real_time("vessels")

POOL = Path(__file__).parents[3] / "examples" / "pool"


class Sitl:
    """The command, with what it says on standard error line by line."""

    def __init__(self, port: int) -> None:
        words = [sys.executable, "-m", "mmrs_core", "auv", "sitl", str(POOL), "--port", str(port)]
        self.process = subprocess.Popen(
            [*words, "--speedup", "5"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True, bufsize=1, start_new_session=True,
        )  # fmt: skip
        self.lines: list[str] = []
        self._told: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.lines.append(line)
            self._told.put(line)

    def quit(self) -> int:
        """End it as people do; return its exit code."""
        assert self.process.stdin is not None
        self.process.stdin.write("quit\n")
        code = self.process.wait(30)
        self._reader.join(30)
        return code

    def interrupt(self) -> int:
        """End it as a terminal does, which tells all processes that began in it; return its exit code."""
        os.killpg(self.process.pid, signal.SIGINT)
        code = self.process.wait(30)
        self._reader.join(30)
        return code

    def close(self) -> None:
        self.process.terminate()
        self.process.wait(30)
        self._reader.join(30)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            assert stream is not None
            stream.close()

    def first_line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline()

    def type(self, line: str, told: str) -> None:
        """Type a line; return when that is told."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{line}\n")
        while told not in self._told.get(timeout=30):
            continue


def is_silent(ear):
    begin = len(ear.heard)  # what was sent before arrives late on a busy computer
    return not wait_for(lambda: any(said.name == "Pressure" for _, said in ear.heard[begin:]), 0.5)


def test_what_is_typed_happens():
    port = free_port()
    address = f"can0@127.0.0.1:{port}"
    with closing(Sitl(port)) as sitl:
        assert f"Naiad={address}" in sitl.first_line()
        with open_port("socketcand", address) as port:
            ear = Ear(sheets_in(POOL)["Naiad"], port)
            sitl.type("Nobody leak", "Nobody: unknown robot; known are Naiad, and all\n")
            sitl.type("Naiad flood", "flood: no such fault; known are thruster-dead")
            sitl.type("Naiad loss 2", "loss 2.0 is not 0 to 1\n")
            sitl.type("all thruster-dead 0", "Naiad: thruster-dead 0\n")
            assert wait_for(lambda: "FAULT" in drives(ear), 20)
            sitl.type("status", "; thruster T1 dead\n")
            sitl.type("Naiad clear thruster-dead T1", "Naiad: clear thruster-dead T1\n")
            sitl.type("Naiad leak", "Naiad: leak\n")
            assert wait_for(lambda: "LEAK" in reasons(ear), 20)
            sitl.type("Naiad cut", "Naiad: cut\n")
            assert wait_for(lambda: is_silent(ear), 20)
            cut = len(ear.heard)
            sitl.type("Naiad clear bus", "Naiad: clear bus\n")
            assert wait_for(lambda: any(said.name == "Pressure" for _, said in ear.heard[cut:]), 20)
        assert sitl.quit() == 0
        assert [line for line in sitl.lines if "incomplete message" in line or "bus is gone" in line] == []


@pytest.mark.thorough
def test_an_interrupt_ends_all_of_it_in_order():
    with closing(Sitl(free_port())) as sitl:
        assert "Naiad=" in sitl.first_line()
        assert sitl.interrupt() == 130
        assert sitl.lines == []


def drives(ear: Ear) -> set[object]:
    return {said.values["Drive"] for _, said in ear.said("Thruster0Status")}


def reasons(ear: Ear) -> set[object]:
    return {said.values["Reason"] for name in EMERGENCIES for _, said in ear.said(name)}
