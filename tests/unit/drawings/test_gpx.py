import pytest

from mmrs_core.drawings.drawing import Geometry, HeightReference, Role
from mmrs_core.drawings.gpx import read
from mmrs_core.errors import UnreadableError

WALK = b"""<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1"><metadata><name>walk</name></metadata>
<wpt lat="47" lon="8"><ele>400</ele><time>2020-01-01T00:00:00Z</time><name>gate</name><sym>Flag</sym></wpt>
<rte><name>round</name><rtept lat="47" lon="8"/><rtept lat="47" lon="8.1"/></rte>
<trk><name>flown</name><trkseg>
<trkpt lat="47" lon="8"><ele>1</ele><time>2020-01-01T00:00:00Z</time></trkpt>
<trkpt lat="47" lon="9"><ele>2</ele><time>2020-01-01T00:00:01Z</time></trkpt></trkseg>
<trkseg><trkpt lat="48" lon="8"><ele>3</ele></trkpt><trkpt lat="48" lon="9"/></trkseg></trk>
<trk><name>lost</name></trk><waypoint/></gpx>"""


def test_waypoints_routes_and_segments_of_tracks_become_features():
    drawing = read(WALK, "a.gpx")
    gate, route, first, second = drawing.features
    assert drawing.title == "walk"
    assert (gate.geometry, gate.name, gate.properties) == (Geometry.POINT, "gate", {"sym": "Flag"})
    assert (gate.reference, gate.heights[0].tolist()) == (HeightReference.SEA_LEVEL, [400])
    assert [each.role for each in drawing.features] == [Role.UNKNOWN, Role.UNKNOWN, Role.TRACK, Role.TRACK]
    assert route.rings[0].tolist() == [[47, 8], [47, 8.1]]
    assert first.times.tolist() == [1577836800, 1577836801]
    assert (second.times, second.heights, second.place.line) == (None, (), 4)


def test_what_is_none_is_left_out():
    left_out = {(each.place.line, each.what): each.reason for each in read(WALK, "a.gpx").left_out}
    assert left_out == {
        (7, "heights of trk 'flown'"): "some positions have none",
        (8, "trk 'lost'"): "no positions",
        (8, "waypoint"): "not read in GPX",
    }


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"<kml/>", r"^a\.gpx:1: 'kml' is not the root of a GPX file"),
        (
            b'<gpx>\n<wpt lat="95" lon="8"/></gpx>',
            r"^a\.gpx:2: wpt\[1\]: .* are the axes swapped\? GPX names them",
        ),
        (b'<gpx>\n<wpt lat="47"/></gpx>', r"^a\.gpx:2: wpt\[1\]: coordinates"),
        (b"<trkpt/>", r"^a\.gpx:1: 'trkpt' is not the root of a GPX file"),
        (
            b"<gpx><trk><trkseg>\n<trkpt><trkpt/></trkpt></trkseg></trk></gpx>",
            r"^a\.gpx:2: 'trkpt' in another",
        ),
        (b'<gpx>\n<wpt lat="nan" lon="8"/></gpx>', r"^a\.gpx:2: wpt\[1\]: .* is not a finite number"),
    ],
)
def test_what_is_no_gpx_is_refused_with_its_line(data, message):
    with pytest.raises(UnreadableError, match=message):
        read(data, "a.gpx")


def test_a_track_of_a_hundred_thousand_positions_is_an_array():
    points = "".join(f'<trkpt lat="47" lon="{n * 1e-5:.5f}"><ele>1</ele></trkpt>' for n in range(10**5))
    (track,) = read(f"<gpx><trk><trkseg>{points}</trkseg></trk></gpx>".encode(), "a.gpx").features
    assert track.rings[0].shape == (10**5, 2)


def test_of_a_point_of_a_track_its_own_height_counts():
    extra = "<extensions><x:ele xmlns:x='y'>7</x:ele><z><ele>8</ele></z></extensions>"
    points = "".join(f'<trkpt lon="8" lat="4{n}"><ele>{n}</ele>{extra}</trkpt>' for n in range(3))
    data = f"<gpx><trk><trkseg>\n{points}\n</trkseg></trk></gpx>".encode()
    (track,) = read(data, "a.gpx").features
    assert track.heights[0].tolist() == [0, 1, 2]
    assert track.rings[0].tolist() == [[40, 8], [41, 8], [42, 8]]
