"""GDAL, which QGIS and many others read with, opens what is written, and what it writes is read."""

import json
import os
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

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


@pytest.mark.parametrize("name", ["geojson", "kml", "kmz", "gpx"])
def test_gdal_shows_names_as_they_are_whatever_they_hold(name, contributions, gdal, tmp_path):
    names = [
        "<b>bold</b>",
        "]]>",
        "\"1\" '2'",
        "a\u202eb",
        "\x00\x1b[31mred",
        "&amp;<",
        "-->",
        "\ud800!",
        "日本語 🚁",
    ]
    features = [
        replace(DRAWING.features[0], name=each, description=each, folders=(each,), properties={each: each})
        for each in names
    ]
    exporter = contributions.exporters[name]
    (tmp_path / f"names{exporter.suffix}").write_bytes(exporter.write(Drawing(tuple(features)), "]]><x>"))
    shown = gdal("ogrinfo", "-ro", "-al", f"names{exporter.suffix}")
    assert all(feature.name in shown for feature in features)


@pytest.mark.parametrize(("name", "schema"), [("kml", "kml22gx.xsd"), ("gpx", "gpx.xsd")])
def test_what_is_written_is_valid_against_the_schema_of_its_format(name, schema, contributions):
    folder = os.environ.get("MMRS_SCHEMAS")
    if folder is None:
        pytest.skip(
            "MMRS_SCHEMAS is not set: the folder with the schemas of KML 2.2, its gx extension, and GPX 1.1"
        )
    far = replace(
        DRAWING.features[1], rings=(np.array([[-17.0, 179.999], [-17.0, 180.0], [-17.001, -179.999]]),)
    )
    written = contributions.exporters[name].write(Drawing((*DRAWING.features, far)), "farm")
    etree.XMLSchema(etree.parse(Path(folder) / schema)).assertValid(etree.fromstring(written))


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
