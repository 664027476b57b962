"""Surroundings of simulated robots: the file that lists the objects that they can detect."""

from __future__ import annotations

import json
from math import isfinite
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_runtime.sights import Sight


def sights_in(path: Path) -> tuple[Sight, ...]:
    """Return the objects in a file of surroundings, which simulated vehicles of plug-ins read, too.

    Raises:
        UnreadableError: the file cannot be read, or is not of that format.
    """
    try:
        things = json.loads(path.read_text(encoding="utf-8"))["things"]
        return tuple(_sight(thing) for thing in things)
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror or error}") from error
    except (TypeError, KeyError, ValueError, RecursionError) as error:
        raise UnreadableError(f"{path}: no surroundings: {error!r}") from error


def _sight(thing: dict[str, object]) -> Sight:
    name = thing["name"]
    if not isinstance(name, str) or not name:
        raise ValueError(f"{name!r} is not a name")
    north, east, depth = (float(str(thing[key])) for key in ("north", "east", "depth"))
    if not all(map(isfinite, (north, east, depth))):
        raise ValueError(f"'{name}': not a finite position")
    return Sight(name, north, east, depth)
