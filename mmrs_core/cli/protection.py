"""Keeps what people wrote from being overwritten by what commands write."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from mmrs_core.errors import MmrsError, UnreadableError
from mmrs_core.languages import behaviour
from mmrs_core.languages.element import descendants
from mmrs_core.languages.reading import read_model

if TYPE_CHECKING:
    from mmrs_core.languages.model import Model
    from mmrs_core.languages.registry import Registry


class ProtectedError(MmrsError):
    """An output that would overwrite a hand-written file."""

    exit_code: ClassVar[int] = 2


def files_of(models: Iterable[Model]) -> tuple[Path, ...]:
    """Return the files that models were read from, those that they refer to included."""
    every = [each for model in models for each in (model, *model.linked)]
    return tuple(dict.fromkeys(each.file for each in every if isinstance(each.file, Path)))


def refuse_inputs(outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """Refuse outputs that are inputs, by whatever name or link.

    Raises:
        ProtectedError: if one is; names both.
    """
    inputs = tuple(inputs)
    for output in outputs:
        same = next((file for file in inputs if _is_same(output, file)), None)
        if same is not None:
            raise ProtectedError(f"{output}: is read by this command, as {same}, and is not replaced")


def refuse_inside(output: Path, folder: Path) -> None:
    """Refuse a file that lies in a folder.

    Raises:
        ProtectedError: if it does.
    """
    if output.resolve().parent == folder.resolve():
        raise ProtectedError(f"{output}: lies in {folder}, which is for robot types only")


def refuse_handwritten(file: Path, registry: Registry, way_out: str) -> None:
    """Refuse to replace a file, unless it is missing, empty, or holds a behaviour that was planned.

    A planned behaviour has moves that name the rule that they follow from.

    Args:
        file: about to be written.
        registry: the metamodels.
        way_out: what the user can do instead, for the message.

    Raises:
        ProtectedError: if it holds anything else.
    """
    if file.is_file() and file.stat().st_size and not _is_planned(file, registry):
        raise ProtectedError(f"{file}: was not planned but written by hand, and is not replaced; {way_out}")


def _is_same(output: Path, file: Path) -> bool:
    try:
        return output.samefile(file)
    except OSError:  # one of them does not exist yet
        return output.resolve() == file.resolve()


def _is_planned(file: Path, registry: Registry) -> bool:
    try:
        roots = read_model(file, registry).roots
    except UnreadableError:
        return False
    return any(
        isinstance(element, behaviour.Move) and element.rule
        for root in roots
        if isinstance(root, behaviour.Behaviour)
        for element in descendants(root)
    )
