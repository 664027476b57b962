"""The robots of an imported mission: what the user asks for, their types and their homes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.drawings.drawing import MapFeature
from mmrs_core.errors import InvalidModelError, UsageError
from mmrs_core.grounding.robots import robot_type_of
from mmrs_core.languages import robot
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.reading import read_model

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.contributions.rules import Medium
    from mmrs_core.languages.element import Element


@dataclass(frozen=True, slots=True)
class RobotWanted:
    """A robot that the user asks for.

    Attributes:
        where: name of the feature that is its home; empty: the next one that is a home.
        position: latitude and longitude of its home, if it was given so.
    """

    name: str
    type: str
    where: str = ""
    position: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class TypeFile:
    """A robot type, and the file that holds it."""

    name: str
    file: Path
    element: Element


def robot_wanted(text: str, source: str) -> RobotWanted:
    """Return the robot that a text states: ``NAME=TYPE``, ``NAME=TYPE@FEATURE`` or ``NAME=TYPE@LAT,LON``.

    Raises:
        UsageError: if it is written otherwise.
    """
    name, equals, rest = text.partition("=")
    kind, _, where = rest.partition("@")
    if not equals or not name.strip() or not kind.strip():
        raise UsageError(f"{source}: expected NAME=TYPE, with @FEATURE or @LATITUDE,LONGITUDE for its home")
    numbers = where.split(",")
    try:
        latitude, longitude = map(float, numbers)
    except ValueError:
        return RobotWanted(name.strip(), kind.strip(), where.strip())
    if not (abs(latitude) <= 90 and abs(longitude) <= 180):
        raise UsageError(f"{source}: {where} is not on the Earth")
    return RobotWanted(name.strip(), kind.strip(), "", (latitude, longitude))


def types_for(
    robots: Sequence[RobotWanted], files: Sequence[Path], contributions: Contributions
) -> dict[str, TypeFile]:
    """Return robot types by name: those in the files, and installed ones that are used.

    Raises:
        UsageError: if a type is in none of them.
        UnreadableError: if a file cannot be read.
        InvalidModelError: if one holds no robot type, or two types have the same name.
    """
    given: dict[str, TypeFile] = {}
    for each in (found for file in files for found in _types_in(file, contributions)):
        if each.name in given:
            raise InvalidModelError(
                f"{each.file}: robot type {each.name!r} is in {given[each.name].file} as well"
            )
        given[each.name] = each
    installed = contributions.robot_types
    for name in dict.fromkeys(each.type for each in robots):
        if name not in given and name in installed:
            given |= {each.name: each for each in _types_in(installed[name].file, contributions)}
    unknown = next((each for each in robots if each.type not in given), None)
    if unknown is not None:
        names = {*given, *installed}
        known = (
            nearest(unknown.type, names) or f"there are {', '.join(sorted(names))}; --robots FILE adds others"
        )
        raise UsageError(f"robot {unknown.name!r}: no robot type {unknown.type!r}; {known}")
    return given


def _types_in(file: Path, contributions: Contributions) -> list[TypeFile]:
    model = read_model(file, contributions.languages)
    found = [TypeFile(root.name or "", file, root) for root in model.roots if isinstance(root, robot.Robot)]
    if not found:
        raise InvalidModelError(f"{file}: holds no robot type", model.diagnostics)
    return found


def medium_of(element: Element, contributions: Contributions) -> Medium:
    """Return where robots of a type move; in the air where the type is too incomplete to say it."""
    try:
        kind = robot_kind_of(robot_type_of(element), contributions.robot_kinds)
    except InvalidModelError:
        return "air"
    return kind.medium if kind is not None else "ground"


@dataclass(frozen=True, slots=True)
class Home:
    """Where a robot begins.

    Attributes:
        feature: that it was drawn as; None for a position that the user gave.
    """

    robot: RobotWanted
    position: tuple[float, float]
    feature: MapFeature | None = None


def homes_for(robots: Sequence[RobotWanted], drawn: Sequence[MapFeature]) -> tuple[Home, ...]:
    """Return the home of each robot: the one it names, else the next that no other has.

    Raises:
        UsageError: if there is none for a robot.
    """
    named = {each.where.casefold() for each in robots if each.where}
    free = [each for each in drawn if each.name.casefold() not in named]
    found = []
    for each in robots:
        feature = None
        if each.where:
            feature = next((one for one in drawn if one.name.casefold() == each.where.casefold()), None)
            if feature is None:
                guess = nearest(each.where, (one.name for one in drawn))
                raise UsageError(
                    f"robot {each.name!r}: no point is called {each.where!r}{guess and '; ' + guess}"
                )
        elif each.position is None:
            if not free:
                option = f"--robot '{each.name}={each.type}@"
                ways = f"{option}FEATURE' names a point, and {option}LATITUDE,LONGITUDE' gives one"
                raise UsageError(f"robot {each.name!r}: no home for it is drawn; {ways}")
            feature = free.pop(0)
        if feature is not None:
            latitude, longitude = map(float, feature.rings[0][0])
            found.append(Home(each, (latitude, longitude), feature))
        elif each.position is not None:
            found.append(Home(each, each.position))
    return tuple(found)
