"""Hints about metamodels that a model needs and that are not installed."""

from __future__ import annotations

import re

from mmrs_core.languages.naming import typo_of
from mmrs_core.languages.registry import Registry

_VERSION = re.compile(r"(.*?)[:/]v?([0-9]+(?:\.[0-9]+)*)/?")

_OWN = "urn:mmrs:"
"""How the nsURIs of our own languages and plug-ins begin; the plug-in is called alike."""

_KEPT = "the element is kept as it is"


def stem_of(ns_uri: str) -> str:
    """Return an nsURI without the version at its end.

    >>> stem_of("urn:mmrs:kites:1.0"), stem_of("http://library/2.1"), stem_of("urn:kites")
    ('urn:mmrs:kites', 'http://library', 'urn:kites')
    """
    match = _VERSION.fullmatch(ns_uri)
    return match[1] if match else ns_uri


def is_own(ns_uri: str) -> bool:
    """Return whether a language is one of ours, installed or not."""
    return ns_uri.startswith(_OWN)


def is_near(ns_uri: str, registry: Registry) -> bool:
    """Return whether an nsURI is, or was meant to be, of a language that is installed or could be."""
    installed = [package.ns_uri for package in registry.everything]
    stems = set(map(stem_of, installed))
    return is_own(ns_uri) or stem_of(ns_uri) in stems or bool(typo_of(ns_uri, installed))


def hint_for(ns_uri: str, registry: Registry, kept: str = _KEPT) -> str:
    """Return what to do about a metamodel that a model needs and that is not installed, and what was `kept`.

    The hint names another version that is installed, a metamodel of nearly the same name, or the plug-in
    that provides it, by its likely name if it is one of ours; of another tool's language, how to import it.
    """
    stem = stem_of(ns_uri)
    installed = [package.ns_uri for package in registry.packages]
    others = [known for known in installed if stem_of(known) == stem]
    if others:
        known = " and ".join(others)
        return f"{known} is installed, but no migration leads there from this version; {kept}"
    importer = next((each for each in registry.importers if each.covers(ns_uri)), None)
    if importer is not None:
        whole = f"a language of {importer.name}: only files entirely of it are imported"
        return f"{whole}; {importer.advice}; {kept}"
    guess = typo_of(ns_uri, installed)
    missing = f"a plug-in is missing: install the one that provides {ns_uri}, {_likely(stem)}; {kept}"
    return f"{guess} else {missing}" if guess else missing


def _likely(stem: str) -> str:
    """Return which plug-in may provide a language: one of ours is called as the language, or shorter."""
    if not is_own(stem):
        return "or write it ('mmrs plugin new')"
    words = stem.removeprefix(_OWN).split("-")
    return f"such as {' or '.join('-'.join(('mmrs', *words[:count])) for count in range(len(words), 0, -1))}"
