import io
import zipfile

import numpy as np
import pytest

from mmrs_core.drawings.drawing import Geometry, HeightReference, Role
from mmrs_core.drawings.kml import MOST_ENTRIES, read
from mmrs_core.drawings.sheet import LARGEST_FILE
from mmrs_core.errors import UnreadableError

FARM = b"""<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">
<Document><name>farm</name>
<Schema name="s" id="s"><SimpleField type="double" name="hectares"/></Schema>
<Folder><name>Fields</name>
<Placemark><name>North</name><description><![CDATA[<!DOCTYPE html><b>wet</b>]]></description>
<ExtendedData><SchemaData schemaUrl="#s"><SimpleData name="hectares">3.5</SimpleData></SchemaData>
<Data name="crop"><value>wheat</value></Data></ExtendedData>
<Polygon><outerBoundaryIs><LinearRing><coordinates>
8,47,5 8.01,47,5
8.01,47.01,5 8,47,5
</coordinates></LinearRing></outerBoundaryIs>
<innerBoundaryIs><LinearRing><coordinates>8.005,47.001 8.006,47.001 8.005,47.001</coordinates></LinearRing>
</innerBoundaryIs></Polygon></Placemark>
<GroundOverlay><name>photo</name></GroundOverlay>
<Placemark><name>parts</name><MultiGeometry>
<Point><altitudeMode>absolute</altitudeMode><coordinates>8, 47, 400</coordinates></Point><Model id="x"/>
<LineString><altitudeMode>relativeToGround</altitudeMode>
<coordinates>8,47,10 8.1,47.2,20</coordinates></LineString>
<LinearRing><coordinates>8,47 8.1,47 8.1,47.1</coordinates></LinearRing>
</MultiGeometry></Placemark>
<Placemark><name>flown</name><gx:Track><altitudeMode>absolute</altitudeMode>
<when>2020-01-01T00:00:00Z</when><when>2020-01-01T01:00:05+01:00</when>
<gx:coord>8 47 1</gx:coord><gx:coord>8.1 47 2</gx:coord></gx:Track></Placemark>
</Folder><NetworkLink><name>more</name></NetworkLink><Foo/></Document></kml>
"""


def test_every_kind_of_placemark_becomes_features():
    field, point, line, ring, track = read(FARM, "farm.kml").features
    assert (field.name, field.folders, field.geometry) == ("North", ("Fields",), Geometry.AREA)
    assert field.rings[0].tolist() == [[47, 8], [47, 8.01], [47.01, 8.01]]
    assert field.properties == {"hectares": 3.5, "crop": "wheat"}
    assert str(field.place) == "farm.kml:6"
    assert (point.reference, point.heights[0].tolist()) == (HeightReference.SEA_LEVEL, [400])
    assert (line.reference, line.heights[0].tolist()) == (HeightReference.GROUND, [10, 20])
    assert (ring.geometry, len(ring.rings[0])) == (Geometry.AREA, 3)
    assert track.role is Role.TRACK
    assert track.times.tolist() == [1577836800, 1577836805]


def test_everything_else_is_left_out_by_name_with_its_line_and_reason():
    left_out = {(each.place.line, each.what): each.reason for each in read(FARM, "farm.kml").left_out}
    assert left_out == {
        (9, "heights of placemark 'North'"): "not used with altitudeMode clampToGround",
        (6, "holes of placemark 'North': 1"): "fewer than 3 different positions",
        (15, "ground overlay 'photo'"): "a picture, not a shape",
        (17, "model of placemark 'parts'"): "a body, not a shape",
        (25, "network link 'more'"): "links are not followed",
        (25, "foo"): "not read in a Document",
    }


def placemark(coordinates: str, line: str = "Point", name: str = "") -> bytes:
    shape = f"<{line}><coordinates>{coordinates}</coordinates></{line}>"
    return f"<kml>\n<Placemark><name>{name}</name>{shape}</Placemark></kml>".encode()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", r"^a\.kml: empty"),
        (b"\xef\xbb\xbf \n", r"^a\.kml: empty"),
        (b"\x00" * (LARGEST_FILE + 1), r"^a\.kml: larger than 128 MB"),
        (b"<kml>\n<Placemark>", r"^a\.kml:2: not well-formed XML"),
        (b"<kml>\xff</kml>", r"^a\.kml:1: not well-formed XML"),
        (b'<!DOCTYPE kml [<!ENTITY a SYSTEM "file:///etc/passwd">]>\n<kml>&a;</kml>', r"^a\.kml:1: DOCTYPE"),
        (b"<kml>" + b"<Folder>" * 100_000, r"^a\.kml:1: nested deeper than 400 levels"),
        (b"<gpx/>", r"^a\.kml:1: 'gpx' is not the root of a KML file"),
        (placemark("nan,47"), r"^a\.kml:2: placemark: a coordinate of position 1 is not a finite number"),
        (placemark("1e999,47"), r"^a\.kml:2: placemark: a coordinate of position 1 is not a finite number"),
        (placemark("8,47,1e300"), r"^a\.kml:2: placemark: a height of more than 100 km"),
        (placemark("8 47"), r"^a\.kml:2: placemark: position 1 has fewer than two coordinates"),
        (placemark("8,x"), r"^a\.kml:2: placemark: coordinates: could not convert string to float: 'x'"),
        (
            placemark("47,120"),
            r"position 1 \(latitude 120, longitude 47\) .* are the axes swapped\? KML has the long",
        ),
        (placemark("500000,5200000"), r"is not on the Earth; give degrees in WGS 84, not metres"),
    ],
)
def test_what_is_no_kml_is_refused_with_its_line(data, message):
    with pytest.raises(UnreadableError, match=message):
        read(data, "a.kml")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_mark_of_the_encoding_is_understood(encoding):
    data = placemark("8,47", name="Grünland").decode()
    assert read(data.encode(encoding), "a.kml").features[0].name == "Grünland"


def test_a_shape_of_too_few_different_positions_is_left_out():
    drawing = read(placemark("8,47 8,47", "LineString"), "a.kml")
    assert not drawing.features
    assert drawing.left_out[0].reason == "fewer than 2 different positions"


def test_longitudes_beyond_the_antimeridian_come_back_around():
    (feature,) = read(placemark("179,0 181,1 180,2", "LinearRing"), "a.kml").features
    assert feature.rings[0].tolist() == [[0, 179], [1, -179], [2, 180]]


def test_controls_in_names_become_spaces():
    assert read(placemark("8,47", name="a\u202e\x9b31mb"), "a.kml").features[0].name == "a  31mb"


def archive(**files: bytes) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as written:
        for name, data in files.items():
            written.writestr(name, data)
    return buffer.getvalue()


def test_all_kml_in_a_kmz_is_read_where_it_lies():
    data = archive(**{"../../more.kml": placemark("9,47"), "doc.kml": placemark("8,47"), "images/1.png": b""})
    drawing = read(data, "a.kmz")
    assert [str(each.place) for each in drawing.features] == ["a.kmz/doc.kml:2", "a.kmz/more.kml:2"]
    assert [each.what for each in drawing.left_out] == ["other files in the archive: 1"]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"PK\3\4 and no more", "not readable as an archive"),
        (archive(picture=b""), r"an archive without a \.kml file"),
        (archive(**{"doc.kml": b" " * (LARGEST_FILE + 1)}), "more than 128 MB of KML in the archive"),
        (
            archive(**{f"{n}.kml": b"" for n in range(MOST_ENTRIES + 1)}),
            "more than 10000 files in the archive",
        ),
        (
            archive(**{"doc.kml": FARM}).replace(b"PK\1\2\x14\3\x14\0\0\0", b"PK\1\2\x14\3\x14\0\1\0"),
            "is encrypted",
        ),
    ],
)
def test_what_is_no_kmz_is_refused(data, message):
    with pytest.raises(UnreadableError, match=rf"^a\.kmz: .*{message}"):
        read(data, "a.kmz")


def test_positions_are_arrays():
    line = " ".join(f"{8 + n * 1e-6:.6f},47" for n in range(10**5))
    (feature,) = read(placemark(line, "LineString"), "a.kml").features
    assert feature.rings[0].shape == (10**5, 2)
    assert feature.rings[0].dtype == np.float64
