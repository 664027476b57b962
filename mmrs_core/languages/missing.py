"""What is told of a metamodel that a model needs and that is not installed."""

from __future__ import annotations

import re
from types import MappingProxyType

from mmrs_core.languages.naming import typo_of
from mmrs_core.languages.registry import Registry

_VERSION = re.compile(r"(.*?)[:/]v?([0-9]+(?:\.[0-9]+)*)/?")

DISTRIBUTIONS = MappingProxyType(
    {
        "urn:mmrs:multicopter": "mmrs-multicopter",
        "urn:mmrs:auv": "mmrs-auv",
        "urn:mmrs:survey": "mmrs-survey",
        "urn:mmrs:solar": "mmrs-solar",
        "urn:mmrs:rover": "mmrs-rover",
    }
)
"""The distributions that bring our own plug-ins' metamodels, by nsURI without its version."""


def stem_of(ns_uri: str) -> str:
    """Return an nsURI without the version at its end.

    >>> stem_of("urn:mmrs:survey:1.0"), stem_of("http://library/2.1"), stem_of("urn:kites")
    ('urn:mmrs:survey', 'http://library', 'urn:kites')
    """
    match = _VERSION.fullmatch(ns_uri)
    return match[1] if match else ns_uri


def missing_metamodel(ns_uri: str, name: str, registry: Registry) -> tuple[str, str]:
    """Return message and hint for an element of a class of a metamodel that is not installed.

    The hint names another version that is installed, a metamodel of nearly the same name, or the plug-in
    that brings it, with its distribution where that is known.
    """
    stem = stem_of(ns_uri)
    message = f"{ns_uri}: no such metamodel, needed for {name}"
    installed = [package.ns_uri for package in registry.packages]
    others = [known for known in installed if stem_of(known) == stem]
    if others:
        hint = f"{' and '.join(others)} is installed, and no migration leads there from this version"
        return message, f"{hint}; the element is kept as it is"
    distribution = DISTRIBUTIONS.get(stem, "")
    brings = f"install {distribution}, which brings it" if distribution else "install the one that brings it"
    missing = f"a plug-in is missing: {brings}; the element is kept as it is"
    guess = "" if distribution else typo_of(ns_uri, installed)
    return message, f"{guess} else {missing}" if guess else missing
