"""Values as literals, comments and names of the languages that are written.

Names from models are data: whatever they hold, they end up inside a literal or a comment, or as a
name of our own making. Every function returns `Code`, which alone may enter an output.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from math import isfinite

LONGEST_NAME = 48
LINE = 110


class Code(str):
    """Text that is safe to write into an output as it is."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Constant:
    """A value that generated Python code says by a name of our own, and defines once."""

    name: str
    value: object


@dataclass(frozen=True, slots=True)
class Call:
    """A call in generated Python code: `function` is a name of our own, never one from a model."""

    function: str
    positional: tuple[object, ...] = ()
    named: tuple[tuple[str, object], ...] = ()


def python_literal(value: object) -> Code:
    """Return a value as a Python expression in ASCII on one line: literals, each `Constant` and `Call`.

    Raises:
        ValueError: it is a number that is not finite, or no plain value.
    """
    if isinstance(value, Call):
        given: list[str] = [python_literal(each) for each in value.positional]
        given += [f"{name}={python_literal(each)}" for name, each in value.named]
        return Code(f"{value.function}({', '.join(given)})")
    if isinstance(value, float):
        if not isfinite(value):
            raise ValueError(f"{value} is not finite and has no literal")
        return Code(repr(value))
    if value is None or isinstance(value, bool | int):
        return Code(repr(value))
    if isinstance(value, Constant):
        return name(value.name)
    if isinstance(value, str):
        return _quoted(str(value))
    if isinstance(value, tuple | list):
        inner = ", ".join(python_literal(item) for item in value)
        return Code(f"({inner},)" if len(value) == 1 else f"({inner})")
    raise ValueError(f"{value!r} is not a plain value and has no literal")


def python_lines(value: object, indent: int = 0, before: int = 0) -> Code:
    """Return a value as a Python expression that is laid out in lines where one would be too long.

    Args:
        value: as for `python_literal`.
        indent: of the line on which the expression begins, in characters.
        before: characters on that line between the indentation and the expression.
    """
    flat = python_literal(value)
    if indent + before + len(flat) < LINE or not isinstance(value, Call | tuple | list):
        return flat
    opening = f"{value.function}(" if isinstance(value, Call) else "("
    given = [("", each) for each in (value.positional if isinstance(value, Call) else value)]
    given += [(f"{key}=", each) for key, each in value.named] if isinstance(value, Call) else []
    inner = indent + 4
    lines = [f"{' ' * inner}{key}{python_lines(each, inner, len(key))},\n" for key, each in given]
    return Code(f"{opening}\n{''.join(lines)}{' ' * indent})")


def _quoted(text: str) -> Code:
    literal = repr(text)
    if literal.startswith('"'):
        return Code(literal)
    return Code('"' + literal[1:-1].replace("\\'", "'").replace('"', '\\"') + '"')


def json_literal(value: object, indent: int = 0) -> Code:
    """Return a value as JSON in ASCII, indented by two; further lines by as much again as `indent` says.

    Raises:
        ValueError: it holds a number that is not finite.
        TypeError: it holds something that JSON has no form for.
    """
    text = json.dumps(value, indent=2, ensure_ascii=True, allow_nan=False)
    return Code(text.replace("\n", "\n" + " " * indent))


def comment(value: object) -> Code:
    """Return a value as printable characters on one line, which can end no comment and no docstring."""
    shown = repr(str(value))[1:-1].replace("\\'", "'").replace('"', "'")
    return Code(shown.replace("\\", "/").replace("*/", "* /").replace("`", "'"))


def name(value: object) -> Code:
    """Return a name of our own, dotted or not, as it is.

    Raises:
        ValueError: it is none of ASCII letters, digits and ``_``.
    """
    if re.fullmatch(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*", str(value), re.ASCII) is None:
        raise ValueError(f"{value!r} is not a name")
    return Code(str(value))


def cell(value: object) -> Code:
    """Return a value as plain text in a table of Markdown."""
    return Code(re.sub(r"([^A-Za-z0-9 .,'/])", r"\\\1", comment(value)))


def identifier(value: object) -> Code:
    """Return a name for code that no other value shares, made of ASCII letters, digits and ``_``.

    It begins with ``x_`` and ends with a digest of the value where that is not such a name itself,
    so that it is never a keyword.
    """
    text = str(value)
    kept = re.sub(r"[^A-Za-z0-9]+", "_", text)[:LONGEST_NAME]
    digested = re.search(r"__[0-9a-f]{16}$", text) is not None
    return Code(f"x_{text}" if kept == text and not digested else f"x_{kept}__{_digest(text)[:16]}")


def file_stems(names: Sequence[str], *, hyphens: bool = True) -> dict[str, str]:
    """Return a file name without extension for each name; equal for none, even if case is ignored.

    Plain names stay as they are; others keep what is plain in them and get a digest.

    Args:
        names: all names that need a file in one folder.
        hyphens: whether a hyphen is plain; without it, stems are parts of identifiers, too.
    """
    strange = r"[^A-Za-z0-9-]+" if hyphens else r"[^A-Za-z0-9]+"
    kept = {name: re.sub(strange, "_", name)[:LONGEST_NAME].strip("_-") for name in names}
    claims = [stem.casefold() for stem in kept.values()]
    plain = {n: s for n, s in kept.items() if s and s == n and claims.count(s.casefold()) == 1}
    for length in (8, 64):
        others = {n: f"{kept[n]}_{_digest(n)[:length]}".lstrip("_") for n in kept if n not in plain}
        stems = {name: (plain | others)[name] for name in names}
        if len({stem.casefold() for stem in stems.values()}) == len(stems):
            break
    return stems


def _digest(text: str) -> str:
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
