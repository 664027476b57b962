"""The option by which commands tell faults to editors and continuous integration."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

STANDARD_OUTPUT = Path("-")

Sarif = Annotated[
    Path | None,
    typer.Option("--sarif", metavar="FILE", help="Write diagnostics as SARIF 2.1.0 (- for stdout)."),
]


def refuse_two_outputs(sarif: Path | None, other: bool) -> None:
    """Do nothing unless SARIF and something else are both to be the whole of standard output.

    Raises:
        typer.BadParameter: if they are.
    """
    if sarif == STANDARD_OUTPUT and other:
        raise typer.BadParameter("--sarif - is the whole of standard output; name a file instead")
