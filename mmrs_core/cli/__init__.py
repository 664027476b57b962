"""The command line: ``mmrs``, and ``mmrs-gen`` for its command ``generate``."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from mmrs_core.cli.interruption import interruptible


def main() -> None:
    """Run ``mmrs`` with the process's arguments and exit."""
    sys.exit(interruptible(lambda: run(sys.argv[1:])))


def main_generate() -> None:
    """Run ``mmrs-gen`` with the process's arguments and exit."""
    sys.exit(interruptible(lambda: run(sys.argv[1:], program="mmrs-gen")))


def run(arguments: Sequence[str], *, program: str = "mmrs") -> int:
    """Run a command line; return the exit code. No exception escapes."""
    from mmrs_core.cli.running import run_command

    return run_command(arguments, program)
