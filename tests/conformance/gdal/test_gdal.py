"""GDAL, which QGIS and many others read with, opens what is written, and what it writes is read."""

from __future__ import annotations

import json
import subprocess

import numpy as np
import pytest

from mmrs_core.contributions.drawings import reader_for
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, Role

pytestmark = pytest.mark.peer

FIELD = np.array([[47.0, 8.0], [47.0, 8.01], [47.01, 8.01]])
LEVEL = HeightReference.SEA_LEVEL
DRAWING = Drawing(
    (
        MapFeature(
            Geometry.AREA,
            (FIELD, FIELD * 0.5 + FIELD.mean(0) * 0.5),
            name="north meadow",
            folders=("fields",),
        ),
        MapFeature(Geometry.LINE, (FIELD,), (np.full(3, 430.0),), LEVEL, name="path", role=Role.PATH),
        MapFeature(
            Geometry.LINE,
            (FIELD,),
            (np.full(3, 430.0),),
            LEVEL,
            np.arange(3.0),
            name="flown",
            role=Role.TRACK,
        ),
        MapFeature(
            Geometry.POINT, (FIELD[:1],), name="photo & <one>", role=Role.PHOTO, properties={"camera": 2}
        ),
    )
)


@pytest.fixture
def gdal(need_program, tmp_path):
    """Return a function that runs a program of GDAL in a folder for the test, and returns what it prints."""

    def run(name: str, *arguments: str) -> str:
        program = need_program(name, "reads and writes maps, as QGIS does")
        command = [program, *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr
        return done.stdout

    return run


@pytest.mark.parametrize("name", ["geojson", "kml", "kmz", "gpx"])
def test_gdal_opens_what_is_written(name, contributions, gdal, tmp_path):
    exporter = contributions.exporters[name]
    (tmp_path / f"farm{exporter.suffix}").write_bytes(exporter.write(DRAWING, "farm"))
    shown = gdal("ogrinfo", "-ro", "-al", f"farm{exporter.suffix}")
    assert all(feature.name in shown for feature in DRAWING.features)
    assert all(shape in shown for shape in ("POINT", "LINESTRING"))
    assert name == "gpx" or "POLYGON" in shown


@pytest.mark.parametrize(
    ("driver", "suffix"), [("KML", ".kml"), ("LIBKML", ".kmz"), ("GeoJSON", ".geojson"), ("CSV", ".csv")]
)
def test_what_gdal_writes_is_read(driver, suffix, contributions, gdal, tmp_path):
    points = Drawing((DRAWING.features[3],)) if driver == "CSV" else Drawing((DRAWING.features[0],))
    (tmp_path / "farm.geojson").write_bytes(contributions.exporters["geojson"].write(points, "farm"))
    options = ("-lco", "GEOMETRY=AS_YX") if driver == "CSV" else ()
    gdal("ogr2ogr", "-f", driver, *options, f"out{suffix}", "farm.geojson")
    data = (tmp_path / f"out{suffix}").read_bytes()
    (feature,) = reader_for(data, f"out{suffix}", contributions.drawing_readers).read(data, "out").features
    assert feature.name == points.features[0].name
    assert {tuple(each) for each in feature.rings[0].round(7)} == {
        tuple(each) for each in points.features[0].rings[0].round(7)
    }


def test_coordinates_of_another_system_come_to_the_same_place(contributions, gdal, tmp_path):
    (tmp_path / "farm.geojson").write_bytes(contributions.exporters["geojson"].write(DRAWING, "farm"))
    gdal(
        "ogr2ogr",
        "-f",
        "GeoJSON",
        "-t_srs",
        "EPSG:25832",
        "-lco",
        "RFC7946=NO",
        "metres.geojson",
        "farm.geojson",
    )
    data = (tmp_path / "metres.geojson").read_bytes()
    assert "EPSG::25832" in json.loads(data)["crs"]["properties"]["name"]
    field = (
        reader_for(data, "metres.geojson", contributions.drawing_readers)
        .read(data, "metres.geojson")
        .features[0]
    )
    assert np.abs(np.sort(field.rings[0], axis=0) - np.sort(FIELD, axis=0)).max() < 1e-7
