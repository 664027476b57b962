"""What this plug-in contributes."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.registry import MetamodelSource


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Return the metamodel of this plug-in."""
    ecore = Path(str(files("mmrs_survey"))) / "metamodels" / "survey.ecore"
    return (MetamodelSource("urn:mmrs:survey:1.0", ecore, "survey"),)
