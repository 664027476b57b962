"""Where the templates of this plug-in's targets are."""

from importlib.resources import files
from pathlib import Path


def templates_of(target: str) -> Path:
    """Return the folder of a target's templates."""
    return Path(str(files("mmrs_mavlink"))) / "templates" / target
