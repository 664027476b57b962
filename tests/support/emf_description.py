"""What the referee prints of metamodels and models, made from our own objects."""

import struct
from datetime import UTC, datetime, timedelta
from decimal import Decimal

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element, contents, held, holds, metaclass_of
from mmrs_core.languages.metaclass import Enumeration

_REALS = {"double": ">d", "java.lang.Double": ">d", "float": ">f", "java.lang.Float": ">f"}


def metamodel_lines(registry):
    """Yield what the referee prints of metamodels, from our tables."""
    for package in registry.packages:
        yield f"PACKAGE {package.ns_uri} {package.name} {package.prefix}"
        for enumeration in package.enumerations:
            for literal in enumeration.literals:
                yield f"LITERAL {name(enumeration)} {literal.name} {literal.value} {literal.literal}"
        for datatype in package.datatypes:
            yield f"DATATYPE {name(datatype)} serializable={str(datatype.serializable).lower()}"
        for metaclass in package.metaclasses:
            yield f"CLASS {name(metaclass)} abstract={str(metaclass.abstract).lower()}"
            for above in metaclass.supertypes:
                yield f"SUPER {name(metaclass)} {name(above)}"
            for feature in metaclass.features:
                yield f"FEATURE {name(metaclass)} {_feature(feature)}"


def _feature(feature):
    opposite = feature.opposite and f"{name(feature.opposite.owner)}/{feature.opposite.name}"
    default = feature.default
    if feature.unsettable and default is None and isinstance(feature.type, DataType) and not feature.many:
        default = feature.type.primitive_default  # where EMF has a zero, an unset number is None here
    if feature.unsettable and default is None and isinstance(feature.type, Enumeration) and not feature.many:
        default = feature.type.names[0]
    if isinstance(default, datetime):
        default = default.astimezone(UTC)
    if default is not None and isinstance(feature.type, DataType | Enumeration):
        default = feature.type.render(default)
    flags = {
        "containment": feature.containment,
        "unsettable": feature.unsettable,
        "unique": feature.unique,
        "id": feature.is_id,
        "transient": not feature.stored,
    }
    return (
        f"{feature.name} type={name(feature.type)} bounds={feature.lower}..{feature.upper} "
        + " ".join(f"{flag}={str(value).lower()}" for flag, value in flags.items())
        + f" opposite={opposite or ''} default={default if default is not None else ''}"
    )


def name(kind):
    return f"{kind.ns_uri}#{kind.name}"


def model_lines(roots, file):
    """Yield what the referee prints of a model in a file of that name: every value, with all its bits."""
    yield from _Description(roots, file).lines()


class _Description:
    def __init__(self, roots, file):
        self._roots = roots
        self._file = file

    def lines(self):
        for root in self._roots:
            yield from self._element(root)

    def _element(self, element):
        path = self._path(element)
        identifier = element._mmrs_source.ids.get(element) if element._mmrs_source else None
        known = "" if identifier is None else f" id={identifier}"
        yield f"ELEMENT {path} {name(metaclass_of(element))}{known}"
        for feature in metaclass_of(element).features:
            if feature.stored and not feature.is_container and _is_set(element, feature):
                told = [self._told(value, feature) for value in held(element, feature)]
                if not told and not feature.many:
                    told = ["null"]
                yield f"VALUE {path} {feature.name} [{', '.join(told)}]"
        for child in contents(element):
            if not self._is_root(child):
                yield from self._element(child)

    def _told(self, value, feature):
        return self._path(value) if isinstance(value, Element) else _told(value, feature.type)

    def _path(self, element):
        """Return file, number of the root, and the features and positions that lead down from it."""
        steps = []
        while not self._is_root(element):
            container, feature = element._mmrs_container, element._mmrs_feature
            place = _place(held(container, feature), element)
            steps.append(f"/{feature.name}.{place}" if feature.many else f"/{feature.name}")
            element = container
        here = _place(self._roots, element)
        source = element._mmrs_source
        where = f"{self._file}#{here}" if here >= 0 else f"{source.path.name}#{_place(source.roots, element)}"
        return where + "".join(reversed(steps))

    def _is_root(self, element):
        source = element._mmrs_source
        return _place(self._roots, element) >= 0 or (
            source is not None and _place(source.roots, element) >= 0
        )


def _place(values, element):
    return next((index for index, value in enumerate(values) if value is element), -1)


def _is_set(element, feature):
    blanks = element._mmrs_source.blanks if element._mmrs_source else ()
    return holds(element, feature) or (element, feature) in blanks


def _told(value, kind):
    if value is None:
        return "null"
    if isinstance(kind, Enumeration):
        return value
    if kind.java_class in _REALS:
        return _bits(value, _REALS[kind.java_class])
    if kind.java_class in ("char", "java.lang.Character"):
        return str(ord(value))
    if isinstance(value, datetime):
        return str((value - datetime(1970, 1, 1, tzinfo=UTC)) // timedelta(milliseconds=1))
    if isinstance(value, Decimal):
        sign, digits, exponent = value.as_tuple()
        number = "".join(map(str, digits)).lstrip("0")
        return f"{'-' if sign and number else ''}{number or 0}E{exponent}"
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, bool) or not isinstance(value, str):
        return kind.render(value)
    return _quoted(kind.render(value))


def _bits(value, form):
    if value != value:
        return "7ff8000000000000" if form == ">d" else "7fc00000"
    return struct.pack(form, value).hex()


def _quoted(text):
    plain = (char if 32 < ord(char) < 127 and char != "\\" else f"\\{ord(char)};" for char in text)
    return f"'{''.join(plain)}'"
