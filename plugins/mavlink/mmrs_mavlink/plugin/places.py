"""Where the templates of this plug-in's targets are, and the language of the moves that it knows best."""

from importlib.resources import files
from pathlib import Path

MULTICOPTER = "urn:mmrs:multicopter:1.0"


def templates_of(target: str) -> Path:
    """Return the folder of a target's templates."""
    return Path(str(files("mmrs_mavlink"))) / "templates" / target
