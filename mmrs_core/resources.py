"""Where the shipped metamodels, templates and examples lie: in a wheel or in a checkout."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from mmrs_core.errors import InternalError


def shipped(folder: str) -> Path:
    """Return the folder of shipped data with that name.

    Args:
        folder: ``metamodels``, ``codegen_templates``, ``examples`` or ``migrations``.

    Raises:
        InternalError: if neither the wheel nor the checkout has it.
    """
    package = Path(str(files("mmrs_core")))
    for place in (package / "_shipped" / folder, package.parent / folder):
        if place.is_dir():
            return place
    raise InternalError(f"{folder}: not among the shipped data of {package}")
