"""Takes texts and paths as they were typed.

typer has pydantic look at every value, and importing that takes longer than validating a mission.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import typer

_MAKERS: Mapping[object, Callable[[Any], object]] = {str: str, list[str]: str, Path: Path, list[Path]: Path}


class AsTyped:
    """How an argument or option gets its value, instead of typer's own conversion."""

    def __init__(self, make: Callable[[Any], object] | None, own: Callable[[], Any]) -> None:
        self._make = make
        self._own = own

    def coerce(self, value: Any, param: Any, ctx: object) -> object:
        """Return the value for the command; typer is asked unless it is a default, a text or a readable path.

        Raises:
            typer.BadParameter: if typer refuses it.
        """
        many = param.multiple or param.nargs == -1
        if value is None:
            return () if many else None
        if value is param.default and not isinstance(value, Path):
            return value
        made = [self._make(each) for each in (value if many else (value,))] if self._make else [None]
        if None in made or any(isinstance(each, Path) and _is_unreadable(each) for each in made):
            return self._own().coerce(value, param=param, ctx=ctx)
        return made if many else made[0]


def _is_unreadable(path: Path) -> bool:
    return os.access(path, os.F_OK) and not os.access(path, os.R_OK)


def take_as_typed(command: Any, line: Sequence[str]) -> None:
    """Let a command, and those in it that a command line names, take values as they were typed."""
    for parameter in command.get_params(typer.Context(command)):
        made = AsTyped(_MAKERS.get(parameter.type_descriptor.annotation), parameter.get_runtime_param)
        parameter.get_runtime_param = lambda made=made: made
        if parameter.param_type_name == "argument":
            parameter.display_type_rich = lambda ctx: None  # its help says more than "<list[Path]>"
    for name, inner in getattr(command, "commands", {}).items():
        if name in line:
            take_as_typed(inner, line)
