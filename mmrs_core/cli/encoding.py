"""Turns any value that stages pass on into what JSON can hold."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from math import isfinite
from pathlib import PurePath

from mmrs_core.languages.element import Element, Hidden, Unknown, get, is_set, metaclass_of, path_of
from mmrs_core.languages.json_form.scalars import written
from mmrs_core.languages.metaclass import Feature, Metaclass

Plain = object
"""None, bool, int, float, str, list of plain values, or dict from str to plain values."""


def plain(value: object) -> Plain:
    """Return a value as JSON can hold it.

    Dataclasses and model elements become objects whose ``$type`` names their class; numbers that
    JSON has no sign for become text; mappings whose keys are not text become lists of key and value.

    Raises:
        TypeError: for a value of any other sort.

    >>> plain({"high": float("inf"), "at": (1.0, 2)})
    {'high': 'Infinity', 'at': [1.0, 2]}
    """
    if value is None or (isinstance(value, bool | int | str) and not isinstance(value, Enum)):
        return value
    if isinstance(value, float):
        return value if isfinite(value) else _unwritable(value)
    if isinstance(value, Enum):
        return plain(value.value)
    if isinstance(value, PurePath):
        return value.as_posix()
    if is_dataclass(value) and not isinstance(value, type):
        named = {field.name: plain(getattr(value, field.name)) for field in fields(value)}
        return {"$type": type(value).__name__} | named
    if isinstance(value, Mapping):
        return _mapping(value)
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(item) for item in _in_order(value)]
    return _element(value)


def _unwritable(value: float) -> str:
    if value != value:
        return "NaN"
    return "Infinity" if value > 0 else "-Infinity"


def _mapping(value: Mapping[object, object]) -> Plain:
    if all(isinstance(key, str) for key in value):
        return {str(key): plain(item) for key, item in value.items()}
    return [{"key": plain(key), "value": plain(item)} for key, item in value.items()]


def _in_order(value: Iterable[object]) -> Iterable[object]:
    return sorted(value, key=repr) if isinstance(value, set | frozenset) else value


def _element(value: object) -> Plain:
    """Return a model element with the features that are set; references become fragment paths.

    An element whose metamodel is not installed keeps its XML; errors inside it name its path.
    """
    if not isinstance(value, Element):
        raise TypeError(f"{type(value).__name__}: no such value passes between stages")
    if isinstance(value, Hidden):
        return path_of(value)
    if isinstance(value, Unknown):
        return {"$type": value._mmrs_type, "$xml": value._mmrs_xml}
    metaclass = metaclass_of(value)
    encoded: dict[str, Plain] = {"$type": f"{metaclass.ns_uri}#{metaclass.name}"}
    for feature in metaclass.features:
        if feature.is_container or not is_set(value, feature.name):
            continue
        found = get(value, feature.name)
        values = found if feature.many and isinstance(found, Iterable) else (found,)
        held = [value_of(feature, each) for each in values]
        encoded[feature.name] = held if feature.many else held[0]
    return encoded


def value_of(feature: Feature, value: object) -> Plain:
    """Return a value of a feature: contained elements whole, others by their paths, null as None.

    Values of attributes are as in the JSON form of models: what JSON has no sign for is the text that EMF
    writes.

    Raises:
        TypeError: for a value that is not of the feature's type.
    """
    if isinstance(value, Element):
        return _element(value) if feature.containment else path_of(value)
    if value is None:
        return None
    if isinstance(feature.type, Metaclass) or not feature.type.accepts(value):
        raise TypeError(f"{feature.name}: {value!r} is not of the type {feature.type.name}")
    encoded: Plain = json.loads(written(feature.type, value))
    return encoded
