"""Classes of our languages by the names that a mapping gives them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.registry import Registry


@dataclass(frozen=True, slots=True)
class Classes:
    """Classes of ours by the names that a mapping gives them.

    Attributes:
        languages: nsURIs by the short names of the mapping.
    """

    registry: Registry
    languages: Mapping[str, str]

    def named(self, text: str) -> Metaclass:
        """Return the class that ``language:Name`` means.

        Raises:
            ValueError: if there is none, or no element can be made of it.
        """
        prefix, _, name = text.partition(":")
        if prefix not in self.languages:
            raise ValueError(f"{text!r}: {prefix!r} is none of the languages ({', '.join(self.languages)})")
        metaclass = self.registry.metaclass(self.languages[prefix], name)
        if metaclass.abstract:
            raise ValueError(f"{text} is abstract")
        return metaclass

    def within(self, feature: Feature, text: str) -> Metaclass:
        """Return the class of what a path makes in a feature; an empty text leaves it to the feature.

        Raises:
            ValueError: if it is none that the feature takes, or one that no element can be made of.
        """
        kind = feature.type
        assert isinstance(kind, Metaclass)  # asked before
        if ":" in text:
            found = self.named(text)
        elif text:
            found = self.registry.metaclass(kind.ns_uri, text)
        else:
            found = kind
        if not found.is_kind(*kind.key):
            raise ValueError(f"{found.name} is no {kind.name}, which {feature.name} takes")
        if found.abstract:
            raise ValueError(self._abstract(feature, found))
        return found

    def _abstract(self, feature: Feature, kind: Metaclass) -> str:
        uris = (kind.ns_uri, *self.languages.values())
        packages = [self.registry.package(uri) for uri in dict.fromkeys(uris)]
        names = [
            each.name
            for package in packages
            for each in package.metaclasses
            if each.is_kind(*kind.key) and not each.abstract
        ]
        example = f"{feature.name}:{names[0]}" if names else f"{feature.name}:CLASS"
        known = ", ".join(dict.fromkeys(names))
        return f"{kind.name} is abstract: state a concrete class ({known}), as in {example}"
