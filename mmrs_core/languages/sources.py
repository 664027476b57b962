"""Where metamodels come from; apart from the registry, so that plug-ins load without the languages."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class MetamodelSource:
    """A metamodel that a plug-in provides.

    Attributes:
        ns_uri: of the package, as its file states it.
        ecore: the .ecore file, a pyecore EPackage, or a module that pyecoregen wrote.
        provider: the distribution that brings it.
    """

    ns_uri: str
    ecore: Path | object
    provider: str = "core"
