"""Where the shipped metamodels, templates and examples lie, and which file an error is about."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from mmrs_core.errors import InternalError


def shipped(folder: str) -> Path:
    """Return the folder of shipped data with that name.

    Args:
        folder: ``metamodels``, ``codegen_templates`` or ``examples``.

    Raises:
        InternalError: if neither the wheel nor the checkout has it.
    """
    package = Path(__file__).parent
    for place in (package / "_shipped" / folder, package.parent / folder):
        if place.is_dir():
            return place
    raise InternalError(f"{folder}: not among the shipped data of {package}")


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Let errors of the system name a file: what fails while one is written names none."""
    try:
        yield
    except OSError as error:
        if error.filename is None:
            error.filename = str(path)
        raise


@contextmanager
def new_folders() -> Iterator[Callable[[Path], None]]:
    """Yield what makes a folder, and those it stands in; where anything fails, those still empty go again."""
    made: list[Path] = []

    def make(folder: Path) -> None:
        for each in [each for each in (folder, *folder.parents) if not each.exists()][::-1]:
            each.mkdir(exist_ok=True)
            made.append(each)

    try:
        yield make
    except BaseException:
        for each in reversed(made):
            with suppress(OSError):
                each.rmdir()
        raise
