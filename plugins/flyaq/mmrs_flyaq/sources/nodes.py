"""What a source file says, whatever its format: elements, values and references with their lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from mmrs_core.diagnostics import Place
from mmrs_core.errors import UnreadableError

DEEPEST_NESTING = 100
"""Levels of elements in each other that are read, in whichever format."""
STRAY = "#text"
"""The feature, which no metamodel has, of text where only elements may stand."""


def too_deep(file: str, line: int) -> UnreadableError:
    """Return the error for an element inside more than `DEEPEST_NESTING` others."""
    return UnreadableError(f"{file}:{line}: nested deeper than {DEEPEST_NESTING} levels")


@dataclass(frozen=True, slots=True)
class Text:
    """The value of an attribute, as it is written."""

    text: str
    line: int


@dataclass(slots=True, eq=False)
class Link:
    """A reference.

    Attributes:
        text: a path such as ``//@tasks.0`` within the same file, or an identifier.
        target: the node it leads to; None until it is resolved, and where it leads nowhere.
    """

    text: str
    line: int
    target: SourceNode | None = None


@dataclass(frozen=True, slots=True)
class Claim:
    """The class that an element says it is of.

    Attributes:
        document: nsURI, prefix or file of the metamodel.
        name: of the class.
    """

    document: str
    name: str


@dataclass(slots=True, eq=False)
class SourceNode:
    """One element.

    Attributes:
        file: as the user gave it.
        claim: the class it names itself; None where the feature that holds it decides.
        kind: ``package.Class`` in the words of the mapping; empty until it is known.
        parent, feature, index: where it stands.
        many: whether the feature that holds it may hold several.
    """

    file: str
    line: int
    claim: Claim | None = None
    values: dict[str, list[Text | Link | SourceNode]] = field(default_factory=dict)
    kind: str = ""
    parent: SourceNode | None = None
    feature: str = ""
    index: int = 0
    many: bool = True

    def add(self, feature: str, value: Text | Link | SourceNode) -> None:
        """Put a value behind those that the feature holds."""
        held = self.values.setdefault(feature, [])
        if isinstance(value, SourceNode):
            value.parent, value.feature, value.index = self, feature, len(held)
        held.append(value)

    def texts(self, feature: str) -> tuple[str, ...]:
        """Return the texts that a feature holds."""
        return tuple(value.text for value in self.values.get(feature, ()) if isinstance(value, Text))

    def text(self, feature: str) -> str:
        """Return the first text that a feature holds, or an empty one."""
        return next(iter(self.texts(feature)), "")

    def nodes(self, feature: str) -> tuple[SourceNode, ...]:
        """Return the elements that a feature contains."""
        return tuple(value for value in self.values.get(feature, ()) if isinstance(value, SourceNode))

    def links(self, feature: str) -> tuple[Link, ...]:
        """Return the references that a feature holds."""
        return tuple(value for value in self.values.get(feature, ()) if isinstance(value, Link))

    @property
    def name(self) -> str:
        """What the class is called, without its package."""
        return self.kind.rpartition(".")[2] or (self.claim.name if self.claim else self.feature)

    @property
    def root(self) -> SourceNode:
        """The outermost element."""
        node = self
        while node.parent is not None:
            node = node.parent
        return node

    def path(self) -> str:
        """Return features and positions from the root, such as ``/tasks[2]/point``."""
        steps: list[str] = []
        node = self
        while node.parent is not None:
            steps.append(f"/{node.feature}[{node.index}]" if node.many else f"/{node.feature}")
            node = node.parent
        return "".join(reversed(steps)) or "/"

    def place(self, line: int = 0) -> Place:
        """Return where it stands, or a value of it on a line of its own."""
        return Place(self.file, line or self.line, self.path())

    def called(self) -> str:
        """Return what messages call it: its class and, where it has one, its name."""
        label = self.text("name")
        return f"{self.name}{label and f' {label!r}'}"

    def inside(self) -> Iterator[SourceNode]:
        """Yield it and all elements in it, outer ones before inner ones."""
        pending = [self]
        while pending:
            node = pending.pop()
            yield node
            inner = [
                value for values in node.values.values() for value in values if isinstance(value, SourceNode)
            ]
            pending.extend(reversed(inner))


@dataclass(frozen=True, slots=True)
class SourceDocument:
    """What one source file holds.

    Attributes:
        file: as the user gave it.
        roots: the elements at its top.
        locations: where the file itself says that metamodels lie, by nsURI.
        ids: the elements to which the file itself gives identifiers (``xmi:id``).
    """

    file: str
    roots: tuple[SourceNode, ...]
    locations: tuple[tuple[str, str], ...] = ()
    ids: Mapping[str, SourceNode] = field(default_factory=dict)
