"""The short notation in which a mapping file declares the classes of its dialect.

A class is a list of texts: first its supertypes, then its features as ``name: type``. A type is ``text``,
``number``, ``truth`` or an enumeration's literals with ``|`` between them for an attribute, the name of a
class for an element that is contained, and ``-> Class`` for a reference; ``*`` behind it means several.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from mmrs_flyaq.sources.structure import Sort, SourceClass, SourceFeature, Structure

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
