import pytest

from mmrs_core.drawings.drawing import HeightReference
from mmrs_core.drawings.point_table import read, recognise
from mmrs_core.errors import UnreadableError


@pytest.mark.parametrize(
    "text",
    [
        "name,latitude,longitude,altitude,crop\nNorth,47.5,8.25,400,wheat\n",
        "\ufeffName;Lat;Lon;Alt [m];crop\r\nNorth;47,5;8,25;400,0;wheat\r\n\r\n",
        "lon\tlat\tname\tz\tcrop\n8.25\t47.5\tNorth\t400\twheat",
    ],
)
def test_columns_are_known_by_their_names(text):
    (point,) = read(text.encode(), "a.csv").features
    assert point.rings[0].tolist() == [[47.5, 8.25]]
    assert (point.name, point.reference, point.properties) == (
        "North",
        HeightReference.SEA_LEVEL,
        {"crop": "wheat"},
    )
    assert point.place.line == 2
    assert recognise(text.encode(), "a.txt")


def test_rows_of_one_area_or_line_are_one_shape():
    text = "area,line,lat,lon\nf,,47,8\nf,,47,9\n,w,47,8\nf,,48,9\n,w,48,8\n,,50,8\n"
    point, area, line = read(text.encode(), "a.csv").features
    assert (area.geometry.value, area.name, area.rings[0].tolist()) == (
        "area",
        "f",
        [[47, 8], [47, 9], [48, 9]],
    )
    assert (line.geometry.value, line.name, line.place.line) == ("line", "w", 4)
    assert point.rings[0].tolist() == [[50, 8]]


def test_what_rows_of_one_shape_all_state_are_its_properties():
    drawing = read(b"area,lat,lon,type,note\nf,47,8,Terrain,a\nf,47,9,Terrain,b\nf,48,9,,\n", "a.csv")
    assert drawing.features[0].properties == {"type": "Terrain"}
    assert [(each.what, each.reason) for each in drawing.left_out] == [
        ("column 'note' of area 'f'", "its rows differ")
    ]


@pytest.mark.parametrize(
    "row",
    [
        "42°21'3\"N;13°30'36\"E",
        "N 42° 21′ 3″;13° 30.6′ E",
        "42 21.05 N;13 30 36 E",
        "42:21:03;013:30:36",
        "42,350833333;13,51",
        "42°21,05'N;13.51E",
    ],
)
def test_degrees_may_have_minutes_and_seconds(row):
    (point,) = read(f"lat;lon\n{row}\n".encode(), "a.csv").features
    assert point.rings[0][0] == pytest.approx([42.350833333, 13.51], abs=1e-8)


@pytest.mark.parametrize(
    ("cells", "reason"),
    [
        ("47,x", "longitude 'x': neither degrees nor degrees, minutes and seconds"),
        ("47,", "longitude '': neither degrees nor"),
        ("47,8,5,9", "4 cells, but 3 columns"),
        ("47,nan", "a coordinate of position 1 is not a finite number"),
        ("100,8", "are the axes swapped?"),
        ("47 N,8 N", "expected one of the letters E and W"),
        ("-47 N,8", "it states two things that exclude each other"),
        ("47 61,8", "minutes and seconds are below 60"),
        ("47.5 30,8", "it states two things that exclude each other"),
        ("47,8,high", "height 'high': not a number of metres"),
    ],
)
def test_a_row_without_a_position_is_left_out_with_its_line_and_reason(cells, reason):
    drawing = read(f"lat,lon,height\n1,2,3\n{cells}\n".encode(), "a.csv")
    (left,) = drawing.left_out
    assert len(drawing.features) == 1
    assert (left.place.line, reason in left.reason) == (3, True)


def test_an_area_with_a_bad_row_is_left_out_as_a_whole():
    drawing = read(b"area,lat,lon\nf,47,8\nf,47,x\nf,48,9\nf,48,8\n", "a.csv")
    (left,) = drawing.left_out
    assert (drawing.features, left.what, left.lost.name) == ((), "area 'f'", "f")
    assert left.reason.startswith("row 3: longitude 'x'")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\n1,2", r"^a\.csv:1: columns named latitude and longitude are expected"),
        ('lat,lon\n47,"8', r"^a\.csv:2: not CSV"),
        ("lat,lon,Lat\n47,8,9", r"^a\.csv:1: column 'Lat' is there twice"),
        ("name;WKT\nx;POINT (8 47)", r"^a\.csv:1: shapes as text \(WKT\) are not read; export"),
        ('"a\nlat",lon\n47,8', r"^a\.csv:1: columns named"),
    ],
)
def test_what_is_no_table_of_points_is_refused_with_its_line(text, message):
    with pytest.raises(UnreadableError, match=message):
        read(text.encode(), "a.csv")
