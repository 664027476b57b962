"""Finds what a picture of models cannot show, or not whole, and why."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import accumulate

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.grounding.coordinates import Ground
from mmrs_core.grounding.frame import NOWHERE, is_geographic, is_relative
from mmrs_core.languages.element import Element, Unknown, descendants, place_of
from mmrs_core.languages.json_form.unknown import kept_name
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.pictures.preview.picture import MapGap

_UNREADABLE = ("XMI", "ECO", "FIL", "PRJ", "MIG", "GND")
"""The beginnings of the codes of problems that leave a model without something that its file holds."""
_CONTRADICTORY = ("CTX003", "CTX004", "CTX005", "CTX007")
"""The codes of areas whose outline, heights or safety distance cannot be meant."""
_MOST_REASONS = 5


def is_coordinate(element: object) -> bool:
    """Return whether an element is a coordinate, or an unknown one that may stand for a coordinate."""
    return isinstance(element, Element) and (
        isinstance(element, Unknown) or is_geographic(element) or is_relative(element)
    )


class Gaps:
    """What is missing from elements: problems of reading them, and coordinates without a position."""

    def __init__(self, models: ModelSet, ground: Ground, problems: Iterable[Diagnostic]) -> None:
        self._ground = ground
        read = (problem for model in models.models for problem in model.diagnostics)
        self._problems: dict[tuple[str, Place, str], Diagnostic] = {
            (problem.code, problem.place, problem.message): problem
            for problem in (*read, *ground.faults, *problems)
            if problem.severity is Severity.ERROR and problem.code.startswith(_UNREADABLE + _CONTRADICTORY)
        }
        self._by_path: dict[tuple[str, str], list[Diagnostic]] = {}
        self._by_line: dict[tuple[str, str, int], list[Diagnostic]] = {}
        for problem in self._problems.values():
            file, line, path = problem.place.file, problem.place.line, problem.place.path or "/"
            self._by_line.setdefault((file, path, line), []).append(problem)
            for each in ("/", *paths_to(path)):
                self._by_path.setdefault((file, each), []).append(problem)
        self._explained: set[Diagnostic] = set()

    def problems_of(self, element: Element) -> list[Diagnostic]:
        """Return the problems of reading an element and what it contains."""
        place = place_of(element)
        found = self._by_path.get((place.file, place.path), [])
        if isinstance(element, Unknown):
            # What an unknown element is, a problem of its owner in its line says.
            owner = place.path.rpartition("/")[0] or "/"
            found = [*found, *self._by_line.get((place.file, owner, place.line), [])]
        return found

    def short(self, element: Element) -> str:
        """Return in a few words why an element is not whole; empty: it is."""
        problems = self.problems_of(element)
        return self._lost(element) or (problems[0].message if problems else "")

    def gap(self, kind: str, name: str, element: Element, *, drawn: bool) -> MapGap:
        """Return why an element is not drawn, or not whole.

        Args:
            kind: such as ``forbidden area``.
            name: of an element that has none of its own, or several share it.
        """
        problems = self.problems_of(element)
        self._explained.update(problems)
        place = problems[0].place if problems else place_of(element)
        lost = self._lost(element)
        causes = [problem for problem in problems if problem.code != NOWHERE] or problems
        reasons = [*([lost] if lost else []), *dict.fromkeys(problem.message for problem in causes)]
        more = len(reasons) - _MOST_REASONS
        shown = [*reasons[:_MOST_REASONS], *([f"and {more} more"] if more > 0 else [])]
        own = kept_name(element) if isinstance(element, Unknown) else ""
        otherwise = "its class is unknown" if isinstance(element, Unknown) else "it has no position"
        return MapGap(f"{kind} {(own or name)!r}", "; ".join(shown) or otherwise, source_of(place), drawn)

    def others(self) -> Iterator[MapGap]:
        """Yield every problem that is in no gap so far: what it is about is in no element that is drawn."""
        for problem in self._problems.values():
            if problem not in self._explained:
                file, path = problem.place.file.rpartition("/")[2], problem.place.path.strip("/")
                yield MapGap(f"{file}, {path}" if path else file, problem.message, source_of(problem.place))

    def _lost(self, element: Element) -> str:
        """Return how many of an element's coordinates have no position; empty: all have one."""
        coordinates = [each for each in descendants(element) if is_coordinate(each)]
        lost = sum(each not in self._ground.positions or isinstance(each, Unknown) for each in coordinates)
        if not lost:
            return ""
        if len(coordinates) == 1:
            return "its position is unknown"
        has = "has" if lost == 1 else "have"
        return f"{lost} of {len(coordinates)} coordinates {has} no position"


def paths_to(path: str) -> list[str]:
    """Return the paths of an element and of all that contain it, from the outermost; the root's left out.

    >>> paths_to("/tasks[2]/shell[0]")
    ['/tasks[2]', '/tasks[2]/shell[0]']
    """
    steps = path.strip("/")
    return [*accumulate(steps.split("/"), "{}/{}".format, initial="")][1:] if steps else []


def source_of(place: Place) -> str:
    """Return the name of a file and the line in it."""
    return f"{place.file.rpartition('/')[2]}:{place.line}" if place.line else place.file
