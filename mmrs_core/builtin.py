"""The plug-in called core: MMRS's own contributions, through the same hooks as those of plug-ins."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from mmrs_core.contributions.symbols import CORE_SYMBOLS, MapSymbol
from mmrs_core.hookspecs import hookimpl

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Check
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.drawings import DrawingReader, Exporter
    from mmrs_core.contributions.fixes import Fix
    from mmrs_core.contributions.rules import MoveKind, RobotKind
    from mmrs_core.contributions.vehicles import VehicleFactory


@hookimpl
def mmrs_constraints() -> Iterable[Constraint]:
    """Contribute the constraints on missions, contexts, robot types and behaviours."""
    from mmrs_core.analysis.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_fixes() -> Iterable[Fix]:
    """Contribute fixes of misspelt names, and of figures with one possible meaning."""
    from mmrs_core.analysis.fixes import FIXES

    return FIXES


@hookimpl
def mmrs_robot_kinds() -> Iterable[RobotKind]:
    """Contribute the default robot kind: robots that move on their own level."""
    from mmrs_core.transformation.kinds import PLAIN_ROBOT

    return (PLAIN_ROBOT,)


@hookimpl
def mmrs_move_kinds() -> Iterable[MoveKind]:
    """Contribute the moves of the Behaviour Language."""
    from mmrs_core.transformation.kinds import MOVE_KINDS

    return MOVE_KINDS


@hookimpl
def mmrs_checks() -> Iterable[Check]:
    """Contribute the checks of behaviours."""
    from mmrs_core.analysis.checks import CHECKS

    return CHECKS


@hookimpl
def mmrs_vehicles() -> Iterable[VehicleFactory]:
    """Contribute the simulation."""
    from mmrs_core.simulation.simulation import SIMULATION

    return (SIMULATION,)


@hookimpl
def mmrs_map_symbols() -> Iterable[MapSymbol]:
    """Contribute how control tasks and relays look."""
    return CORE_SYMBOLS


@hookimpl
def mmrs_drawing_readers() -> Iterable[DrawingReader]:
    """Contribute readers of the formats that map programs share."""
    from mmrs_core.contributions.drawings import DrawingReader
    from mmrs_core.drawings import geojson, gpx, kml, point_table

    return (
        DrawingReader("KML", (".kml", ".kmz"), kml.recognise, kml.read),
        DrawingReader("GeoJSON", (".geojson", ".json"), geojson.recognise, geojson.read),
        DrawingReader("GPX", (".gpx",), gpx.recognise, gpx.read),
        DrawingReader("CSV", (".csv", ".tsv"), point_table.recognise, point_table.read),
    )


@hookimpl
def mmrs_exporters() -> Iterable[Exporter]:
    """Contribute the formats that map programs share."""
    from mmrs_core.contributions.drawings import Exporter
    from mmrs_core.drawings import geojson, gpx_writer, kml_writer
    from mmrs_core.drawings.drawing import HeightReference

    level, ellipsoid = (HeightReference.SEA_LEVEL,), (HeightReference.ELLIPSOID,)
    return (
        Exporter(
            "geojson", "GeoJSON, for QGIS and others", ".geojson", geojson.write, geojson.losses, ellipsoid
        ),
        Exporter("gpx", "GPX, for receivers and others", ".gpx", gpx_writer.write, gpx_writer.losses, level),
        Exporter(
            "kml",
            "KML, for Google Earth, QGIS and others",
            ".kml",
            kml_writer.write,
            kml_writer.losses,
            level,
        ),
        Exporter("kmz", "KML in an archive", ".kmz", kml_writer.write_archive, kml_writer.losses, level),
    )
