"""What reaches the terminal is safe to show, and goes to the right stream."""

import errno
import io
import sys

import pytest
import typer

from mmrs_core.cli import output
from mmrs_core.diagnostics import Diagnostic, Place, Severity

FAULT = Diagnostic("MML001", Severity.ERROR, "task 'a': error: has no place", Place("m.xmi", 3))


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Closed(io.StringIO):
    def __init__(self, descriptor):
        super().__init__()
        self._descriptor = descriptor

    def write(self, text):
        raise BrokenPipeError

    def fileno(self):
        return self._descriptor


def test_results_go_to_standard_output_and_diagnostics_to_standard_error(capsys):
    output.say("done")
    output.report([FAULT])
    captured = capsys.readouterr()
    assert captured.out == "done\n"
    assert captured.err == "m.xmi:3: error: task 'a': error: has no place [MML001]\n"


@pytest.mark.parametrize("character", ["\x1b", "\x07", "\x9b", "\u202e", "\u2066", "\r"])
def test_characters_that_steer_a_terminal_are_shown_by_code(character):
    assert character not in output.printable(f"a{character}b")


@pytest.mark.parametrize("words", ["L'Aquila", "北の畑", "crème brûlée", "می\u200cخواهم", "two\nlines"])
def test_ordinary_words_stay_as_they_are(words):
    assert output.printable(words) == words


def test_colour_is_for_terminals_only_and_not_where_it_is_unwanted(monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert output.coloured(Terminal())
    assert not output.coloured(io.StringIO())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not output.coloured(Terminal())


def test_only_the_severity_is_coloured(monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    output.report([FAULT])
    assert terminal.getvalue().count("\x1b[1;31m") == 1
    assert terminal.getvalue().startswith("m.xmi:3: \x1b[1;31merror:\x1b[0m task")


def test_progress_shows_on_a_terminal_only_and_leaves_no_trace(monkeypatch, capsys):
    with output.progress("planning"):
        pass
    assert capsys.readouterr().err == ""
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    with output.progress("planning"):
        assert "planning" in terminal.getvalue()
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_progress_tells_how_far_it_is_and_leaves_no_trace_of_the_longest(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("NO_COLOR", "1")
    with output.progress("simulating") as show:
        assert terminal.getvalue() == "\rsimulating …"
        show("10:05")
        show("0:07")
        assert terminal.getvalue().endswith("\rsimulating … 10:05\rsimulating … 0:07 ")
    assert terminal.getvalue().endswith(f"\r{' ' * len('simulating … 10:05')}\r")


def test_a_reader_that_went_away_ends_the_command_quietly(monkeypatch, tmp_path):
    with (tmp_path / "pipe").open("w") as file:
        monkeypatch.setattr(sys, "stdout", Closed(file.fileno()))
        with pytest.raises(typer.Exit) as ending:
            output.say("words")
    assert ending.value.exit_code == 141


def test_a_stream_of_few_letters_gets_codes_for_the_others(monkeypatch):
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", stream)
    output.say("più")
    assert stream.buffer.getvalue() == b"pi\\xf9\n"


def test_a_name_of_several_lines_begins_no_line_of_its_own(capsys):
    bad = "a\nmmrs: done\tb"
    output.report([Diagnostic("MML001", Severity.ERROR, bad, Place(bad, 3, f"/{bad}"), bad, bad)])
    shown = capsys.readouterr().err
    assert "\nmmrs" not in shown
    assert "\t" not in shown
    assert len(shown.splitlines()) == 4


class Full(Closed):
    def write(self, text):
        raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("name", ["stdout", "stderr"])
def test_a_stream_on_a_full_disk_is_named(monkeypatch, tmp_path, name):
    with (tmp_path / "x").open("wb") as file:
        monkeypatch.setattr(sys, name, Full(file.fileno()))
        with pytest.raises(
            OSError, match=f"standard {name[3:].replace('out', 'output').replace('err', 'error')}"
        ):
            output.say("x") if name == "stdout" else output.tell("x")


def test_a_name_of_several_lines_begins_no_line_of_a_result_or_a_note(capsys):
    output.say("'a\nmmrs: done': 3 tasks")
    output.tell("'a\r\nb'")
    captured = capsys.readouterr()
    assert captured.out == "'a\\nmmrs: done': 3 tasks\n"
    assert captured.err == "'a\\r\\nb'\n"
