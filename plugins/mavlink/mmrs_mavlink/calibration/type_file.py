"""Figures in the file of a robot type: only what they change is changed, and comments stay."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.analysis.fixes.repair import with_edits
from mmrs_core.contributions.fixes import Edit, with_value
from mmrs_core.errors import InternalError, InvalidModelError, UnreadableError, UnsupportedError
from mmrs_core.grounding.features import children, number, text
from mmrs_core.languages.element import Element, Unknown, metaclass_of
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import replace_file
from mmrs_core.languages.xmi.markup import Markup, Tag

from .attributes import CAPABILITY, TIMING, written
from .figures import COULOMBS, MISSION, STEP, Figure

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry

_ROBOT = ("urn:mmrs:robot:1.0", "Robot")


@dataclass(frozen=True, slots=True)
class TypeFile:
    """The file of a robot type.

    Attributes:
        path: as the user gave it. registry: the metamodels.
        data: what the file holds.
        robot: the type. number: of its movement capability that the figures are for.
    """

    path: Path
    registry: Registry
    data: bytes
    robot: Element
    number: int

    @property
    def capacity(self) -> float | None:
        """Return the charge of all its batteries, coulombs; None where it has none or not all are known."""
        charges = [number(each, "capacity") for each in children(self.robot, "batteries")]
        known = [each for each in charges if each is not None]
        return sum(known) * COULOMBS if known and len(known) == len(charges) else None

    def current(self, name: str, flown_as: str = "") -> float | None:
        """Return the value that the type has for a figure; None where it has none."""
        capability = children(self.robot, "movementCapabilities")[self.number]
        if not flown_as:
            return number(capability, name)
        timings = (each for each in children(capability, "legTimings") if text(each, "flownAs") == flown_as)
        return next((number(each, name) for each in timings), None)

    def write(self, figures: tuple[Figure, ...]) -> None:
        """Put the medians of figures into the file, all or none.

        Raises:
            UnreadableError: the file was changed meanwhile.
            InvalidModelError: the type would have faults with these figures; nothing is written.
            OSError: the file cannot be written; it is as it was before.
        """
        after = self.rewritten(figures)
        if self.path.read_bytes() != self.data:
            raise UnreadableError(f"{self.path}: was changed meanwhile; nothing was written")
        replace_file(self.path, after)

    def rewritten(self, figures: tuple[Figure, ...]) -> bytes:
        """Return the text of the file with the medians of figures.

        Raises:
            InvalidModelError: the type would have faults with these figures.
        """
        markup = Markup(self.data, str(self.path))
        (robot,) = markup.models()
        capability = robot.named("movementCapabilities")[self.number]
        after = with_edits(self.data, set(_edits(capability, figures, markup)))
        if after is None:
            raise InternalError(f"{self.path}: edits of different figures overlap")
        found = read_model(self.path, self.registry, unsaved={self.path.resolve(): after})
        if found.diagnostics:
            raise InvalidModelError(f"{self.path}: has faults with these figures", found.diagnostics)
        return after


def type_in(path: Path, registry: Registry, payload: float) -> TypeFile:
    """Return the file of a robot type.

    Args:
        path: of an XMI file.
        registry: the metamodels.
        payload: that was carried in the flight, kilograms.

    Raises:
        UnreadableError: there is no such file, or it cannot be read.
        InvalidModelError: the model is invalid.
        UnsupportedError: it is another model, or in JSON, or has no movement capability for that payload.
    """
    if is_json(path.name):
        raise UnsupportedError(f"{path}: figures are written into XMI only; 'mmrs convert' converts it")
    model = read_model(path, registry)
    if model.diagnostics:
        raise InvalidModelError(f"{path}: not valid", model.diagnostics)
    if (
        len(model.roots) != 1
        or isinstance(root := model.roots[0], Unknown)
        or not metaclass_of(root).is_kind(*_ROBOT)
    ):
        raise UnsupportedError(f"{path}: not a robot type")
    payloads = [number(each, "payloadWeight") or 0.0 for each in children(root, "movementCapabilities")]
    if payload not in payloads:
        known = ", ".join(f"{each:g}" for each in payloads)
        raise UnsupportedError(
            f"{path}: has no movement capability for a payload of {payload:g} kg; known are {known}"
        )
    return TypeFile(path, registry, path.read_bytes(), root, payloads.index(payload))


def _edits(capability: Tag, figures: tuple[Figure, ...], markup: Markup) -> Iterator[Edit]:
    """Yield the changes of a movement capability."""
    yield from _with(capability, written(figures, CAPABILITY), markup)
    timings: Mapping[str, Tag] = {
        flown.value: each
        for each in capability.named("legTimings")
        if (flown := each.attribute("flownAs")) is not None
    }
    added = []
    for flown_as in (STEP, MISSION):
        values = written(figures, TIMING, flown_as)
        if values and flown_as in timings:
            yield from _with(timings[flown_as], values, markup)
        elif values:
            added.append(
                f'<legTimings flownAs="{flown_as}"{"".join(_attribute(*each) for each in values.items())}/>'
            )
    if added:
        yield _inside(capability, added, markup)


def _attribute(name: str, value: str) -> str:
    return f' {name}="{value}"'


def _with(tag: Tag, values: Mapping[str, str], markup: Markup) -> Iterator[Edit]:
    """Yield what gives a tag attributes; those that it has not stand behind the others."""
    missing = []
    for name, value in values.items():
        if (attribute := tag.attribute(name)) is not None:
            yield with_value(attribute, value)
        else:
            missing.append(_attribute(name, value))
    if missing and tag.attributes:
        end = tag.attributes[-1].value_end + 1
        yield Edit(end, end, "".join(missing))
    elif missing:
        end = tag.begin + 1 + len(tag.name.encode())
        yield Edit(end, end, "".join(missing))


def _inside(tag: Tag, lines: list[str], markup: Markup) -> Edit:
    """Return what puts lines into a tag, before its end, indented by two more than it is."""
    start = markup.data.rfind(b"\n", 0, tag.begin) + 1
    before = markup.data[start : tag.begin].decode()
    indent = before if not before.strip() else ""
    if tag.closing == tag.end:
        text = "".join(f"\n{indent}  {line}" for line in lines)
        return Edit(tag.end - 2, tag.end, f">{text}\n{indent}</{tag.name}>")
    begin = markup.data.rfind(b"\n", 0, tag.closing) + 1
    alone = not markup.data[begin : tag.closing].strip()
    if alone:
        return Edit(begin, begin, "".join(f"{indent}  {line}\n" for line in lines))
    return Edit(tag.closing, tag.closing, "".join(f"\n{indent}  {line}" for line in lines) + f"\n{indent}")
