from __future__ import annotations

import pytest
from mmrs_auv.vessel.body.surroundings import (
    BUOY,
    GATE,
    Obstacle,
    Surroundings,
    Thing,
    from_json,
    to_json,
)


def test_surroundings_go_into_a_file_and_come_back():
    pool = Surroundings(
        current=(0.1, -0.2),
        bottom=4.0,
        density=998.0,
        noise=False,
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
