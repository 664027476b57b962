"""Counts the values of files in XMI and JSON, and looks for them in what a migration made and told.

It knows nothing of mappings and rules, so it finds what these forget.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.etree import ElementTree

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element, descendants, get, held, metaclass_of
from mmrs_core.languages.metaclass import Enumeration

_WORD = re.compile(r"[^\s;,()'\"]+")
_LEFT_OUT = ("eClass", "@ns", "$ref")


def _of_json(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        # what else stands beside a reference is the class that it leads to
        inner = [] if "$ref" in value else [value[key] for key in value if key not in _LEFT_OUT]
        for each in inner:
            yield from _of_json(each)
    elif isinstance(value, list):
        for each in value:
            yield from _of_json(each)
    elif value is not None:
        yield str(value).lower() if isinstance(value, bool) else str(value)


def _of_xml(text: bytes | str) -> Iterator[str]:
    for element in ElementTree.fromstring(text).iter():
        # attributes of the format itself stand in a namespace
        yield from (value for key, value in element.attrib.items() if "}" not in key)


def _plain(value: str) -> str:
    """Return a value as one spelling of it: 4, 4.0 and 4e0 are the same number."""
    try:
        return repr(float(value))
    except ValueError:
        return value


def values_of(file: Path) -> Counter[str]:
    """Return how often each value of an attribute stands in a file; references are none."""
    text = file.read_text(encoding="utf-8")
    found = _of_json(json.loads(text)) if text.lstrip()[:1] in "{[" else _of_xml(text.encode())
    return Counter(_plain(value) for value in found if value and not value.startswith("//@"))


def _of_model(root: Element) -> Iterator[str]:
    """Yield the values that a model holds, and the literals that it holds without saying so: the defaults."""
    for element in (root, *descendants(root)):
        for feature in metaclass_of(element).features:
            if feature.is_reference:
                continue
            assert isinstance(feature.type, DataType | Enumeration)
            unsaid = isinstance(feature.type, Enumeration) and not feature.many
            values = (get(element, feature.name),) if unsaid else held(element, feature)
            yield from (feature.type.render(value) for value in values if value is not None)


def missing(file: Path, made: Iterable[Element], told: Iterable[str]) -> list[str]:
    """Return the values of a file that stand less often in models and report than in the file.

    Args:
        made: the models that came of it.
        told: what the report says of values and elements.
    """
    subjects = list(told)
    found = Counter(_plain(value) for root in made for value in _of_model(root))
    found.update(_plain(word) for subject in subjects for word in _WORD.findall(subject))
    lines = "\n".join(subjects)
    return [
        value
        for value, count in values_of(file).items()
        if found[value] + (lines.count(value) if " " in value else 0) < count
    ]
