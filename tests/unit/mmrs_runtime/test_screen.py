"""Robots rely on a process whether anybody reads what it says or not."""

import io
import os
import threading
import time
from contextlib import redirect_stderr

import pytest
from full_pipes import MOST, full_pipe
from stalls import Stalls

from mmrs_runtime.screen import say, unfailing

pytestmark = pytest.mark.real_time("parts of flights")

LINE = "'Alba': LAND"


@pytest.fixture
def full():
    """Return a pipe that nobody reads and that takes nothing any more, and what writes to it."""
    with full_pipe() as pipe:
        yield pipe


def test_nobody_waits_for_a_reader_that_sleeps(full):
    reads, stream = full
    rescue = threading.Timer(8.0, os.read, [reads, MOST])
    rescue.start()
    stalls, begun = Stalls(), time.monotonic()
    with redirect_stderr(stream), unfailing():
        for _ in range(100):
            say(LINE)
    seconds = time.monotonic() - begun
    rescue.cancel()
    assert seconds < 3.0 + stalls.seconds


def test_a_reader_who_wakes_is_told_how_much_was_left_out(full):
    reads, stream = full
    with redirect_stderr(stream), unfailing():
        for _ in range(3):
            say(LINE)
        os.read(reads, MOST)
        say("'Alba': stopped")
    assert os.read(reads, MOST) == b"(lines left out here, which were not read: 3)\n'Alba': stopped\n"


class Busy(io.StringIO):
    """Refuses the first words, as a stream does in the middle of whose writing a signal is heeded."""

    refuses = True

    def write(self, words: str) -> int:
        if self.refuses:
            self.refuses = False
            raise RuntimeError("reentrant call")
        return super().write(words)


def test_words_that_were_refused_are_counted_as_left_out():
    stream = Busy()
    with redirect_stderr(stream), unfailing():
        say("stopping")
        say("stopped")
    assert stream.getvalue() == "(lines left out here, which were not read: 1)\nstopped\n"


def test_long_words_arrive_as_they_are_where_somebody_reads():
    reads, writes = os.pipe()
    words = "".join(f"{number}\n" for number in range(5000))
    with os.fdopen(writes, "w") as stream, redirect_stderr(stream), unfailing():
        say(words)
    with os.fdopen(reads) as heard:
        assert heard.read() == f"{words}\n"


class Interrupted(io.StringIO):
    """Says something else in the middle of its first line, as a signal's handler does."""

    def write(self, words: str) -> int:
        if "first" in words:
            say("stopping")
        return super().write(words)


def test_what_a_signals_handler_says_in_the_middle_of_a_line_follows_that_line():
    stream = Interrupted()
    with redirect_stderr(stream), unfailing():
        say("the first line")
        assert stream.getvalue() == "the first line\nstopping\n"
