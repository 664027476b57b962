"""What commands print: results to standard output, everything else to standard error."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TextIO
from unicodedata import category

import typer

from mmrs_runtime.screen import let_end_in_nothing

if TYPE_CHECKING:
    from mmrs_core.diagnostics import Diagnostic

OUTPUT_CLOSED = 141
"""What shells report of a program whose reader went away: 128 and the number of SIGPIPE."""

_COLOURS = {"error": "31", "warning": "33", "note": "36"}
_UNSAFE = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})
_KEPT = frozenset("\n\t\u200c\u200d")


def printable(words: str) -> str:
    r"""Return words whose characters a terminal cannot take for commands.

    Control characters and those that turn the direction of writing are shown by their code.

    >>> printable("a\x1b[2Jb\u202ec")
    'a\\x1b[2Jb\\u202ec'
    """
    return words if words.isprintable() else "".join(map(_printable, words))


def one_line(words: str) -> str:
    r"""Return `printable` words on one line, however many lines a name in them has.

    >>> one_line("a\nmmrs: done\tb")
    'a\\nmmrs: done\\tb'
    """
    return _unbroken(words).replace("\t", "\\t")


def _unbroken(words: str) -> str:
    return printable(words).replace("\n", "\\n")


def _printable(character: str) -> str:
    if character in _KEPT or category(character) not in _UNSAFE:
        return character
    return character.encode("unicode_escape").decode("ascii")


def say(words: str = "", colour: str = "") -> None:
    """Print one line of the result, whatever names are in it, in a colour on a terminal.

    Args:
        words: the line.
        colour: a number of ANSI's, such as 31 for red.

    Raises:
        typer.Exit: if the reader has closed the pipe.
    """
    line = _unbroken(words)
    if colour and coloured(sys.stdout):
        line = f"\x1b[{colour}m{line}\x1b[0m"
    _write(sys.stdout, line + "\n")


def tell(words: str) -> None:
    """Print one line that is not the result: to standard error."""
    _write(sys.stderr, _unbroken(words) + "\n")


def say_json(value: object) -> None:
    """Print one JSON object, which is the whole result."""
    from mmrs_core.cli.encoding import plain

    _write(sys.stdout, json.dumps(plain(value), ensure_ascii=False, indent=2, allow_nan=False) + "\n")


def answer(value: object, lines: Iterable[str], *, as_json: bool) -> None:
    """Print a result: as one JSON object, or line by line."""
    if as_json:
        say_json(value)
    else:
        say_lines(lines)


def say_lines(lines: Iterable[str]) -> None:
    """Print lines of the result."""
    for line in lines:
        say(line)


def written(paths: Iterable[Path]) -> Iterator[str]:
    """Yield the lines about files that were written."""
    return (f"written: {path}" for path in paths)


def say_file(text: bytes) -> None:
    """Print a file, byte for byte.

    Raises:
        typer.Exit: if the reader has closed the pipe.
    """
    sys.stdout.flush()
    try:
        sys.stdout.buffer.write(text)
        sys.stdout.buffer.flush()
    except BrokenPipeError:
        _close(sys.stdout)
        raise typer.Exit(OUTPUT_CLOSED) from None
    except OSError as error:
        raise _unwritten(sys.stdout, error) from None


def report(diagnostics: Iterable[Diagnostic]) -> None:
    """Print diagnostics to standard error, in colour where a person reads them."""
    for diagnostic in diagnostics:
        words = str(_on_its_lines(diagnostic))
        severity = diagnostic.severity.value
        mark = f"{severity}: "
        if coloured(sys.stderr):
            words = words.replace(mark, f"\x1b[1;{_COLOURS[severity]}m{severity}:\x1b[0m ", 1)
        _write(sys.stderr, words + "\n")


def _on_its_lines(fault: Diagnostic) -> Diagnostic:
    """Return a fault none of whose fields begins a line of its own."""
    place = replace(fault.place, file=one_line(fault.place.file), path=one_line(fault.place.path))
    message, hint, expected = map(one_line, (fault.message, fault.hint, fault.expected))
    return replace(fault, message=message, place=place, hint=hint, expected=expected)


def coloured(stream: TextIO) -> bool:
    """Return whether to use colour: on a terminal, unless ``NO_COLOR`` is set."""
    return not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb" and stream.isatty()


@contextmanager
def progress(doing: str) -> Iterator[Callable[[str], None]]:
    """Show what is being done while it is done, on a terminal only; yield what shows how far it is.

    It is erased afterwards: by spaces where no escape sequences are wanted.
    """
    if not sys.stderr.isatty():
        yield lambda far: None
        return
    longest = 0

    def show(far: str) -> None:
        nonlocal longest
        words = f"{one_line(doing)} … {one_line(far)}".rstrip()
        _write(sys.stderr, f"\r{words.ljust(longest)}")
        longest = max(longest, len(words))

    show("")
    try:
        yield show
    finally:
        _write(sys.stderr, "\r\x1b[K" if coloured(sys.stderr) else f"\r{' ' * longest}\r")


def counted(number: int, thing: str) -> str:
    """Return a number of things.

    >>> counted(1, "robot"), counted(3, "robot")
    ('1 robot', '3 robots')
    """
    return f"{number} {thing}{'' if number == 1 else 's'}"


def _write(stream: TextIO, words: str) -> None:
    try:
        stream.write(words)
        stream.flush()
    except BrokenPipeError:
        _close(stream)
        raise typer.Exit(OUTPUT_CLOSED) from None
    except UnicodeEncodeError:
        encoding = stream.encoding or "ascii"
        stream.write(words.encode(encoding, "backslashreplace").decode(encoding))
        stream.flush()
    except OSError as error:
        raise _unwritten(stream, error) from None


def _unwritten(stream: TextIO, error: OSError) -> OSError:
    """Return an error that names its stream; what that holds back is dropped."""
    with suppress(OSError, ValueError):
        _close(stream)
    return OSError(
        error.errno, error.strerror, "standard output" if stream is sys.stdout else "standard error"
    )


def _close(stream: TextIO) -> None:
    let_end_in_nothing(stream)


def table(head: Sequence[str], rows: Sequence[Sequence[str]], *, widest: int = 200) -> Iterator[str]:
    """Yield the lines of a table; cells longer than `widest` characters are cut, except in the last column.

    >>> list(table(("a", "b"), [("1", "22")]))
    ['  a  b', '  1  22']
    """
    cells = [
        [*(_short(cell, widest) for cell in row[:-1]), " ".join(row[-1].split())] for row in (head, *rows)
    ]
    widths = [max(len(row[column]) for row in cells) for column in range(len(head))]
    for row in cells:
        padded = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        yield ("  " + "  ".join(padded)).rstrip()


def _short(cell: str, widest: int) -> str:
    one_line = " ".join(cell.split())
    return one_line if len(one_line) <= widest else one_line[: widest - 1] + "…"
