"""The language of paths, such as ``robots[name=Drone1].moves[*].target`` or ``//GoTo[speed>3]``."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum

_WORD = r"""(?:'[^']*'|"[^"]*"|[^\s.\[\]/=<>!'"@]+)"""
_NAME = re.compile(_WORD)
_STEP = re.compile(r"\.|//?")
_INDEX = re.compile(r"\[\s*(-?[0-9]{1,9})\s*\]")
_ALL = re.compile(r"\[\s*\*\s*\]")
_CONDITION = re.compile(
    rf"""\[\s*(?P<names>{_WORD}(?:\.{_WORD})*)\s*
         (?:(?P<sign><=|>=|!=|=|<|>)\s*+(?P<value>'[^']*'|"[^"]*"|[^\]'"]*+)\s*)?\]""",
    re.VERBOSE,
)
_FRAGMENT = re.compile(r"#?/(?P<root>[0-9]{0,9})(?P<steps>(?:/@[^/]+)*)")
_ROOT = re.compile(r"/(?P<number>[0-9]{1,9})(?=[./]|$)")
_FRAGMENT_STEP = re.compile(r"/@(?P<name>[^.\[/]+)(?:\.(?P<index>[0-9]{1,9}))?")


class Axis(Enum):
    """Where a step leads."""

    FEATURE = "feature"
    BELOW = "below"
    ROOT = "root"


@dataclass(frozen=True, slots=True)
class Condition:
    """What an element must say.

    Attributes:
        names: features to follow from the element, one after the other.
        sign: ``=``, ``!=``, ``<``, ``<=``, ``>``, ``>=``; empty: it need only be set.
        value: what it is compared with.
    """

    names: tuple[str, ...]
    sign: str = ""
    value: str = ""


Selector = int | Condition
"""A place in a list, from 0, or from -1 backwards; or a condition."""


@dataclass(frozen=True, slots=True)
class PathStep:
    """One step of a path.

    Attributes:
        axis: along a feature, to elements anywhere below, or to a root by its number.
        name: of the feature or class; ``*`` for any.
        selectors: which of those that it leads to are meant, applied in order.
        text: the path up to and with this step, for messages.
    """

    axis: Axis
    name: str
    selectors: tuple[Selector, ...] = ()
    text: str = ""


def parse_path(text: str) -> tuple[PathStep, ...]:
    """Return the steps of a path; none for the roots themselves, of which ``/1`` is the second.

    Raises:
        ValueError: if it is not a path; with the position.
    """
    text = text.strip()
    match = _FRAGMENT.fullmatch(text)
    if match is not None and (match["steps"] or match["root"]):
        return _fragment(match["root"], match["steps"], text)
    if text in ("", "/"):
        return ()
    return _steps(text)


def _fragment(root: str, steps: str, text: str) -> tuple[PathStep, ...]:
    """Return the steps of a fragment as EMF writes it, such as ``//@tasks.0/@shell.1``."""
    found = [PathStep(Axis.ROOT, root or "0", (), f"/{root}")]
    for match in re.finditer(r"/@[^/]+", steps):
        step = _FRAGMENT_STEP.fullmatch(match.group())
        upto = f"/{root}{steps[: match.end()]}"
        if step is None:
            raise ValueError(f"{upto}: not a step such as /@tasks.0")
        selectors = (int(step["index"]),) if step["index"] else ()
        found.append(PathStep(Axis.FEATURE, step["name"], selectors, upto))
    return tuple(found)


def _steps(text: str) -> tuple[PathStep, ...]:
    steps: list[PathStep] = []
    position = 0
    root = _ROOT.match(text)
    if root is not None:
        steps.append(PathStep(Axis.ROOT, root["number"], (), root.group()))
        position = root.end()
    while position < len(text):
        lead = _STEP.match(text, position)
        if lead is None and steps:
            raise ValueError(_broken(text, position, "expected . or / or [ here"))
        position = lead.end() if lead else position
        name = _NAME.match(text, position)
        if name is None:
            raise ValueError(_broken(text, position, "expected a name here"))
        below = lead is not None and lead.group() == "//"
        step = PathStep(Axis.BELOW if below else Axis.FEATURE, _bare(name.group()))
        step, position = _with_selectors(step, text, name.end())
        steps.append(replace(step, text=text[:position]))
    return tuple(steps)


def _with_selectors(step: PathStep, text: str, position: int) -> tuple[PathStep, int]:
    selectors: list[Selector] = []
    while text.startswith("[", position):
        if match := _INDEX.match(text, position):
            selectors.append(int(match[1]))
        elif not (match := _ALL.match(text, position)):
            match = _CONDITION.match(text, position)
            if match is None:
                wanted = "expected [2], [*], [name] or [name=value] here"
                raise ValueError(_broken(text, position, wanted))
            names = tuple(_bare(name) for name in _NAME.findall(match["names"]))
            selectors.append(Condition(names, match["sign"] or "", _bare((match["value"] or "").rstrip())))
        position = match.end()
    return replace(step, selectors=tuple(selectors)), position


def _bare(word: str) -> str:
    return word[1:-1] if len(word) > 1 and word[0] == word[-1] and word[0] in "'\"" else word


def _broken(text: str, position: int, wanted: str) -> str:
    rest = text[position : position + 20]
    return (
        f"{text}: {wanted}, after {text[:position]!r}, not {rest!r}"
        if rest
        else f"{text}: {wanted}, at the end"
    )
