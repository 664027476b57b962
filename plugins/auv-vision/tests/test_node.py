"""What the eyes of a simulated vehicle tell, from picture to place."""

from dataclasses import replace

import pytest
from sample_vessels import pool_sheet

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings, Thing
from auv_vision.cameras import Pose, cameras_of
from auv_vision.detecting import detect, sought_in
from auv_vision.node import Eyes
from auv_vision.renderer import Renderer

POOL = Surroundings(
    bottom=4.0,
    things=(
        Thing(GATE, "gate", 6.0, 0.0, 1.0, 0.0, "orange", 2.0),
        Thing(BUOY, "red buoy", 5.0, 1.6, 1.8, 0.0, "red", 0.3),
        Thing(BUOY, "yellow buoy", 4.0, -1.0, 1.6, 0.0, "yellow", 0.3),
        Thing(BUOY, "green buoy", 7.0, 0.3, 2.0, 0.0, "green", 0.3),
        Thing(PATH, "path", 0.2, 0.1, 4.0, 30.0, "orange", 1.2),
    ),
)
HERE = Pose(0.0, 0.0, 1.5, 2.0, -3.0, 5.0)


def test_all_things_of_a_pool_are_seen_where_they_are() -> None:
    found = {each.name: each for each in Eyes(pool_sheet(), POOL, seed=1).look(12.5, HERE)}
    assert set(found) == {thing.name for thing in POOL.things}
    for thing in POOL.things:
        seen = found[thing.name]
        assert (seen.north, seen.east, seen.depth) == pytest.approx(
            (thing.north, thing.east, thing.depth), abs=0.3
        )
        assert seen.confidence > 0.5
        assert seen.time == 12.5
        assert seen.camera == ("bottom" if thing.kind == PATH else "front")


def test_places_follow_from_where_the_vehicle_believes_to_be() -> None:
    eyes = Eyes(pool_sheet(), POOL, seed=1)
    believed = Pose(HERE.north + 2.0, HERE.east - 1.0, HERE.depth, 2.0, -3.0, 5.0)
    (gate,) = (each for each in eyes.look(0.0, HERE, believed) if each.name == "gate")
    assert (gate.north, gate.east, gate.depth) == pytest.approx((8.0, -1.0, 1.0), abs=0.3)


def test_the_same_seed_sees_the_same() -> None:
    one, other = (Eyes(pool_sheet(), POOL, seed=3) for _ in range(2))
    assert [one.look(0.5 * n, HERE) for n in range(3)] == [other.look(0.5 * n, HERE) for n in range(3)]


def test_an_empty_pool_shows_nothing() -> None:
    eyes = Eyes(pool_sheet(), Surroundings(bottom=4.0), seed=5, sought=Eyes(pool_sheet(), POOL).sought)
    for number in range(24):
        pose = Pose(0.0, 0.0, 0.3 + 0.14 * number, 4.0, -6.0, 15.0 * number)
        assert eyes.look(0.5 * number, pose) == []


def test_haze_that_is_known_is_undone_and_haze_that_is_not_hides_things() -> None:
    hazy = replace(POOL, haze=2.0)
    known = {each.name for each in Eyes(pool_sheet(), hazy, seed=1).look(0.0, HERE)}
    assert known >= {"gate", "red buoy", "yellow buoy", "path"}
    drawn, told = Renderer(hazy, seed=1), sought_in(POOL)
    front, bottom = cameras_of(pool_sheet())
    unknown = [each for camera in (front, bottom) for each in detect(*drawn.pair(camera, HERE), camera, told)]
    assert len(unknown) < len(known) - 1
