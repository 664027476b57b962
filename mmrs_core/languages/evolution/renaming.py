"""Which of a migration's renames are meant for an element, whose class may be of another language."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.metaclass import Metaclass

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
