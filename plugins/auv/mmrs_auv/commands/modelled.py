"""The vehicles of a project or a behaviour."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from mmrs_auv.vessel.sheet import Sheet
from mmrs_core.errors import UnsupportedError


def sheets_in(path: Path) -> Mapping[str, Sheet]:
    """Return the data of the underwater vehicles of a project or a behaviour, by robot.

    Raises:
        UnreadableError, InvalidModelError: the models cannot be read, or are not valid.
        UnsupportedError: there is no underwater vehicle, or data of one are missing; lists which.
    """
    raise UnsupportedError(f"{path}: no underwater vehicle")
