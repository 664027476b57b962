"""How breaches are put into words, and the names of the languages that constraints are about."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import text
from mmrs_core.languages.element import Element, Unknown, label_of, metaclass_of, path_of
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.uris import BEHAVIOUR as BEHAVIOUR
from mmrs_core.languages.uris import CONTEXT as CONTEXT
from mmrs_core.languages.uris import MISSION as MISSION
from mmrs_core.languages.uris import ROBOT as ROBOT


def called(element: Element) -> str:
    """Return what messages call an element: its class, and its name or where it stands in its model."""
    kind = "element" if isinstance(element, Unknown) else metaclass_of(element).name
    if name := label_of(element):
        return f"{kind} {name!r}"
    path = path_of(element).lstrip("/")
    return path if path.lower().endswith(kind.lower()) else f"{kind} {path}".rstrip()


def finding(element: Element, message: str, hint: str = "") -> Finding:
    """Return a breach by an element; `message` continues its name."""
    return Finding(element, f"{called(element)}: {message}", hint)


def listed(names: Iterable[str]) -> str:
    """Return names for messages: quoted, and ``none`` where there are none."""
    return ", ".join(f"'{name}'" for name in names) or "none"


def guessed(known: str, name: str, names: Iterable[str]) -> str:
    """Return a hint of what is known and of the name that a misspelt one is nearest to."""
    choices = set(names)
    guess = nearest(name, choices)
    if guess and len(choices) == 1:
        return guess
    return f"{known}; {guess}" if guess else known


def repeats(elements: Iterable[Element], key: str, what: str) -> Iterable[Finding]:
    """Yield a breach for each element whose text of that feature another one before it has.

    Elements without such a text are passed over.
    """
    seen: dict[str, Element] = {}
    for element in elements:
        name = text(element, key)
        if not name:
            continue
        if name in seen:
            yield finding(element, f"{what} {name!r} is already used by {path_of(seen[name])}")
        else:
            seen[name] = element
