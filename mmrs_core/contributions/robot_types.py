"""Robot types that plug-ins ship: descriptions of real machines to begin a mission with."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class RobotTypeFile:
    """A model file with one robot type.

    Attributes:
        name: of the type, as the file states it; missions refer to it.
        file: a model of the Robot Language; its comments name the sources of its figures.
        description: one line: what the machine is for.
    """

    name: str
    file: Path
    description: str
