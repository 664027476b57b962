"""The code in pages of Markdown: found, and run as a reader would."""

import contextlib
import doctest
import json
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^(?P<indent> *)```(?P<language>[\w-]*)(?: +title=\"(?P<title>[^\"]*)\")? *$")
EXIT = re.compile(r"exit code (\d+)")
PATIENCE = 240.0
"""Seconds that a command may take."""


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block of a page.

    Attributes:
        language: behind the fence; empty: none.
        title: of the block: the path of a file that it is, or of a console the exit code that it ends with.
        line: of the opening fence, from 1.
    """

    page: str
    language: str
    title: str
    text: str
    line: int

    @property
    def where(self) -> str:
        return f"{self.page}:{self.line}"


def blocks_of(text: str, page: str) -> list[Block]:
    """Return the fenced blocks of a page in order; those in tabs and notes count like any other."""
    found = []
    lines = text.splitlines()
    index = 0
    while index < len(lines):
        fence = FENCE.match(lines[index])
        index += 1
        if fence is None:
            assert not lines[index - 1].lstrip().startswith("```"), f"{page}:{index}: not a fence: check it"
            continue
        begin, indent = index, fence["indent"]
        while lines[index] != f"{indent}```":
            index += 1
            assert index < len(lines), f"{page}:{begin}: the block is not closed"
        body = "".join(f"{line.removeprefix(indent)}\n" for line in lines[begin:index])
        found.append(Block(page, fence["language"], fence["title"] or "", body, begin))
        index += 1
    return found


class Reader:
    """Somebody who does what a page says, in the order in which it says it.

    Attributes:
        folder: where the reader is now: an empty one at first.
    """

    def __init__(self, folder: Path, variables: Mapping[str, str] | None = None) -> None:
        """Read in a folder; `variables`: of the reader's terminal; None: those of `environment`."""
        self.folder, self._variables = folder, environment() if variables is None else variables
        self._names: dict[str, object] = {"__name__": "page"}

    def follow(self, block: Block) -> None:
        """Do what a block says.

        Raises:
            AssertionError: something else came of it than the page tells.
        """
        if block.language == "console":
            self._type(block)
        elif block.language == "python" and not block.title:
            self._evaluate(block)
        elif block.language in PARSERS:
            PARSERS[block.language](block.text)
        if block.title and block.language != "console":
            path = self.folder / block.title
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")

    def _type(self, block: Block) -> None:
        expected = EXIT.fullmatch(block.title)
        code = int(expected[1]) if expected else 0
        commands = commands_of(block)
        for number, (command, told) in enumerate(commands):
            if command.startswith("cd ") and "&&" not in command:
                self.folder /= command.removeprefix("cd ")
                continue
            done = subprocess.run(
                ["bash", "-c", command],
                cwd=self.folder,
                env=self._variables,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=PATIENCE,
            )
            wanted = code if number == len(commands) - 1 else 0
            assert done.returncode == wanted, f"{block.where}: {command}: {done.returncode}\n{done.stdout}"
            if told:
                assert alike(told, done.stdout), (
                    f"{block.where}: {command} prints\n{done.stdout}\nnot\n{told}"
                )

    def _evaluate(self, block: Block) -> None:
        with contextlib.chdir(self.folder):
            if ">>>" not in block.text:
                exec(compile(block.text, block.where, "exec"), self._names)  # noqa: S102  the page's code
                return
            test = doctest.DocTestParser().get_doctest(block.text, self._names, block.where, None, 0)
            said: list[str] = []
            doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=said.append, clear_globs=False)
            assert not said, "".join(said)
            self._names = test.globs


def commands_of(block: Block) -> list[tuple[str, str]]:
    """Return the commands of a console, each with what is shown of its output."""
    found: list[tuple[str, str]] = []
    for line in block.text.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], ""))
        else:
            assert found, f"{block.where}: output without a command"
            command, told = found[-1]
            found[-1] = (command, f"{told}{line}\n")
    return found


def alike(told: str, printed: str) -> bool:
    """Return whether output is what a page shows of it.

    Three dots in a line stand for anything in that line, a line of nothing else for any lines, or none.
    """
    lines = (
        "(?:.*\\n)*" if line.strip() == "..." else ".*".join(map(re.escape, line.split("..."))) + "\\n"
        for line in told.splitlines()
    )
    return re.fullmatch("".join(lines), printed if printed.endswith("\n") else f"{printed}\n") is not None


def environment(programs: Path | None = None) -> dict[str, str]:
    """Return the variables of a terminal without colours in which the commands are found."""
    folders = [programs, Path(sys.executable).parent, os.environ["PATH"]]
    return os.environ | {
        "PATH": os.pathsep.join(str(each) for each in folders if each is not None),
        "NO_COLOR": "1",
        "COLUMNS": "120",
    }


PARSERS = {"json": json.loads, "toml": tomllib.loads}
