"""Questions to people at a terminal, asked again until the answer is one."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TypeVar

from mmrs_core.cli.output import tell
from mmrs_core.errors import UsageError

Answer = TypeVar("Answer")


def is_terminal() -> bool:
    """Return whether a person can be asked."""
    return sys.stdin.isatty() and sys.stderr.isatty()


def ask(question: str, understood: Callable[[str], Answer], default: str = "") -> Answer:
    """Return what an answer means; otherwise print the reason, and ask again.

    Args:
        understood: what an answer means; raises UsageError.
        default: the answer of an empty line; without one, empty lines are answers as well.

    Raises:
        UsageError: if the input ends.
    """
    while True:
        sys.stderr.write(f"{question}{f' [{default}]' if default else ''}: ")
        sys.stderr.flush()
        line = sys.stdin.readline()
        if not line:
            tell("")
            raise UsageError("the input ended before all questions were answered; nothing written")
        try:
            return understood(line.strip() or default)
        except UsageError as error:
            tell(f"  {error}")
            for each in error.elements:
                tell(f"    {each}")
