"""What each feature of a drawing becomes: as the user says, else by its role, its words and its shape."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.drawings.drawing import Geometry, MapFeature, Role
from mmrs_core.errors import UnreadableError, UsageError
from mmrs_core.languages.naming import nearest
from mmrs_core.projects.kinds import ImportKinds, Kind

if TYPE_CHECKING:
    from mmrs_core.projects.building import Outcome

_COMMA = re.compile(r"(?<!\\),")
_UNTYPED = re.compile(r"[^\w .,:;+/()-]")
_LONGEST = 60
_WORDS = re.compile(r"[^\W_]+")
_BY_ROLE = {
    Role.HOME: "home",
    Role.RALLY_POINT: "emergency",
    Role.EMERGENCY_AREA: "emergency",
    Role.FORBIDDEN: "forbidden",
    Role.OBSTACLE: "obstacle",
}
_BY_WORDS = {
    "forbidden": ("no fly", "nofly", "no go", "nogo", "keep out", "forbidden", "restricted", "exclusion"),
    "obstacle": ("obstacle", "obstacles"),
    "emergency": ("emergency", "rally"),
    "home": ("home",),
}
_LEFT = {
    Role.INCLUSION: "robots are kept out of areas, not inside them: draw what they must not enter",
    Role.ELEMENT: "it is a context element of no type that is installed",
    Role.PATH: "it was planned already",
    Role.CHOSEN_RALLY_POINT: "it was chosen from the emergency areas",
    Role.TRACK: "it is the track of a robot or a person",
    Role.PHOTO: "it is a photo that was taken",
    Role.ACTION: "it is an action that a robot did",
    Role.EVENT: "it is an event of a run",
}
"""Why features of some roles become nothing unless the user asks for it."""


@dataclass(frozen=True, slots=True)
class Assignment:
    """What the user wants some features to become.

    Attributes:
        pattern: of names, with ``*``, ``?`` and ``[]``; with a slash, of folders and name. Its case does not
            matter. A bare ``*`` is for all but homes and areas to keep clear of.
        kind: a type of tasks or context elements, ``task`` for the usual one, ``obstacle``, ``forbidden``,
            ``emergency``, ``home`` or ``ignore``.
        attributes: values in text, by feature name; an empty one is not set.
        source: where it was said, for messages, such as ``--as 'Field*=task'``.
        strict: whether it is an error that it matches nothing.
    """

    pattern: str
    kind: str
    attributes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    source: str = ""
    strict: bool = True

    @property
    def is_for_all(self) -> bool:
        """Return whether it names nothing, so that it leaves homes and areas to keep clear of alone."""
        return not self.pattern.strip("*/")

    def matches(self, feature: MapFeature) -> bool:
        """Return whether a feature's name, or its folders and name, are of the pattern."""
        pattern, name = self.pattern.casefold(), feature.name.casefold()
        if "/" not in pattern:
            return fnmatchcase(name, pattern)
        path = "/".join((*map(str.casefold, feature.folders), name))
        return fnmatchcase(path, pattern) or fnmatchcase(path, f"*/{pattern}")


@dataclass(frozen=True, slots=True)
class Decision:
    """What a feature becomes.

    Attributes:
        kind: without a name, if it is left out.
        by: what decided, such as ``its name``.
        attributes: as the user gave them.
        reason: why it is left out.
        notes: what else there is to know.
    """

    kind: Kind
    by: str
    attributes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    reason: str = ""
    notes: tuple[str, ...] = ()


def assignment_of(text: str, source: str, strict: bool = True) -> Assignment:
    r"""Return the choice that a text states: ``PATTERN=TYPE[:NAME=VALUE,...]``; ``\,`` is a comma in a value.

    Raises:
        UsageError: if it is written otherwise.
    """
    pattern, equals, rest = text.partition("=")
    kind, _, given = rest.partition(":")
    attributes: dict[str, tuple[str, ...]] = {}
    for each in _COMMA.split(given) if given else ():
        name, said, value = each.partition("=")
        if not said or not name.strip():
            raise UsageError(f"{source}: {each!r}: expected NAME=VALUE")
        attributes[name.strip()] = (*attributes.get(name.strip(), ()), value.replace("\\,", ",").strip())
    if not equals or not pattern or not kind.strip():
        raise UsageError(f"{source}: expected PATTERN=TYPE or PATTERN=TYPE:NAME=VALUE,...")
    return Assignment(pattern.strip(), kind.strip(), attributes, source, strict)


@dataclass(frozen=True, slots=True)
class Mapped:
    """What a mapping file holds: choices, and robots as ``TYPE@FEATURE`` by name."""

    choices: tuple[Assignment, ...] = ()
    robots: Mapping[str, str] = field(default_factory=dict)


def read_mapping(file: Path) -> Mapped:
    """Return the choices of a mapping file, whose tables are ``[as]`` and ``[robots]``.

    Raises:
        UnreadableError: if it cannot be read, or holds anything else.
        UsageError: if a choice is written wrongly.
    """
    try:
        found = tomllib.loads(file.read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise UnreadableError(f"{file}: not UTF-8, as TOML has to be") from None
    except tomllib.TOMLDecodeError as fault:
        raise UnreadableError(f"{file}: not TOML: {fault}") from None
    except (ValueError, RecursionError):  # Python's limits
        raise UnreadableError(f"{file}: a number is too long, or arrays are nested too deeply") from None
    for name, table in found.items():
        if name not in ("as", "robots"):
            guess = nearest(name, ("as", "robots"))
            raise UnreadableError(
                f"{file}: [{name}]: there are the tables [as] and [robots]{guess and '; ' + guess}"
            )
        for key, value in table.items() if isinstance(table, dict) else [("", None)]:
            if not isinstance(value, str):
                raise UnreadableError(f"{file}: [{name}] {key}: expected a text in quotes")
    choices = (
        assignment_of(f"{pattern}={text}", f"{file}: {pattern!r}", strict=False)
        for pattern, text in found.get("as", {}).items()
    )
    return Mapped(tuple(choices), found.get("robots", {}))


class Chooser:
    """Decides on features: by the last choice that fits, else by what they say themselves."""

    def __init__(self, kinds: ImportKinds, choices: Sequence[Assignment], homes: Sequence[str]) -> None:
        """Take the choices, and the names of features that are homes of robots.

        Raises:
            UsageError: if a choice names an unknown kind.
        """
        self._kinds = kinds
        self._homes = {name.casefold() for name in homes}
        self._choices = [(each, self._named(each)) for each in choices]
        self._matched: dict[int, bool] = {}

    def decide(self, feature: MapFeature) -> Decision:
        """Return what a feature becomes."""
        nothing = self._kinds.own("ignore")
        if feature.name.casefold() in self._homes and feature.geometry is Geometry.POINT:
            return Decision(self._kinds.own("home"), "--robot")
        usual = self._usual(feature)
        notes = []
        for number, (choice, kind) in reversed([*enumerate(self._choices)]):
            if not choice.matches(feature) or (
                choice.is_for_all and (usual.kind.surrounds or usual.kind.name == "home")
            ):
                continue
            wanted = kind or self._usual_task(feature)
            if isinstance(wanted, str):
                return Decision(nothing, choice.source, reason=wanted)
            fits = _fits(wanted, feature)
            self._matched[number] = self._matched.get(number, False) or fits
            if fits:
                notes += _overruled(usual, wanted)
                reason = "" if wanted.name else "ignored as asked"
                return Decision(wanted, choice.source, choice.attributes, reason, tuple(notes))
            notes.append(
                f"{choice.source} does not fit: {_a(feature.geometry.value)} cannot become {wanted.name}"
            )
        return Decision(usual.kind, usual.by, usual.attributes, usual.reason, (*usual.notes, *notes))

    def unmatched(self) -> Iterator[tuple[Assignment, str]]:
        """Yield the choices that no feature matched, or only some that they do not fit, with the reason."""
        for number, (choice, kind) in enumerate(self._choices):
            if choice.is_for_all:
                continue
            if self._matched.get(number) is None:
                yield choice, "no feature has such a name, or an option that is given later takes them all"
            elif not self._matched[number]:
                yield (
                    choice,
                    f"none of the features with such a name can become {kind.name if kind else 'a task'}",
                )

    def _named(self, choice: Assignment) -> Kind | None:
        """Return the kind of a choice; None for the usual task."""
        try:
            return None if choice.kind == "task" else self._kinds.named(choice.kind)
        except UsageError as error:
            raise UsageError(f"{choice.source}: {error}") from None

    def _usual(self, feature: MapFeature) -> Decision:
        """Return what a feature becomes by what it says itself."""
        if feature.role in _BY_ROLE:
            return Decision(self._kinds.own(_BY_ROLE[feature.role]), f"it is {_a(feature.role.value)}")
        if feature.role in (Role.UNKNOWN, Role.TASK, Role.ELEMENT):
            stated = self._kinds.stated(str(feature.properties.get("type", "")))
            if stated is not None and _fits(stated, feature):
                return Decision(stated, "its property type")
            if stated is not None and feature.role is Role.ELEMENT:
                words = f"no {stated.name} is drawn as {_a(feature.geometry.value)}: it is a part of one"
                return Decision(self._kinds.own("ignore"), feature.role.value, reason=words)
        if feature.role in _LEFT:
            words = f"{_LEFT[feature.role]}; --as {pattern_of(feature)}=task makes a task of it"
            return Decision(self._kinds.own("ignore"), feature.role.value, reason=words)
        if feature.role is Role.UNKNOWN:
            for text, by in [
                (feature.name, "its name"),
                *((each, "its folder") for each in feature.folders[::-1]),
            ]:
                kind = _by_words(text, self._kinds)
                if kind is not None and _fits(kind, feature):
                    return Decision(kind, by)
        shape = shape_of(feature)
        usual = self._usual_task(feature)
        if isinstance(usual, str):
            words = f"{usual}; --as {quoted(feature.name)}=TYPE says it"
            return Decision(self._kinds.own("ignore"), shape.value, reason=words)
        waypoints = feature.role is Role.WAYPOINT and shape is Geometry.LINE
        return Decision(
            usual, "they are waypoints" if waypoints else f"it is {_a((feature.role or shape).value)}"
        )

    def _usual_task(self, feature: MapFeature) -> Kind | str:
        return self._kinds.usual(
            shape_of(feature),
            waypoint=feature.role is Role.WAYPOINT,
            structure=feature.role is Role.STRUCTURE,
        )


def shape_of(feature: MapFeature) -> Geometry:
    """Return the geometry of a feature; a point with a radius is an area."""
    return Geometry.AREA if feature.radius else feature.geometry


def quoted(name: str, folders: Sequence[str] = ()) -> str:
    """Return a pattern for a name, or for all in a folder, as it is typed into a shell.

    >>> quoted("neighbour's [old] barn"), quoted(""), quoted("", ["a", "trees"])
    ("'neighbour?s ?old? barn'", "'NAME'", "'a/trees/*'")
    """
    pattern = _UNTYPED.sub("?", "".join(f"{each.strip()}/" for each in folders) or name.strip())
    rest = "*" if folders or len(pattern) > _LONGEST else ""
    return f"'{pattern[:_LONGEST]}{rest}'" if pattern.strip("?/") else "'NAME'"


def pattern_of(feature: MapFeature | Outcome) -> str:
    """Return a pattern for a feature, which is not for those of its name in other folders."""
    return quoted("/".join((*feature.folders[-1:], feature.name)) if feature.name.strip() else "")


def _fits(kind: Kind, feature: MapFeature) -> bool:
    if kind.name == "home":
        return feature.geometry is Geometry.POINT
    return not kind.shapes or bool({feature.geometry, shape_of(feature)} & set(kind.shapes))


def _a(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeio' else 'a'} {noun}"


def _overruled(usual: Decision, wanted: Kind) -> list[str]:
    """Return a note if something to keep clear of becomes something else."""
    if not usual.kind.surrounds or usual.kind is wanted:
        return []
    return [f"not the {usual.kind.name} that it would be otherwise ({usual.by})"]


def _by_words(text: str, kinds: ImportKinds) -> Kind | None:
    words = f" {' '.join(_WORDS.findall(text.casefold()))} "
    return next(
        (kinds.own(name) for name, known in _BY_WORDS.items() if any(f" {each} " in words for each in known)),
        None,
    )
