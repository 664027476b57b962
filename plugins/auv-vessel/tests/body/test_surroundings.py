import json

import pytest

from auv_vessel.body.surroundings import BUOY, GATE, Obstacle, Surroundings, Thing, from_json, to_json


def test_surroundings_go_into_a_file_and_come_back():
    pool = Surroundings(
        current=(0.1, -0.2),
        bottom=4.0,
        density=998.0,
        noise=False,
        haze=1.5,
        obstacles=(Obstacle(1.0, 2.0, 0.5), Obstacle(3.0, 4.0, 0.2, top=1.0, bottom=3.0)),
        things=(
            Thing(GATE, "gate", 5.0, 0.0, 1.0, size=3.0),
            Thing(BUOY, "red buoy", 8.0, 1.0, 2.0, colour="red"),
        ),
    )

    assert from_json(to_json(pool)) == pool


def test_what_a_file_does_not_say_is_as_it_is_anyway():
    assert from_json("{}") == Surroundings()


@pytest.mark.parametrize(
    "text", ["[]", "3", "{", '{"depth": 3}', '{"things": [{"kind": "gate"}]}', '{"current": [1]}']
)
def test_another_text_is_refused(text):
    with pytest.raises(ValueError):
        from_json(text)


def things(**values: object) -> str:
    one = {"kind": "buoy", "name": "it", "north": 1, "east": 1, "depth": 2} | values
    return json.dumps({"things": [one]})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"haze": 0}', "the water: haze is 0"),
        ('{"haze": 99}', "the water: haze is 99"),
        ('{"bottom": NaN}', "the water: bottom is nan"),
        ('{"noise": 1}', "the water: noise is 1"),
        ('{"current": ["a", 0]}', "the water: current is 'a'"),
        ('{"density": "salt"}', "the water: density is 'salt'"),
        (things(depth="2"), "thing 'it': depth is '2'"),
        (things(size=0), "thing 'it': size is 0"),
        (things(north=1e999), "thing 'it': north is inf"),
        (things(name=3), "thing 3: name is 3"),
        ('{"obstacles": [{"north": 1, "east": 1, "radius": -1}]}', "obstacle 0: radius is -1"),
    ],
)
def test_values_that_no_water_has_are_refused_with_their_place(text, said):
    with pytest.raises(ValueError, match=said):
        from_json(text)
