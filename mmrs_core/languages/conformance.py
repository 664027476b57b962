"""Whether models obey their metamodels, by the rules of EMF and a few that EMF leaves out."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.codes import explained
from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element, Unknown, held, label_of, metaclass_of, place_of, root_of
from mmrs_core.languages.links import raw
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, is_null
from mmrs_core.languages.model import Model
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import MOST_FAULTS
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.values.texts import described, shown

_KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "a text"}
_FINITE = "give a number; leave the attribute out where the value is not known"


def check_conformance(model: Model, registry: Registry) -> tuple[Diagnostic, ...]:
    """Return every breach of the metamodels in a model, in document order.

    What the reader reported already is not reported again. Models made in memory are checked as well.
    An element whose metamodel is not installed is passed over: reading reported it.

    Raises:
        UnreadableError: if there are too many to read.
    """
    check = _Check(model, registry)
    faults = (fault for element in model.elements() for fault in check.element(element))
    found = tuple(islice(faults, MOST_FAULTS + 1))
    if len(found) > MOST_FAULTS:
        message = f"more than {MOST_FAULTS} faults; the first is: {found[0].message}"
        raise UnreadableError.of("FIL008", message, model.file)
    return found


class _Check:
    def __init__(self, model: Model, registry: Registry) -> None:
        self._registry = registry
        self._broken = model.broken
        self._roots = {id(root) for root in model.roots}
        self._ids: dict[object, Element] = {}
        self._standing: set[Element] = set()

    def element(self, element: Element) -> Iterator[Diagnostic]:
        if isinstance(element, Unknown):
            return
        metaclass = type(element)._mmrs_metaclass
        if metaclass is None or not self._installed(metaclass):
            yield _fault("ECO010", element, f"{type(element).__name__}: its metamodel is not installed")
            return
        for feature in metaclass.features:
            values = held(element, feature)
            yield from self._count(element, feature, len(values))
            if values:
                rule = self._references if feature.is_reference else self._attributes
                yield from rule(element, feature, values)

    def _installed(self, metaclass: Metaclass) -> bool:
        try:
            return self._registry.metaclass(*metaclass.key) is metaclass
        except ValueError:
            return False

    def _count(self, element: Element, feature: Feature, count: int) -> Iterator[Diagnostic]:
        if (element, feature.name) in self._broken or feature.is_container:
            return
        if not feature.many:
            if feature.required and not count and feature.default is None:
                hint = "" if feature.is_reference else _in_passing(feature.documentation)
                message = f"{_owner(element)}: {feature.name} is missing"
                yield _fault("ECO001", element, message, hint, _wanted(feature))
        elif count < feature.lower or count > feature.upper >= 0:
            few = count < feature.lower
            wanted = f"at least {feature.lower}" if few else f"at most {feature.upper}"
            message = f"{_owner(element)}: {feature.name} has {count or 'none'}, needs {wanted}"
            short = f"add at least {feature.lower - count} more" if count else f"add {wanted}"
            hint = short if few else f"take {count - feature.upper} away"
            yield _fault("ECO002" if count or not few else "ECO001", element, message, hint, _wanted(feature))

    def _attributes(
        self, element: Element, feature: Feature, values: Sequence[object]
    ) -> Iterator[Diagnostic]:
        for value in values:
            yield from _value(element, feature, value)
        if feature.many and feature.unique:
            yield from _repeated(element, feature, values, _as_java)
        if feature.is_id and values[0] is not None:
            other = self._ids.setdefault(_as_java(values[0]), element)
            if other is not element:
                what = values[0] if isinstance(values[0], str) else described(values[0])
                message = f"{what}: an identifier used twice; first at {place_of(other)}"
                yield _fault("ECO012", element, message)

    def _references(
        self, element: Element, feature: Feature, values: Sequence[object]
    ) -> Iterator[Diagnostic]:
        for value in values:
            if isinstance(value, Unknown):
                continue
            if not isinstance(value, Element) or not feature.type.accepts(value):
                what = type(value).__name__ if isinstance(value, Element) else described(value)
                message = f"{_owner(element)}: {feature.name} holds {what}, takes {feature.type.name}"
                yield _fault("ECO005", element, message)
            elif feature.containment:
                yield from _contained(element, feature, value)
            elif not self._stands(value):
                message = (
                    f"{_owner(element)}: {feature.name} refers to {_owner(value)}, which stands in no model"
                )
                yield _fault("ECO008", element, message, "put it into a containment feature of the model")
            else:
                yield from _answered(element, feature, value)
        if feature.many and feature.unique:
            yield from _repeated(element, feature, values, id)
        if feature.many and feature.keys:
            yield from _doubled(element, feature, values)

    def _stands(self, element: Element) -> bool:
        container = element._mmrs_container
        if container in self._standing:
            return True
        root = root_of(element)
        source = root._mmrs_source
        stands = id(root) in self._roots or (source is not None and root in source.roots)
        if stands and container is not None:
            self._standing.add(container)
        return stands


def _value(element: Element, feature: Feature, value: object) -> Iterator[Diagnostic]:
    kind = feature.type
    if isinstance(kind, Metaclass) or (value is None and not feature.many) or is_null(feature, value):
        return
    where = f"{_owner(element)}: {feature.name}"
    if isinstance(kind, Enumeration):
        if not kind.accepts(value):
            hint = nearest(value, kind.names) if isinstance(value, str) else ""
            message = f"{where} is {described(value)}, not one of {', '.join(kind.names)}"
            yield _fault("ECO004", element, message, hint)
        return
    if not kind.accepts(value):
        yield _fault("ECO003", element, f"{where} is {described(value)}, not {_kind_words(kind)}")
        return
    try:
        text = kind.render(value)
    except ValueError as fault:
        yield _fault("ECO003", element, f"{where}: {fault}")
        return
    if isinstance(value, float) and not math.isfinite(value):
        yield _fault("ECO009", element, f"{where} is {text}, not a finite number", _FINITE)
    elif kind.doubt is not None and (doubt := kind.doubt(value)):
        why, _, advice = doubt.partition("; ")
        yield replace(
            _fault("ECO014", element, f"{where}: {shown(text)} {why}", advice), severity=Severity.WARNING
        )


def _contained(element: Element, feature: Feature, value: Element) -> Iterator[Diagnostic]:
    if value._mmrs_container is not element or value._mmrs_feature is not feature:
        message = (
            f"{_owner(value)}: stands in {feature.name} of {_owner(element)}, but its container is another"
        )
        yield _fault("ECO007", value, message)


def _answered(element: Element, feature: Feature, value: Element) -> Iterator[Diagnostic]:
    opposite = feature.opposite
    if opposite is None or opposite.attribute not in type(value)._mmrs_slots:
        return
    back = raw(value, opposite)
    if not (any(other is element for other in back) if isinstance(back, list) else back is element):
        message = (
            f"{_owner(element)}: {feature.name} refers to {_owner(value)}, whose {opposite.name} does not"
        )
        yield _fault("ECO011", element, f"{message} refer back")


def _as_java(value: object) -> object:
    """Return what equals the same of another value where Java's equals says so: 0.0 is not -0.0."""
    comparable = isinstance(value, Hashable) and not isinstance(value, float)
    return type(value), value if comparable else repr(value)


def _repeated(
    element: Element, feature: Feature, values: Sequence[object], key: Callable[[object], object]
) -> Iterator[Diagnostic]:
    seen = set()
    for value in values:
        mark = key(value)
        if mark in seen:
            what = _owner(value) if isinstance(value, Element) else described(value)
            yield _fault("ECO006", element, f"{_owner(element)}: {feature.name} holds {what} twice")
            return
        seen.add(mark)


def _doubled(element: Element, feature: Feature, values: Sequence[object]) -> Iterator[Diagnostic]:
    """Yield what is wrong with elements that have the key of an earlier one, as EMF finds it."""
    first: dict[object, Element] = {}
    for value in dict.fromkeys(each for each in values if isinstance(each, Element)):
        if isinstance(value, Unknown):
            continue
        key = {name: _stated(value, name) for name in feature.keys}
        other = first.setdefault(tuple(map(_mark, key.values())), value)
        if other is not value:
            said = ", ".join(f"{name} {_key_words(each)}" for name, each in key.items())
            where = f"{feature.name} of {_owner(element)}; first at {place_of(other)}"
            message = f"{said}: used twice in {where}"
            yield _fault("ECO013", value if feature.containment else element, message)


def _stated(element: Element, name: str) -> object:
    """Return the value of a feature, or its default; None where there is neither."""
    feature = metaclass_of(element).by_name.get(name)
    if feature is None:
        return None
    values = held(element, feature)
    return values[0] if values else feature.default


def _mark(value: object) -> object:
    return id(value) if isinstance(value, Element) else _as_java(value)


def _key_words(value: object) -> str:
    return _owner(value) if isinstance(value, Element) else "not set" if value is None else described(value)


def _wanted(feature: Feature) -> str:
    """Return what a feature takes, and how much of it."""
    kind = feature.type
    if not feature.many and not isinstance(kind, Metaclass):
        return f"{_kind_words(kind)} for {feature.name}"
    most = " or more" if feature.most < 0 else f" to {feature.most}"
    count = f"{feature.lower}{most}" if feature.most != feature.lower else f"{feature.lower}"
    return f"{count} {kind.name} in {feature.name}"


def _in_passing(sentence: str) -> str:
    """Return a sentence as a part of another: without a capital, unless it is of an acronym, or a full stop.

    >>> _in_passing("Height, in metres."), _in_passing("GSD of images.")
    ('height, in metres', 'GSD of images')
    """
    first = sentence[:1].lower() if sentence[1:2].islower() else sentence[:1]
    return f"{first}{sentence[1:]}".removesuffix(".")


def _kind_words(kind: DataType | Enumeration) -> str:
    """Return what people call a type of values."""
    if isinstance(kind, Enumeration):
        return f"one of {', '.join(kind.names)}"
    return _KINDS.get(kind.python, f"a value of the type {kind.name}")


def _owner(element: Element) -> str:
    """Return what messages call an element: its class, and its name if it has one."""
    label = label_of(element)
    return f"{type(element).__name__}{label and f' {label!r}'}"


def _fault(code: str, element: Element, message: str, hint: str = "", expected: str = "") -> Diagnostic:
    return explained(Diagnostic(code, Severity.ERROR, message, place_of(element), hint, expected))
