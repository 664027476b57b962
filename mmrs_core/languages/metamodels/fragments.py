"""The elements of an .ecore file, and the fragments that lead to them: by names, positions and ids."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from urllib.parse import unquote

_NAMED = re.compile(r"""@(\w+)\[name=['"](.*)['"]\]""")


class Node:
    """An element.

    Attributes:
        tag: its name, without a namespace.
        line: where it begins.
    """

    __slots__ = ("_attributes", "_children", "line", "tag")

    def __init__(self, tag: str, attributes: tuple[str, ...], line: int) -> None:
        """Take the attributes as name, value, name, value."""
        self.tag = tag
        self.line = line
        self._attributes = attributes
        self._children: tuple[Node, ...] | list[Node] = ()

    def get(self, name: str) -> str | None:
        """Return the value of an attribute; ``kind`` is ``namespace name`` of the class it says to be of."""
        names = self._attributes[::2]
        return self._attributes[names.index(name) * 2 + 1] if name in names else None

    def put(self, name: str, value: str) -> None:
        """Add an attribute, unless there is one of that name already."""
        if name not in self._attributes[::2]:
            self._attributes += (name, value)

    def add(self, child: Node) -> None:
        """Add an element inside it."""
        if isinstance(self._children, list):
            self._children.append(child)
        else:
            self._children = [child]

    def all(self, tag: str) -> list[Node]:
        """Return the elements of that name directly inside it."""
        return [child for child in self._children if child.tag == tag]

    def __iter__(self) -> Iterator[Node]:
        """Yield the elements directly inside it."""
        return iter(self._children)


class Fragments:
    """Finds elements, also in files so large that looking through them for each would take long."""

    def __init__(self, roots: Sequence[Node | None], ids: Mapping[str, Node]) -> None:
        """Take what stands at the top of a file, and the elements with an ``xmi:id``; both may still grow."""
        self._roots = roots
        self._ids = ids
        self._places: dict[str, str] | None = None
        self._steps: dict[int, dict[str, Node]] = {}

    def named(self, fragment: str) -> str | None:
        """Return where an element stands, by names, such as ``//sub/A``.

        Args:
            fragment: that, or a path with positions, or an ``xmi:id``.

        Returns:
            None where there is no such element; for a path of names, it is not looked whether there is.
        """
        if not fragment.startswith("/"):
            return self._identified().get(fragment)
        if "@" not in fragment and "%" not in fragment:
            return fragment
        top, *steps = fragment[1:].split("/")
        number = int(top or 0) if len(top) < 9 and (not top or top.isdecimal()) else len(self._roots)
        node = self._roots[number] if number < len(self._roots) else None
        names = []
        for step in steps:
            node = self._inside_of(node).get(_normal(step)) if node is not None else None
            if node is None:
                return None
            names.append(node.get("name") or "")
        return "/".join(("", top, *names))

    def _inside_of(self, node: Node) -> dict[str, Node]:
        """Return the elements directly inside another by the steps that lead to them."""
        if id(node) not in self._steps:
            steps = self._steps[id(node)] = {}
            counts: dict[str, int] = {}
            for child in node:
                name, count = child.get("name") or "", counts.get(child.tag, 0)
                counts[child.tag] = count + 1
                for step in (name, f"@{child.tag}.{count}", f"@{child.tag} {name}"):
                    steps.setdefault(step, child)
        return self._steps[id(node)]

    def _identified(self) -> dict[str, str]:
        """Return where the elements with an id stand; worked out when the first is asked for."""
        if self._places is None:
            self._places = {}
            wanted = {id(node): name for name, node in self._ids.items()}
            pending = [
                (node, f"/{index or ''}") for index, node in enumerate(self._roots) if node is not None
            ]
            while pending and wanted:
                node, fragment = pending.pop()
                if id(node) in wanted:
                    self._places[wanted[id(node)]] = fragment
                pending += [(child, f"{fragment}/{child.get('name') or ''}") for child in node]
        return self._places


def _normal(step: str) -> str:
    """Return one step of a fragment in the form in which all elements are entered."""
    if named := _NAMED.fullmatch(step):
        return f"@{named[1]} {unquote(named[2])}"
    if not step.startswith("@"):
        return unquote(step)
    tag, _, index = step.partition(".")
    return f"{tag}.{index or 0}"
