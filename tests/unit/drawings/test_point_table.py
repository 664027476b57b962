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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\n1,2", r"^a\.csv:1: columns named latitude and longitude are expected"),
        ("lat,lon\n47,x", r"^a\.csv:2: lon 'x' is not a number"),
        ("lat,lon\n47,", r"^a\.csv:2: lon '' is not a number"),
        ("lat,lon\n47,8,9", r"^a\.csv:2: 3 cells, but 2 columns"),
        ("lat,lon\n47,nan", r"^a\.csv:2: row: a coordinate of position 1 is not a finite number"),
        ('lat,lon\n47,"8', r"^a\.csv:2: not CSV"),
        ("lat,lon\n100,8", r"^a\.csv:2: .* are the axes swapped\?"),
    ],
)
def test_what_is_no_table_of_points_is_refused_with_its_line(text, message):
    with pytest.raises(UnreadableError, match=message):
        read(text.encode(), "a.csv")
