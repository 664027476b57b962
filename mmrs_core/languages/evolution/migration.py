"""How models of one version of a language become models of the next, and which steps lead where."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from mmrs_core.errors import PluginError
from mmrs_core.languages.metaclass import Metaclass

if TYPE_CHECKING:
    from mmrs_core.languages.json_form.tree import Node


Refer = Callable[["Node"], "Node"]
"""Returns a reference to an element of the model."""

_ENCODINGS = ("utf-8", "utf-16-le", "utf-16-be", "utf-32-le", "utf-32-be")
_NOTHING: Mapping[str, str] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class Migration:
    """One step from a version of a language to the next; it runs when an older model is read.

    A feature is named ``Class.feature``, by the old names, and meant for the subclasses of that class as
    well, in whatever language they are.

    Attributes:
        from_uri: nsURI of the older version.
        to_uri: nsURI of the newer one.
        classes: new names of classes by old ones.
        features: new names of features by old ones, such as ``{"Kite.string": "line"}``.
        values: new values by old ones, as they stand in files, by the old name of the feature.
        dropped: features that the newer version has no place for; a warning tells each value that is lost.
        rewrite: called with each element of the language after all that, outer ones before inner ones, to
            change its `members` in place; numbers and truth values are text there.
        rewrite_holder: called, when the whole model has been through that, with each element of another
            language that holds elements of this one, outer ones before inner ones, and with what makes
            references to elements: to change what stands where.
    """

    from_uri: str
    to_uri: str
    classes: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    features: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    values: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    dropped: frozenset[str] = frozenset()
    rewrite: Callable[[Node], None] | None = None
    rewrite_holder: Callable[[Node, Refer], None] | None = None

    @property
    def step(self) -> str:
        """Return from which version it leads to which."""
        return f"{self.from_uri} to {self.to_uri}"

    def __post_init__(self) -> None:
        """Refuse names of features that name no class.

        Raises:
            ValueError: if a feature is not written ``Class.feature``.
        """
        for name in (*self.features, *self.values, *self.dropped):
            owner, dot, feature = name.partition(".")
            if not (owner and dot and feature):
                raise ValueError(f"{name!r}: a feature is written Class.feature")


def may_be_old(data: bytes, older: Iterable[str]) -> bool:
    """Return whether a file mentions one of the nsURIs of older versions."""
    texts = (ns_uri.encode(form) for ns_uri in older for form in _ENCODINGS)
    return any(text in data for text in texts)


def chains(migrations: Iterable[Migration], installed: Container[str]) -> Mapping[str, tuple[Migration, ...]]:
    """Return the steps that lead from each old nsURI to an installed one; none for those that lead nowhere.

    Raises:
        PluginError: if steps lead in a circle, or two begin at one nsURI.
    """
    steps: dict[str, Migration] = {}
    for migration in migrations:
        if migration.from_uri in steps:
            raise PluginError(f"{migration.from_uri}: two migrations begin there")
        steps[migration.from_uri] = migration
    found = {start: _chain(start, steps, installed) for start in steps if start not in installed}
    return {start: chain for start, chain in found.items() if chain}


def _chain(start: str, steps: Mapping[str, Migration], installed: Container[str]) -> tuple[Migration, ...]:
    chain: list[Migration] = []
    ns_uri = start
    while ns_uri not in installed:
        if ns_uri not in steps:
            return ()
        if any(step.from_uri == ns_uri for step in chain):
            raise PluginError(f"{start}: its migrations lead in a circle")
        chain.append(steps[ns_uri])
        ns_uri = steps[ns_uri].to_uri
    return tuple(chain)


Kind = tuple[str, str]
"""nsURI and name of a class, in some version."""

Meant = TypeVar("Meant")


class Renaming:
    """The steps of a model, with what each class is called in the end."""

    def __init__(self, chains: Mapping[str, Sequence[Migration]]) -> None:
        """Take the steps from each old nsURI to the installed version."""
        self._chains = chains
        self.steps = tuple(step for _, chain in sorted(chains.items()) for step in chain)
        self._later = {
            step.from_uri: chain[place + 1 :] for chain in chains.values() for place, step in enumerate(chain)
        }

    def begins(self, ns_uri: str) -> bool:
        """Return whether elements of that language are migrated."""
        return ns_uri in self._chains

    def last(self, kind: Kind) -> Kind:
        """Return what a class of the model is called in the end."""
        for step in self._chains.get(kind[0], ()):
            kind = after(step, kind)
        return kind

    def first(self, kind: Kind) -> Kind:
        """Return what a class was called in the version that the model is of."""
        for start, chain in self._chains.items():
            if chain[-1].to_uri == kind[0]:
                name = kind[1]
                for step in reversed(chain):
                    name = {new: old for old, new in step.classes.items()}.get(name, name)
                return start, name
        return kind

    def feature(self, name: str, kind: Kind, final: Metaclass) -> str:
        """Return what a feature of an element is called in the end."""
        for step in self.steps:
            name = self.meant(step.features, step, kind, final).get(name, name)
            kind = after(step, kind)
        return name

    def meant(
        self, named: Mapping[str, Meant], step: Migration, kind: Kind, final: Metaclass | None
    ) -> Mapping[str, Meant]:
        """Return what is said of features, by their bare names, as far as it is meant for an element.

        Args:
            named: by ``Class.feature``, the class as it was called before the step.
            step: which says it.
            kind: the element's class before the step.
            final: its class in the end; None where that is not known.
        """
        found: dict[str, Meant] = {}
        for name, said in named.items():
            owner, _, feature = name.partition(".")
            if kind == (step.from_uri, owner):
                found[feature] = said
            elif final is not None and final.is_kind(*self._image(step, owner)):
                found.setdefault(feature, said)
        return found

    def _image(self, step: Migration, owner: str) -> Kind:
        kind = after(step, (step.from_uri, owner))
        for later in self._later[step.from_uri]:
            kind = after(later, kind)
        return kind


def after(step: Migration, kind: Kind) -> Kind:
    """Return what a class is called after a step.

    >>> after(Migration("a:1", "a:2", classes={"Kite": "Wing"}), ("a:1", "Kite"))
    ('a:2', 'Wing')
    """
    if kind[0] != step.from_uri:
        return kind
    return step.to_uri, step.classes.get(kind[1], kind[1])
