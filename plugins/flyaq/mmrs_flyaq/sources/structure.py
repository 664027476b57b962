"""The classes of a source dialect, and their notation in mapping files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum


class Sort(Enum):
    """What a feature holds."""

    ATTRIBUTE = "attribute"
    CONTAINED = "contained"
    REFERENCE = "reference"


@dataclass(frozen=True, slots=True)
class SourceFeature:
    """A feature of a source class.

    Attributes:
        type: ``package.Class`` of what it contains or refers to; of an attribute, whatever it is called.
        many: whether it may hold several.
    """

    name: str
    type: str
    sort: Sort
    many: bool = False


@dataclass(frozen=True, slots=True)
class SourceClass:
    """A source class; ``name`` and ``supertypes`` are ``package.Class``, ``features`` its own only."""

    name: str
    supertypes: tuple[str, ...] = ()
    features: tuple[SourceFeature, ...] = ()


@dataclass(frozen=True, slots=True)
class Structure:
    """Source classes by ``package.Class``."""

    classes: Mapping[str, SourceClass] = field(default_factory=dict)

    def has(self, name: str) -> bool:
        """Return whether there is a class of that name."""
        return name in self.classes

    def ancestry(self, name: str) -> tuple[str, ...]:
        """Return the class and all its supertypes, nearer ones first; circles do no harm."""
        found: dict[str, None] = {}
        pending = [name]
        while pending:
            current = pending.pop(0)
            if current not in found:
                found[current] = None
                known = self.classes.get(current)
                pending += known.supertypes if known else ()
        return tuple(found)

    def features(self, name: str) -> Iterator[SourceFeature]:
        """Yield the features of a class, inherited ones included."""
        for ancestor in self.ancestry(name):
            if ancestor in self.classes:
                yield from self.classes[ancestor].features

    def feature(self, name: str, feature: str) -> SourceFeature | None:
        """Return a feature of a class or of a supertype; None if it has none of that name."""
        return next((found for found in self.features(name) if found.name == feature), None)

    def over(self, other: Structure, packages: Iterable[str]) -> Structure:
        """Return the other structure with all classes of some packages replaced by those from here."""
        replaced = set(packages)
        rest = {name: kind for name, kind in other.classes.items() if name.partition(".")[0] not in replaced}
        own = {name: kind for name, kind in self.classes.items() if name.partition(".")[0] in replaced}
        return Structure({**rest, **own})


ATTRIBUTES = ("text", "number", "truth")


def declared_structure(packages: Mapping[str, Mapping[str, Sequence[str]]]) -> Structure:
    """Return the classes that a mapping declares, by package.

    Raises:
        ValueError: if a type or supertype is neither an attribute's nor a declared class.
    """
    names = {f"{package}.{name}" for package, classes in packages.items() for name in classes}
    found = {
        f"{package}.{name}": _class(package, name, lines, names)
        for package, classes in packages.items()
        for name, lines in classes.items()
    }
    return Structure(found)


def _class(package: str, name: str, lines: Sequence[str], names: set[str]) -> SourceClass:
    where = f"{package}.{name}"
    supertypes = tuple(_known(line.strip(), package, names, where) for line in lines if ":" not in line)
    return SourceClass(where, supertypes, tuple(_features(lines, package, names, where)))


def _features(lines: Sequence[str], package: str, names: set[str], where: str) -> Iterator[SourceFeature]:
    for line in lines:
        name, colon, kind = (part.strip() for part in line.partition(":"))
        if not colon:
            continue
        many = kind.endswith("*")
        kind = kind.removesuffix("*").strip()
        if kind in ATTRIBUTES or "|" in kind:
            yield SourceFeature(name, kind, Sort.ATTRIBUTE, many)
            continue
        sort = Sort.REFERENCE if kind.startswith("->") else Sort.CONTAINED
        known = _known(kind.removeprefix("->").strip(), package, names, f"{where}: {name}")
        yield SourceFeature(name, known, sort, many)


def _known(name: str, package: str, names: set[str], where: str) -> str:
    full = name if "." in name else f"{package}.{name}"
    if full not in names:
        raise ValueError(f"{where}: {name!r} is not a declared class, nor one of {', '.join(ATTRIBUTES)}")
    return full
