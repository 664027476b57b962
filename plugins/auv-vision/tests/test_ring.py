"""Pairs of pictures in shared memory, between processes that are killed and begin again."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from multiprocessing import resource_tracker
from multiprocessing.shared_memory import SharedMemory
from pathlib import Path
from secrets import token_hex

import numpy as np
import pytest

from auv_vision import ring
from auv_vision.cameras import Picture, Pose
from auv_vision.ring import MemoryTakenError, Pair, Reader, Writer

WIDTH, HEIGHT = 160, 120

WRITES = """
import sys, time
import numpy as np
from auv_vision.cameras import Pose
from auv_vision.ring import Writer
name, pause = sys.argv[1], float(sys.argv[2])
writer = Writer(name, 160, 120)
print("writes", flush=True)
number = 0
while True:
    number += 1
    value = number % 256
    picture = np.full((120, 160, 3), value, np.uint8)
    writer.write(float(number), Pose(value, value, value), picture, picture, float(value))
    time.sleep(pause)
"""

READS = """
import sys, time
from auv_vision.ring import Reader
reader = Reader(sys.argv[1])
while reader.newest() is None:
    pass
print("reads", flush=True)
while True:
    reader.newest()
"""


@pytest.fixture
def name() -> str:
    return f"mmrs-test-{token_hex(6)}"


@pytest.fixture
def children() -> Iterator[list[subprocess.Popen[str]]]:
    begun: list[subprocess.Popen[str]] = []
    yield begun
    for child in begun:
        child.kill()
        child.communicate()


def start(
    children: list[subprocess.Popen[str]], script: str, *words: str, own_group: bool = False
) -> subprocess.Popen[str]:
    child = subprocess.Popen(
        [sys.executable, "-c", script, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
        start_new_session=own_group,
    )
    children.append(child)
    assert child.stdout is not None
    assert child.stdout.readline()
    return child


def picture(value: int) -> Picture:
    return np.full((HEIGHT, WIDTH, 3), value, np.uint8)


def exists(name: str) -> bool:
    return (Path("/dev/shm") / name).exists()


def soon(reader: Reader, seconds: float = 10.0) -> Pair | None:
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if (pair := reader.newest()) is not None:
            return pair
        reader.look_again()
        time.sleep(0.01)
    return None


def test_a_pair_comes_out_as_it_was_put_in(name: str) -> None:
    pose = Pose(1.0, -2.0, 3.0, 4.0, -5.0, 6.0)
    with Writer(name, WIDTH, HEIGHT) as writer, Reader(name) as reader:
        assert reader.newest() is None
        writer.write(7.5, pose, picture(1), picture(2), 1.25)
        pair = reader.newest()
        assert pair is not None
        assert (pair.number, pair.time, pair.pose, pair.gain) == (1, 7.5, pose, 1.25)
        assert (pair.left == 1).all()
        assert (pair.right == 2).all()
        assert reader.newest() is None


def test_only_the_newest_pair_counts(name: str) -> None:
    with Writer(name, WIDTH, HEIGHT) as writer, Reader(name) as reader:
        for number in range(11):
            writer.write(float(number), None, picture(number), picture(number))
        pair = reader.newest()
        assert pair is not None
        assert (pair.number, pair.time, pair.pose) == (11, 10.0, None)


def test_pictures_of_another_size_are_refused(name: str) -> None:
    with Writer(name, WIDTH, HEIGHT) as writer, pytest.raises(ValueError, match="not"):
        writer.write(0.0, None, picture(0)[:-1], picture(0)[:-1])


def test_the_memory_ends_with_its_writer(name: str) -> None:
    with Writer(name, WIDTH, HEIGHT) as writer:
        assert exists(name)
        writer.write(0.0, None, picture(9), picture(9))
        reader = Reader(name)
        pair = reader.newest()
    assert not exists(name)
    assert pair is not None
    assert (pair.left == 9).all()
    reader.close()
    assert Reader(name).newest() is None


def test_no_pair_is_torn_while_another_process_writes_as_fast_as_it_can(
    name: str, children: list[subprocess.Popen[str]]
) -> None:
    start(children, WRITES, name, "0")
    with Reader(name) as reader:
        read, until = 0, time.monotonic() + 3.0
        while time.monotonic() < until or read < 50:
            if (pair := reader.newest()) is None:
                continue
            read += 1
            value = pair.number % 256
            assert pair.pose == Pose(value, value, value)
            assert (pair.time, pair.gain) == (pair.number, value)
            assert (pair.left == value).all()
            assert (pair.right == value).all()


def test_a_pair_that_changes_while_it_is_read_is_not_returned(name: str) -> None:
    with Writer(name, WIDTH, HEIGHT) as writer, Reader(name) as reader:
        writer.write(0.0, None, picture(1), picture(1))
        memory = SharedMemory(name)
        assert memory.buf is not None
        memory.buf[-1] = 0
        memory.buf[2 * (memory.size // 4)] ^= 1
        memory.close()
        assert reader.newest() is None
        assert reader.torn > 0
        writer.write(1.0, None, picture(2), picture(2))
        assert reader.newest() is not None


def test_a_writer_that_was_killed_is_replaced_by_the_next(
    name: str, children: list[subprocess.Popen[str]]
) -> None:
    first = start(children, WRITES, name, "0.001")
    with Reader(name) as reader:
        pair = soon(reader)
        assert pair is not None
        first.send_signal(signal.SIGKILL)
        first.wait()
        while reader.newest() is not None:
            pass
        start(children, WRITES, name, "0.001")
        again = soon(reader)
        assert again is not None
        assert (again.left == again.number % 256).all()


def test_memory_of_a_killed_writer_that_nobody_asked_how_it_ended_is_replaced(
    name: str, children: list[subprocess.Popen[str]]
) -> None:
    first = start(children, WRITES, name, "0.01", own_group=True)
    os.killpg(first.pid, signal.SIGKILL)
    os.waitid(os.P_PID, first.pid, os.WEXITED | os.WNOWAIT)
    assert exists(name)
    with Writer(name, WIDTH, HEIGHT):
        pass
    assert not exists(name)


def test_another_process_with_the_number_of_a_killed_writer_is_not_taken_for_it(name: str) -> None:
    left = SharedMemory(name, create=True, size=1000)
    assert left.buf is not None
    ring._HEADER.pack_into(left.buf, 0, ring._MAGIC, 1, 1, 7, 4, 4, 3, 0)
    resource_tracker.unregister(f"/{name}", "shared_memory")
    left.close()
    with Writer(name, WIDTH, HEIGHT):
        pass
    assert not exists(name)


def test_what_a_writer_left_that_nobody_could_clean_up_after_is_replaced(name: str) -> None:
    left = SharedMemory(name, create=True, size=1000)
    left.close()
    with Writer(name, WIDTH, HEIGHT) as writer, Reader(name) as reader:
        writer.write(0.0, None, picture(3), picture(3))
        assert reader.newest() is not None
    assert not exists(name)


def test_a_reader_that_was_killed_does_not_end_the_memory(
    name: str, children: list[subprocess.Popen[str]]
) -> None:
    start(children, WRITES, name, "0.01")
    reading = start(children, READS, name)
    reading.send_signal(signal.SIGKILL)
    reading.wait()
    time.sleep(0.5)
    with Reader(name) as reader:
        assert soon(reader) is not None
        assert soon(reader) is not None


def test_two_do_not_write_to_the_same_memory(name: str, children: list[subprocess.Popen[str]]) -> None:
    start(children, WRITES, name, "0.01")
    with pytest.raises(MemoryTakenError, match="writes there"):
        Writer(name, WIDTH, HEIGHT)
    with Reader(name) as reader:
        assert soon(reader) is not None


def test_memory_of_other_programs_is_left_alone(name: str) -> None:
    file = Path("/dev/shm") / name
    file.write_bytes(b"data" * 1000)
    with pytest.raises(MemoryTakenError, match="something else"):
        Writer(name, WIDTH, HEIGHT)
    with pytest.raises(MemoryTakenError, match="something else"):
        Reader(name).newest()
    assert file.read_bytes() == b"data" * 1000
    file.unlink()
