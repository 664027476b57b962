"""Hypothesis strategies for the values of attributes."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime
from decimal import Decimal
from typing import Any, TypeAlias

from hypothesis import strategies as st

from mmrs_core.languages.datatypes import ECORE, XML_TYPES, DataType
from mmrs_core.languages.metaclass import Enumeration, Feature

Values: TypeAlias = Mapping[tuple[str, str], st.SearchStrategy[Any]]
"""Strategies for the values of data types, by nsURI and name of the type."""

_LONGEST_LIST = 3
_NOT_IN_XML = [chr(code) for code in (*range(9), 11, 12, *range(14, 32), 0xFFFE, 0xFFFF)]
"""What XML 1.0 cannot hold at all, section 2.2."""

TEXTS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters=_NOT_IN_XML), max_size=12)
"""Any text that a file can hold."""

WORDS = st.from_regex(r"[a-zA-Z][a-zA-Z0-9]{0,7}", fullmatch=True)

_BITS = {"byte": 8, "short": 16, "int": 32, "long": 64, "Byte": 8, "Short": 16, "Integer": 32, "Long": 64}
_DATES = st.datetimes(datetime(1970, 1, 2), datetime(2100, 1, 1)).map(
    lambda date: date.replace(microsecond=date.microsecond // 1000 * 1000, tzinfo=UTC, fold=0)
)
_BY_PYTHON_CLASS: Mapping[type, st.SearchStrategy[Any]] = {
    str: TEXTS,
    float: st.floats(allow_nan=False, allow_infinity=False),
    bool: st.booleans(),
    bytes: st.binary(max_size=4),
    Decimal: st.decimals(allow_nan=False, allow_infinity=False, places=3),
    datetime: _DATES,
}


def values_of(feature: Feature, given: Values | None = None) -> st.SearchStrategy[Any]:
    """Draw what an attribute may hold: one value, or a list as long as its bounds allow.

    Args:
        feature: the attribute.
        given: strategies for data types whose values the metamodel does not tell enough about.
    """
    single = _single(feature, given or {})
    if not feature.many:
        return single
    longest = feature.lower + _LONGEST_LIST
    size = min(longest, feature.most) if feature.most >= 0 else longest
    return st.lists(single, min_size=feature.lower, max_size=size, unique_by=_key if feature.unique else None)


def _key(value: object) -> tuple[str, object]:
    """Distinguish 1 from True and 0.0 from -0.0, as Java does."""
    return type(value).__name__, repr(value) if isinstance(value, float) else value


def _single(feature: Feature, given: Values) -> st.SearchStrategy[Any]:
    kind = feature.type
    if (kind.ns_uri, kind.name) in given:
        return given[kind.ns_uri, kind.name]
    if isinstance(kind, Enumeration):
        return st.sampled_from(kind.names)
    if not isinstance(kind, DataType):
        raise ValueError(f"{feature.owner.name}.{feature.name}: a reference, whose values are elements")
    return _of_type(kind)


def _of_type(kind: DataType) -> st.SearchStrategy[Any]:
    java = kind.java_class.removeprefix("java.lang.")
    if kind.python is int:
        bits = _BITS.get(java, 100)
        return st.integers(-(1 << bits - 1), (1 << bits - 1) - 1)
    if java in ("float", "Float"):
        return st.floats(allow_nan=False, allow_infinity=False, width=32)
    if java in ("char", "Character"):
        return st.characters(exclude_categories=["Cs"], max_codepoint=0xFFFF)
    if java == "Class":
        return st.just("java.lang.String")
    if kind.ns_uri == XML_TYPES and kind.python is str:
        return TEXTS if kind.name == "String" else WORDS
    return _BY_PYTHON_CLASS[kind.python]


def writable(feature: Feature) -> bool:
    """Return whether a file can hold the values of an attribute; nothing can hold Java's objects."""
    return feature.stored and (feature.type.ns_uri, feature.type.name) != (ECORE, "EJavaObject")
