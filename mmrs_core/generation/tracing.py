"""Which lines of a rendered file serve which step: the tag ``{% serves step %}`` of templates.

The tag leaves marks in the text, which are taken out again when the lines have been counted. Values
cannot forge them: what passes a filter has its own marks doubled.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from jinja2 import nodes
from jinja2.ext import Extension
from jinja2.parser import Parser

from mmrs_core.contributions.targets import TracedStep

MARK = "\ufdd0"
_TOKEN = re.compile(f"{MARK}(?:({MARK})|(\\[[^;{MARK}]*);|(;))")


@dataclass(frozen=True, slots=True)
class Served:
    """Lines of a file that serve a step: `first` to `last`, counted from 1; 0 where they are not known."""

    step: TracedStep
    first: int = 0
    last: int = 0


class Serves(Extension):
    """The tag: ``{% serves step %}`` … ``{% endserves %}``, with a `TracedStep` or a sequence of them."""

    tags = {"serves"}  # noqa: RUF012  Jinja declares it so

    def parse(self, parser: Parser) -> nodes.Node:
        """Return the body as a block that `_marked` gets."""
        line = next(parser.stream).lineno
        steps = parser.parse_expression()
        body = parser.parse_statements(("name:endserves",), drop_needle=True)
        return nodes.CallBlock(self.call_method("_marked", [steps]), [], [], body).set_lineno(line)

    def _marked(self, steps: TracedStep | Sequence[TracedStep], caller: Callable[[], str]) -> str:
        every: list[TracedStep] = [steps] if isinstance(steps, TracedStep) else list(_several(steps))
        # a semicolon ends the mark, so that none may stand within it
        said = [(step.step, step.robot, step.move, step.task, step.rule) for step in every]
        words = json.dumps(said).replace(";", "\\u003b")
        return f"{MARK}{words};{caller()}{MARK};"


def _several(steps: object) -> Sequence[TracedStep]:
    if isinstance(steps, list | tuple):
        return steps
    raise ValueError(f"the tag 'serves' takes a TracedStep, or a sequence of them, not {steps!r}")


def unforged(text: str) -> str:
    """Return a value's text so that none of it counts as a mark."""
    return text.replace(MARK, MARK + MARK)


def taken_out(text: str) -> tuple[str, tuple[Served, ...]]:
    """Return a rendered text without its marks, and the lines that serve steps, inner ones first."""
    reader = _Reader()
    begin = 0
    for token in _TOKEN.finditer(text):
        reader.pass_over(text[begin : token.start()])
        reader.read(token)
        begin = token.end()
    reader.pass_over(text[begin:])
    return "".join(reader.parts), tuple(reader.found)


def with_lines(declared: Iterable[TracedStep], served: Sequence[Served]) -> tuple[Served, ...]:
    """Return all steps of a file, each that templates marked with its lines, in the order of the lines."""
    marked = {each.step for each in served}
    others = tuple(Served(step) for step in declared if step not in marked)
    return (*sorted(served, key=lambda each: (each.first, -each.last)), *others)


class _Reader:
    """Where one is in a text with marks."""

    def __init__(self) -> None:
        self.parts: list[str] = []
        self.found: list[Served] = []
        self._open: list[tuple[list[TracedStep], int]] = []
        self._line, self._fresh = 1, True

    def pass_over(self, piece: str) -> None:
        if piece:
            self.parts.append(piece)
            self._line += piece.count("\n")
            self._fresh = piece.endswith("\n")

    def read(self, token: re.Match[str]) -> None:
        if token[1]:
            self.pass_over(MARK)
        elif token[2]:
            self._open.append(([TracedStep(*each) for each in json.loads(token[2])], self._line))
        else:
            steps, first = self._open.pop()
            last = max(first, self._line - self._fresh)
            self.found += [Served(step, first, last) for step in steps]
