"""The writer for large models: compiled functions for what occurs often, the careful way for all else."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import NoReturn

from mmrs_core.languages.classes import bare_name
from mmrs_core.languages.datatypes import DataType, render_real
from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.references.addresses import Positions
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.sources import Source
from mmrs_core.languages.values.real import LARGEST_SINGLE, render_single
from mmrs_core.languages.xmi.escapes import NO_XML, in_attribute
from mmrs_core.languages.xmi.writer import Job, SiblingRow, XmiWriter

DEEPEST_CALL = 50
"""Elements that stand deeper than this are not written by functions that call each other."""

_SUSPICIOUS = re.compile(f'[&<"\n\t\r]|{NO_XML.pattern}')

Emitter = Callable[[Element, int], None]
"""Writes an element at a depth."""


class UnusualError(Exception):
    """An element needs more than its function can do."""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What the functions for one document share.

    Attributes:
        add: takes pieces of text.
        home: the source that elements come from, if they come from any.
        places: the escaped fragment of each element; raises `UnusualError` for what stands elsewhere.
        tables: the function of each class that may stand in a feature.
        slowly: writes an element inside an owner in the careful way.
    """

    add: Callable[[str], None]
    home: object
    places: Mapping[Element, str]
    tables: Mapping[Feature, Mapping[type, Emitter]]
    slowly: Callable[[Element, Feature, Element, int], None]


_Factory = Callable[[str, str, Surroundings], Emitter]


def emitter(metaclass: Metaclass, head: str, name: str, surroundings: Surroundings) -> Emitter | None:
    """Return the function for elements of a metaclass, or None where each needs the careful way.

    Args:
        head: their start tag up to the first attribute of the model.
        name: their tag.
        surroundings: of the document.
    """
    if "emitter" not in metaclass.compiled:
        metaclass.compiled["emitter"] = _factory(metaclass)
    make: _Factory | None = metaclass.compiled["emitter"]  # type: ignore[assignment]  # put there above
    return None if make is None else make(head, f"</{name}>\n", surroundings)


def _factory(metaclass: Metaclass) -> _Factory | None:
    features = [
        (index, feature)
        for index, feature in enumerate(metaclass.features)
        if feature.stored and not feature.is_container
    ]
    if any(feature.nullable or feature.name == "href" for _, feature in features):
        return None
    bound: dict[str, object] = {"Unusual": UnusualError, "clean": clean, "written": written}
    bound |= {"opened": ">\n", "empty": "/>\n", "deepest": DEEPEST_CALL}
    bound["pads"] = ["  " * depth for depth in range(DEEPEST_CALL + 1)]
    children: list[tuple[int, Feature]] = []
    body = [
        "s = e._mmrs_source",
        "if s is not home and s is not None or depth > deepest: raise Unusual",
        "t = heads[depth]",
    ]
    for index, feature in features:
        bound[f"f{index}"] = feature
        bound[f"a{index}"] = f' {feature.name}="'
        body.append(f"v = e.{bare_name(index)}")
        if feature.is_reference and feature.containment:
            body[-1] = f"v{index} = e.{bare_name(index)}"
            children.append((index, feature))
        elif feature.is_reference:
            body += _reference(index, feature)
        else:
            body += _value(index, feature, bound)
    body += _inside(children)
    source = "\n".join(
        [
            "def factory(head, tail, surroundings):",
            "    add, home, places = surroundings.add, surroundings.home, surroundings.places",
            "    slowly = surroundings.slowly",
            "    heads = [pad + head for pad in pads]",
            *(f"    t{index} = surroundings.tables[f{index}]" for index, _ in children),
            "    def emit(e, depth):",
            *(f"        {line}" for line in body),
            "    return emit",
        ]
    )
    exec(compile(source, f"<writer of {metaclass.name}>", "exec"), bound)  # noqa: S102  # no foreign text in it
    made: _Factory = bound["factory"]  # type: ignore[assignment]
    return made


def _reference(index: int, feature: Feature) -> list[str]:
    lines = ["if v:" if feature.many else "if v is not None:"]
    if feature.opposite is not None:  # an element that is its own other end
        lines.append(f"    if {'e in v' if feature.many else 'v is e'}: raise Unusual")
    text = '" ".join([places[x] for x in v])' if feature.many else "places[v]"
    return [*lines, f"    t += f'{{a{index}}}{{{text}}}\"'"]


def _value(index: int, feature: Feature, bound: dict[str, object]) -> list[str]:
    """Return the lines that add an attribute, unless it holds nothing or its default."""
    kind = feature.type
    if feature.many or isinstance(kind, Metaclass):
        return ["if v: raise Unusual"]
    guard, text = _rendering(kind, index, bound)
    lines = ["if v is not None:", f"    if {guard}: raise Unusual"]
    indent = "    "
    if isinstance(feature.default, datetime):  # what its text says counts as well
        return ["if v is not None: raise Unusual"]
    if feature.default is not None and not (feature.unsettable or isinstance(feature.default, bytes)):
        bound[f"d{index}"] = feature.default
        zeros = f" or repr(v) != repr(d{index})" if isinstance(feature.default, float) else ""
        lines.append(f"    if v != d{index}{zeros}:")
        indent *= 2
    return [*lines, f"{indent}t += f'{{a{index}}}{{{text}}}\"'"]


def _rendering(kind: DataType | Enumeration, index: int, bound: dict[str, object]) -> tuple[str, str]:
    """Return when a value is not of the usual class, and the expression for its text."""
    if isinstance(kind, Enumeration):
        bound[f"k{index}"] = {each.name: in_attribute(each.literal) for each in kind.literals}
        return f"v.__class__ is not str or v not in k{index}", f"k{index}[v]"
    if kind.render is str and kind.python is str:
        return "v.__class__ is not str", "v if v.isalnum() else clean(v)"
    if kind.bits is not None:
        lowest, highest = -(1 << kind.bits - 1), (1 << kind.bits - 1) - 1
        return f"v.__class__ is not int or not {lowest} <= v <= {highest}", "v"
    if kind.render in (render_real, render_single):
        # between these bounds Python and Java agree
        bound[f"k{index}"] = render_real
        large = f" or abs(v) > {LARGEST_SINGLE!r} and v - v == 0.0" if kind.render is render_single else ""
        return f"v.__class__ is not float{large}", f"repr(v) if 1e-3 <= v < 1e7 else k{index}(v)"
    bound[f"k{index}"] = kind
    return f"not k{index}.accepts(v)", f"written(k{index}, v)"


def _inside(children: list[tuple[int, Feature]]) -> list[str]:
    """Return the lines that add the start tag, and the elements inside with the end tag if there are any."""
    if not children:
        return ["add(t + empty)"]
    lines = [f"if {' or '.join(f'v{index}' for index, _ in children)}:", "    add(t + opened)"]
    for index, feature in children:
        loop = f"for c in v{index}" if feature.many else f"for c in (v{index},)"
        lines += [
            f"    if v{index}:",
            f"        {loop}:",
            f"            try: t{index}[c.__class__](c, depth + 1)",
            f"            except (Unusual, TypeError): slowly(e, f{index}, c, depth + 1)",
        ]
    return [*lines, "    add(pads[depth] + tail)", "else:", "    add(t + empty)"]


def written(kind: DataType, value: object) -> str:
    """Return the text of a value as it stands in an attribute; raises `UnusualError` if none holds it."""
    try:
        return clean(kind.render(value))
    except ValueError:
        raise UnusualError from None


def clean(text: str) -> str:
    """Return a text as it stands in an attribute; raises `UnusualError` if XML cannot hold it."""
    if _SUSPICIOUS.search(text) is None:
        return text
    if NO_XML.search(text) is not None:
        raise UnusualError
    return in_attribute(text)


_OFTEN = 16
"""Compiling costs as much as writing so many elements the careful way."""


def writer_for(roots: Sequence[Element], registry: Registry, file: Path | None) -> XmiWriter:
    """Return the quicker writer, unless what the file said of single elements has to be said again."""
    sources = {root._mmrs_source for root in roots}
    home = sources.pop() if len(sources) == 1 else None
    if sources or (home is not None and (home.ids or home.blanks)):
        return XmiWriter(roots, registry, file)
    return QuickWriter(roots, registry, file, home)


class QuickWriter(XmiWriter):
    """Writes the same bytes as `XmiWriter`, at a multiple of its speed."""

    def __init__(
        self, roots: Sequence[Element], registry: Registry, file: Path | None, home: Source | None
    ) -> None:
        """Take also the source of all roots, which must know of no identifiers and no blanks."""
        super().__init__(roots, registry, file)
        self._tables: dict[Feature, _Table] = defaultdict(_Table)
        self._seen: dict[tuple[Feature, type], int] = defaultdict(int)
        self._places = Positions(roots, home, UnusualError)
        self._surroundings = Surroundings(self._lines.append, home, self._places, self._tables, self._slowly)

    def _row(self, row: SiblingRow, jobs: list[Job]) -> None:
        """Write elements until one needs the careful way; leave what follows it as jobs."""
        table, depth = self._tables[row.feature], row.depth
        for child in row.values:
            try:
                table[child.__class__](child, depth)  # type: ignore[arg-type]  # no class but of elements is there
            except (
                UnusualError,
                TypeError,
            ):  # a type that nobody expects: the careful way has the words for it
                jobs.append(row)
                self._child(row, child, jobs)
                self._notice(row.feature, child.__class__)
                return

    def _fragment(self, target: Element) -> str | None:
        try:
            return self._places[target]
        except UnusualError:
            return super()._fragment(target)

    def _slowly(self, owner: Element, feature: Feature, child: Element, depth: int) -> None:
        jobs: list[Job] = []
        self._child(SiblingRow(owner, feature, iter(()), depth), child, jobs)
        self._run(jobs)
        self._notice(feature, child.__class__)

    def _notice(self, feature: Feature, kind: type) -> None:
        """Count an element that was written the careful way; compile its class once it is worth it."""
        self._seen[feature, kind] += 1
        if (
            self._seen[feature, kind] != _OFTEN
            or not issubclass(kind, Element)
            or kind._mmrs_metaclass is None
        ):
            return
        metaclass = kind._mmrs_metaclass
        head = f"<{feature.name}"
        if metaclass is not feature.type:
            head += f' xsi:type="{self._kind(metaclass)}"'
        emit = emitter(metaclass, head, feature.name, self._surroundings)
        if emit is not None:
            self._tables[feature][kind] = emit


class _Table(dict[type, Emitter]):
    """The compiled functions of one feature; a class that has none is unusual."""

    def __missing__(self, kind: type) -> Emitter:
        return _unusual


def _unusual(element: Element, depth: int) -> NoReturn:
    raise UnusualError
