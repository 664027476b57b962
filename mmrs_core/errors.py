"""Everything this package raises.

    MmrsError
    ├── InternalError        our own bug
    ├── UnreadableError      a file that is missing, too large, or no model at all
    ├── InvalidModelError    a model with faults, all of them listed
    ├── InfeasibleError      a valid mission that no plan can satisfy
    │   └── UnreachableError no route keeps the clearance
    ├── UnsupportedError     a target or backend that cannot express what a model holds
    │   └── UsageError       a target, backend or option that there is not, or not for this
    ├── PluginError          a plug-in that is broken, missing or in conflict
    └── LinkLostError        a robot or the bus that no longer answers

A caller's mistake is a `ValueError`, never one of these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar

from mmrs_runtime.vehicle import LinkLost

if TYPE_CHECKING:
    from pathlib import Path

    from mmrs_core.diagnostics import Diagnostic


class MmrsError(Exception):
    """A fault that a user of MMRS can do something about.

    Attributes:
        exit_code: what a command that ends with this error returns to the shell.
        found: what the command found before, for ``--json``.
    """

    exit_code: ClassVar[int] = 1
    found: Mapping[str, object] = MappingProxyType({})


class InternalError(MmrsError):
    """A broken promise of our own code; the message names it."""


class UnreadableError(MmrsError):
    """An input that cannot be read as a model at all.

    Attributes:
        code: of the problem, as diagnostics have it; empty where the input is not a file of a model.
        reason: the problem, without its place.
        file: in which it is, if there is a code.
        line: counted from 1; 0 where unknown.
        diagnostics: this problem and those of other files that were to be read together with it, if any were.
    """

    exit_code = 3

    def __init__(
        self,
        message: str,
        diagnostics: Sequence[Diagnostic] = (),
        *,
        code: str = "",
        reason: str = "",
        file: str = "",
        line: int = 0,
    ) -> None:
        super().__init__(message)
        self.diagnostics = tuple(diagnostics)
        self.code, self.reason, self.file, self.line = code, reason or message, file, line

    @classmethod
    def of(cls, code: str, reason: str, file: Path | str, line: int = 0) -> UnreadableError:
        """Return the error for a fault of that code, in a file, on a line if it is known."""
        where = f"{file}:{line}" if line else f"{file}"
        return cls(f"{where}: {reason}", code=code, reason=reason, file=str(file), line=line)


class InvalidModelError(MmrsError):
    """A model that breaks its metamodel or a constraint.

    Attributes:
        diagnostics: every fault found, errors first.
    """

    def __init__(self, message: str, diagnostics: Sequence[Diagnostic] = ()) -> None:
        super().__init__(message)
        self.diagnostics = tuple(diagnostics)


class InfeasibleError(MmrsError):
    """A mission that no plan can satisfy.

    Attributes:
        reasons: what is short, by how much, and where; at least one line.
    """

    exit_code = 4

    def __init__(self, message: str, reasons: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.reasons = tuple(reasons) or (message,)


class UnreachableError(InfeasibleError):
    """No route keeps the required clearance between two positions."""


class UnsupportedError(MmrsError):
    """A target or backend was given something it cannot express.

    Attributes:
        elements: each thing that cannot be expressed, with its robot and move.
    """

    def __init__(self, message: str, elements: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.elements = tuple(elements)


class UsageError(UnsupportedError):
    """A target, backend or option was asked for that no plug-in provides, or that is for something else."""

    exit_code = 2


class PluginError(MmrsError):
    """A plug-in that is broken, missing or in conflict with another."""


class LinkLostError(MmrsError, LinkLost):
    """A robot, vehicle or bus that stopped answering."""

    exit_code = 5
