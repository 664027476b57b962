"""Positions as people paste them, and what is none."""

import pytest

from mmrs_core.errors import UsageError
from mmrs_core.projects.positions import position_of

FLORENCE = [
    "43.77, 11.25",
    "(43.77 11.25)",
    "43,77; 11,25",
    "43.77N 11.25E",
    "N43.77E11.25",
    "11.25E, 43.77N",
    "43°46'12\"N 11°15'E",
    "43° 46.2′ N, 11° 15′ E",
    "geo:43.77,11.25;u=35",
    "https://www.google.com/maps/place/Duomo/@43.7,11.2,17z/data=!3m1!4b1!4m5!3d43.77!4d11.25",
    "https://maps.google.com/?q=43.77,11.25",
    "https://www.openstreetmap.org/?mlat=43.77&mlon=11.25#map=15/43.7/11.2",
    "https://www.openstreetmap.org/#map=15/43.77/11.25",
]


@pytest.mark.parametrize("text", FLORENCE)
def test_a_position_is_understood_as_maps_write_it(text):
    assert position_of(text) == (43.77, 11.25)


def test_south_and_west_are_negative():
    assert position_of("33.5S 70.25W") == position_of("-33.5, -70.25") == (-33.5, -70.25)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("111.25, 43.77", "latitude comes first"),
        ("91, 181", "latitudes go to 90"),
        ("43.77N 11.25N", "states the latitude twice"),
        ("43°61'N 11°E", "below 60"),
        ("43.77,11,25", "is not a position"),
        ("43'46", "is not a position"),
        ("1e9, 3", "is not a position"),
        ("nan, inf", "is not a position"),
        ("", "is not a position"),
        ("https://example.org/", "no position in this link"),
        ("9" * 3000, "too long"),
    ],
)
def test_what_is_no_position_is_refused_with_the_reason(text, reason):
    with pytest.raises(UsageError, match=reason):
        position_of(text, "--at")
