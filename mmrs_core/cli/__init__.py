"""The command line: ``mmrs``, and ``mmrs-gen`` for its command ``generate``."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

from mmrs_core.cli.interruption import interruptible


def main() -> None:
    """Run ``mmrs`` with the process's arguments and exit."""
    _exit_after(lambda: run(sys.argv[1:]))


def main_generate() -> None:
    """Run ``mmrs-gen`` with the process's arguments and exit."""
    _exit_after(lambda: run(sys.argv[1:], program="mmrs-gen"))


def _exit_after(command: Callable[[], int]) -> NoReturn:
    """Exit with the code that a command returns.

    The collector looks for garbage less often than usual, and not at the end: going over everything that was
    imported took a tenth of the time of short commands.
    """
    gc.set_threshold(50_000, 20, 20)
    code = interruptible(command)
    gc.freeze()
    sys.exit(code)


def run(arguments: Sequence[str], *, program: str = "mmrs") -> int:
    """Run a command line; return the exit code. No exception escapes."""
    from mmrs_core.cli.running import run_command

    return run_command(arguments, program)
