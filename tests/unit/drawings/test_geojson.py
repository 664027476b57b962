import json

import pytest

from mmrs_core.contributions.drawings import reader_for
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference
from mmrs_core.drawings.geojson import read, write
from mmrs_core.errors import UnreadableError

AREA = [[[8, 47], [8, 47.1], [8.1, 47.1], [8, 47]]]


def feature(type: str, coordinates: object, **properties: object) -> str:
    geometry = {"type": type, "coordinates": coordinates}
    return json.dumps({"type": "Feature", "properties": properties, "geometry": geometry})


def collection(*features: str, **members: object) -> bytes:
    more = "".join(f"{json.dumps(key)}: {json.dumps(value)},\n" for key, value in members.items())
    lines = ",\n".join(features)
    return f'{{"type": "FeatureCollection",\n{more}"features": [\n{lines}]}}'.encode()


def test_every_kind_of_geometry_becomes_features():
    data = collection(
        feature("Polygon", AREA, Name="North", crop="wheat", rows=[1, 2], none=None),
        feature("MultiPoint", [[8, 47, 400], [8.1, 47, 401]]),
        feature("MultiLineString", [[[8, 47], [8, 48]], [[9, 47], [9, 48]]]),
        feature("MultiPolygon", [AREA, AREA], stroke="#FF0000"),
        name="farm",
    )
    drawing = read(data, "farm.geojson")
    north, *others = drawing.features
    assert drawing.title == "farm"
    assert (north.name, north.properties) == ("North", {"crop": "wheat", "rows": "[1, 2]"})
    assert north.rings[0].tolist() == [[47, 8], [47.1, 8], [47.1, 8.1]]
    assert (str(north.place), north.place.path) == ("farm.geojson:4", "/features[0]")
    assert [each.geometry for each in others] == [
        *[Geometry.POINT] * 2,
        *[Geometry.LINE] * 2,
        *[Geometry.AREA] * 2,
    ]
    assert [each.place.line for each in others] == [5, 5, 6, 6, 7, 7]
    assert (others[0].reference, others[0].heights[0].tolist()) == (HeightReference.ELLIPSOID, [400])
    assert others[-1].colour == "#ff0000"


@pytest.mark.parametrize(
    ("data", "geometries"),
    [
        (b'{"type": "Point", "coordinates": [8, 47]}', ["point"]),
        (
            b'\xef\xbb\xbf{"type": "Feature", "geometry": {"type": "Polygon",'
            b'"coordinates": [[[8, 47], [9, 47], [9, 48]]]}}',
            ["area"],
        ),
        (
            b'{"type": "GeometryCollection", "geometries": [{"type": "Point", "coordinates": [8, 47]},'
            b'{"type": "GeometryCollection", "geometries":'
            b'[{"type": "LineString", "coordinates": [[8, 47], [9, 48]]}]}]}',
            ["point", "line"],
        ),
    ],
)
def test_features_and_geometries_may_stand_alone(data, geometries):
    assert [each.geometry.value for each in read(data, "a.json").features] == geometries


def test_what_is_no_feature_is_left_out_with_its_line_and_reason():
    empty = '{"type": "Feature", "properties": {"name": "gone"}, "geometry": null, "when": 1}'
    mixed = feature("LineString", [[8, 47, 1], [8, 48]], name="mixed")
    data = collection(empty, mixed, feature("LineString", [[8, 47, 1, 2], [8, 48, 1, 2]]), timeStamp="now")
    left_out = {(each.place.line, each.what): each.reason for each in read(data, "a.json").left_out}
    assert left_out == {
        (1, "member 'timeStamp'"): "not of GeoJSON",
        (4, "feature 'gone'"): "no geometry",
        (4, "member 'when' of feature 'gone'"): "not of GeoJSON",
        (5, "heights of feature 'mixed'"): "some positions have none",
        (6, "further values of features[2]"): "a position has at most three",
    }


@pytest.mark.parametrize("name", ["urn:ogc:def:crs:EPSG::25832", "EPSG:25832"])
def test_another_coordinate_reference_system_is_transformed(name):
    crs = {"type": "name", "properties": {"name": name}}
    (point,) = read(collection(feature("Point", [500000, 5200000]), crs=crs), "a.json").features
    assert point.rings[0][0] == pytest.approx([46.953, 9.0], abs=0.001)


@pytest.mark.parametrize("name", ["urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326", None])
def test_degrees_stay_as_they_are(name):
    crs = {"type": "name", "properties": {"name": name}} if name else None
    (point,) = read(collection(feature("Point", [8, 47]), crs=crs), "a.json").features
    assert point.rings[0].tolist() == [[47, 8]]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b" ", r"^a\.json: empty"),
        (b'{"type": "Point"\n "x": 1}', r"^a\.json:2: not JSON: expecting ','"),
        (b"[1]", r"^a\.json:1: an object is expected"),
        (b'{"type": "Point", "coordinates": [8, 47]}\n]', r"^a\.json:2: not JSON: more text after its end"),
        (b'{"a": "\xff"}', r"^a\.json:1: not UTF-8"),
        (b'{"coordinates": ' + b"[" * 10**5, r"^a\.json:1: nested too deeply"),
        (b"[" * 5_000_001, r"^a\.json: more than 5000000 arrays and objects"),
        (
            collection(feature("Point", [8, 47]), feature("Point", ["8", 47])),
            r'^a\.json:4: .* "8" of position 1 is not a num',
        ),
        (
            collection('{"type": "Feature", "type": "Feature"}'),
            r"^a\.json:3: not JSON: 'type' is given twice",
        ),
        (b'{"type": "Point", "coordinates": [8, NaN]}', r"^a\.json:1: not JSON: NaN is not a number"),
        (b'{"type": "Point", "coordinates": [8, 1e999]}', r"^a\.json:1: .* is not a finite number"),
        (
            b'{"type": "Point", "coordinates": [8, 1' + b"0" * 400 + b"]}",
            r"^a\.json:1: .* of position 1 is too large",
        ),
        (
            b'{"type": "Point", "coordinates": [47, 95]}',
            r"are the axes swapped\? GeoJSON has the longitude first",
        ),
        (b'{"type": "Circle", "coordinates": [47, 95]}', "'Circle' is not a type of geometry"),
        (collection("7"), r"features\[0\] is not an object"),
        (collection(crs={"type": "link"}), "not understood; save the file in WGS 84"),
        (collection(crs={"properties": {"name": "EPSG:999999"}}), "crs EPSG:999999: not known"),
    ],
)
def test_what_is_no_geojson_is_refused_with_its_line(data, message):
    with pytest.raises(UnreadableError, match=message):
        read(data, "a.json")


def test_a_shape_over_the_antimeridian_is_written_in_one_piece():
    data = collection(feature("Polygon", [[[179, 0], [-179, 0], [-179, 1], [179, 1]]]))
    written = json.loads(write(read(data, "a.json"), ""))
    assert written["features"][0]["geometry"]["coordinates"] == [
        [[179, 0], [181, 0], [181, 1], [179, 1], [179, 0]]
    ]


def test_positions_are_arrays():
    line = ",".join(f"[{8 + n * 1e-6:.6f},47]" for n in range(10**5))
    data = f'{{"type": "LineString", "coordinates": [{line}]}}'.encode()
    assert read(data, "a.json").features[0].rings[0].shape == (10**5, 2)


@pytest.mark.parametrize(
    ("data", "file", "name"),
    [
        (b"", "a.KMZ", "KML"),
        (b"", "a.geojson", "GeoJSON"),
        (b'<?xml version="1.0"?><!-- <gpx> --><kml xmlns="x">', "drawing", "KML"),
        (b'{"features": [], "type": "FeatureCollection"}', "drawing.txt", "GeoJSON"),
    ],
)
def test_the_suffix_or_else_the_content_tells_the_format(data, file, name, contributions):
    assert reader_for(data, file, contributions.drawing_readers).name == name


def test_an_unknown_format_is_refused_with_those_that_are_known(contributions):
    with pytest.raises(UnreadableError, match=r"^a\.xyz: of no format that is known: .*KML \(\.kml, \.kmz\)"):
        reader_for(b"0\nSECTION", "a.xyz", contributions.drawing_readers)
    with pytest.raises(UnreadableError, match=r"^a\.SHP: \.shp is not read; save it as GeoJSON in WGS 84"):
        reader_for(b"\0\0\x27\x0a", "a.SHP", contributions.drawing_readers)


def test_nothing_drawn_is_a_file_without_features():
    assert read(write(Drawing(()), "empty"), "a.json") == Drawing((), (), "empty")
