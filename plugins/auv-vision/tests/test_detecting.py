"""What is detected in pictures whose truth is known: how much of it, how exactly, how surely."""

from dataclasses import replace
from statistics import median

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_vessels import pool_sheet
from vision_trials import NOISES, Scene, Told, distance_of, is_visible, trials

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings, Thing
from auv_vision.cameras import LEFT, Camera, Pose, cameras_of
from auv_vision.detecting import Sought, confidence_of, detect, detections_of, disparities, name_of, sought_in
from auv_vision.node import Eyes
from auv_vision.renderer import Conditions, Renderer
from auv_vision.water import POOL, TOLD_APART, bgr, colour_of, hazier

FRONT_CAMERA, BOTTOM_CAMERA = cameras_of(pool_sheet())
BUOYS = tuple(Sought(BUOY, f"{colour} buoy", colour, 0.3) for colour in TOLD_APART)
ALL = (*BUOYS, Sought(GATE, "gate", "orange", 2.0), Sought(PATH, "path", "orange", 1.2))


@pytest.fixture(scope="module", params=[150, pytest.param(1500, marks=pytest.mark.thorough)])
def looked(request: pytest.FixtureRequest) -> list[tuple[Scene, list[Told]]]:
    cv2.setNumThreads(1)
    return list(trials(request.param, seed=11))


@pytest.mark.parametrize(("kind", "least"), [(GATE, 0.9), (BUOY, 0.93), (PATH, 0.97)])
def test_nearly_everything_that_is_wholly_in_sight_is_found(
    kind: str, least: float, looked: list[tuple[Scene, list[Told]]]
) -> None:
    hits = [
        any(each.name == scene.thing.name and each.right for each in told)
        for scene, told in looked
        if scene.thing.kind == kind and is_visible(scene)
    ]
    assert len(hits) > 5
    assert sum(hits) / len(hits) >= least


@pytest.mark.parametrize("noise", NOISES)
def test_noise_hides_little(noise: float, looked: list[tuple[Scene, list[Told]]]) -> None:
    hits = [
        any(each.name == scene.thing.name and each.right for each in told)
        for scene, told in looked
        if scene.noise == noise and is_visible(scene)
    ]
    assert sum(hits) / len(hits) >= 0.85


@pytest.mark.parametrize(("near", "far", "metres"), [(0.0, 4.0, 0.06), (4.0, 7.0, 0.15), (7.0, 11.0, 0.35)])
def test_places_are_the_more_exact_the_nearer_things_are(
    near: float, far: float, metres: float, looked: list[tuple[Scene, list[Told]]]
) -> None:
    errors = [each.error for _, told in looked for each in told if near <= each.distance < far]
    assert len(errors) > 20
    assert median(errors) < metres


def test_confidence_is_how_often_a_detection_is_right(looked: list[tuple[Scene, list[Told]]]) -> None:
    told = [each for _, found in looked for each in found]
    for low, high in ((0.5, 0.9), (0.9, 0.98), (0.98, 1.0)):
        part = [each for each in told if low <= each.confidence < high]
        if len(part) >= 30:
            right = sum(each.right for each in part) / len(part)
            assert right == pytest.approx(sum(each.confidence for each in part) / len(part), abs=0.12)
    sure = [each for each in told if each.confidence >= 0.9]
    assert sum(each.right for each in sure) / len(sure) > 0.95


@pytest.mark.parametrize("noise", [0.0, *NOISES])
def test_an_empty_pool_shows_nothing_at_any_noise(noise: float) -> None:
    renderer = Renderer(Surroundings(bottom=4.5), int(noise), Conditions(noise=noise))
    for number in range(12):
        pose = Pose(0.0, 0.0, 0.3 + 0.3 * number, 5.0 - number, 6.0 - number, 30.0 * number)
        for camera in (FRONT_CAMERA, BOTTOM_CAMERA):
            assert detect(*renderer.pair(camera, pose, float(number)), camera, ALL) == []


@pytest.mark.parametrize("colour", [*TOLD_APART, "blue", "white", "black", "grey"])
def test_colours_are_not_taken_for_each_other(colour: str) -> None:
    others = [each for each in ALL if each.colour != colour]
    for number, metres in enumerate((1.5, 3.0, 5.0, 7.0, 9.0)):
        thing = Thing(BUOY, "buoy", metres, 0.2, 1.6, 0.0, colour, 0.3)
        renderer = Renderer(Surroundings(bottom=4.5, things=(thing,)), number)
        pair = renderer.pair(FRONT_CAMERA, Pose(0.0, 0.0, 1.5), float(number))
        assert detect(*pair, FRONT_CAMERA, others) == []


@pytest.mark.parametrize("size", [0.12, 1.0])
def test_a_thing_of_another_size_is_another_thing(size: float) -> None:
    thing = Thing(BUOY, "buoy", 4.0, 0.0, 1.5, 0.0, "yellow", size)
    pair = Renderer(Surroundings(bottom=4.5, things=(thing,))).pair(FRONT_CAMERA, Pose(0.0, 0.0, 1.5))
    assert detect(*pair, FRONT_CAMERA, BUOYS) == []


def test_a_thing_that_the_edge_of_the_picture_cuts_is_left_out() -> None:
    thing = Thing(BUOY, "buoy", 2.0, 1.22, 1.5, 0.0, "yellow", 0.3)
    around = Surroundings(bottom=4.5, things=(thing,))
    pair = Renderer(around).pair(FRONT_CAMERA, Pose(0.0, 0.0, 1.5))
    assert detect(*pair, FRONT_CAMERA, sought_in(around)) == []


@pytest.mark.parametrize("metres", [1.1, 1.25, 1.5])
def test_a_thing_that_the_edge_touches_in_the_other_eye_only_is_ranged_rightly(metres: float) -> None:
    ahead = metres - FRONT_CAMERA.position[0]
    columns = -0.45 * ahead
    thing = Thing(BUOY, "buoy", metres, columns, 1.5, 0.0, "green", 0.3)
    around = Surroundings(bottom=4.5, things=(thing,))
    pose = Pose(0.0, 0.0, 1.5)
    (found,) = detect(*Renderer(around, 2).pair(FRONT_CAMERA, pose, 1.0), FRONT_CAMERA, sought_in(around))
    assert FRONT_CAMERA.world(found.point, pose) == pytest.approx((metres, columns, 1.5), abs=0.06)
    assert found.confidence > 0.9


@pytest.mark.parametrize("light", [0.35, 0.7, 1.3])
@pytest.mark.parametrize("haze", [0.5, 1.0, 1.5])
def test_dim_light_and_haze_are_borne(light: float, haze: float) -> None:
    water = hazier(POOL, haze)
    things = (
        Thing(BUOY, "red", 3.5, 0.8, 1.5, 0.0, "red", 0.3),
        Thing(BUOY, "yellow", 4.0, -0.8, 1.6, 0.0, "yellow", 0.3),
    )
    around = Surroundings(bottom=4.5, things=things)
    renderer = Renderer(around, 3, Conditions(noise=3.0, light=light), water)
    pair = renderer.pair(FRONT_CAMERA, Pose(0.0, 0.0, 1.5))
    found = detect(*pair, FRONT_CAMERA, sought_in(around), water)
    assert {each.colour for each in found} == {"red", "yellow"}


@pytest.mark.parametrize("camera", [FRONT_CAMERA, BOTTOM_CAMERA])
def test_pictures_of_anything_break_nothing_and_nothing_is_seen_in_them(camera: Camera) -> None:
    random = np.random.default_rng(5)
    shape = (camera.height, camera.width, 3)
    flat = [
        np.full(shape, value, np.uint8) for value in ((0, 0, 0), (255, 255, 255), (0, 0, 255), (30, 200, 90))
    ]
    noisy = [random.integers(0, 256, shape, dtype=np.uint8) for _ in range(6)]
    rough = [
        np.asarray(cv2.resize(each[:30, :40], (camera.width, camera.height)), np.uint8) for each in noisy
    ]
    for picture in (*flat, *noisy, *rough):
        for other in (picture, picture[:, ::-1].copy(), np.roll(picture, -9, axis=1)):
            assert detect(picture, other, camera, ALL) == []


def test_pictures_of_another_size_are_refused() -> None:
    picture = np.zeros((100, 100, 3), np.uint8)
    with pytest.raises(ValueError, match="not of 320x240"):
        detect(picture, picture, FRONT_CAMERA, ALL)


def test_a_camera_of_another_resolution_sees_the_same_places() -> None:
    thing = Thing(BUOY, "buoy", 4.0, 0.4, 1.7, 0.0, "yellow", 0.3)
    around = Surroundings(bottom=4.5, things=(thing,))
    camera, pose = FRONT_CAMERA.scaled(640, 480), Pose(0.0, 0.0, 1.5, 2.0, 3.0, 4.0)
    (found,) = detect(*Renderer(around).pair(camera, pose), camera, sought_in(around))
    assert camera.world(found.point, pose) == pytest.approx((4.0, 0.4, 1.7), abs=0.05)


angles = st.floats(-30.0, 30.0)


@given(
    st.sampled_from([FRONT_CAMERA, BOTTOM_CAMERA]),
    st.builds(
        Pose, st.floats(-50, 50), st.floats(-50, 50), st.floats(0, 50), angles, angles, st.floats(0, 360)
    ),
    st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(0.5, 10)),
)
def test_a_pixel_and_its_disparity_lead_back_to_the_place(
    camera: Camera, pose: Pose, point: tuple[float, float, float]
) -> None:
    place = np.array((camera.world(point, pose),))
    left, right = (camera.pixels(camera.seen(place, pose, side))[0] for side in (LEFT, -LEFT))
    assert left[1] == pytest.approx(right[1], abs=1e-6)
    back = camera.point(left[0], left[1], left[0] - right[0])
    assert back == pytest.approx(point, abs=1e-6)


def test_what_is_ahead_to_starboard_and_above_is_seen_right_and_up() -> None:
    seen = FRONT_CAMERA.seen(
        np.array(((0.0, 5.0, 1.0), (-1.0, 5.0, 1.0))), Pose(0.0, 0.0, 2.0, 0.0, 0.0, 90.0), 0.0
    )
    columns, rows = FRONT_CAMERA.pixels(seen).T
    assert columns[0] == pytest.approx(FRONT_CAMERA.middle[0])
    assert (rows < FRONT_CAMERA.middle[1]).all()
    north = FRONT_CAMERA.pixels(
        FRONT_CAMERA.seen(np.array(((1.0, 5.0, 1.0),)), Pose(0.0, 0.0, 2.0, 0.0, 0.0, 90.0), 0.0)
    )
    assert north[0][0] < columns[0] < columns[1]


@pytest.mark.parametrize("shift", [4.0, 7.25, 12.5, 20.75])
def test_disparity_is_finer_than_a_pixel(shift: float) -> None:
    random = np.random.default_rng(1)
    coarse = random.random((24, 32, 2), dtype=np.float32)
    left = np.asarray(cv2.resize(coarse, (320, 240), interpolation=cv2.INTER_CUBIC), np.float32)
    moved = np.array(((1.0, 0.0, -shift), (0.0, 1.0, 0.0)))
    right = np.asarray(cv2.warpAffine(left, moved, (320, 240), flags=cv2.INTER_LINEAR), np.float32)
    found = disparities(left, right, FRONT_CAMERA, (150, 100, 190, 140))
    assert found[0][0] == pytest.approx(shift, abs=0.1)


@pytest.mark.parametrize("name", TOLD_APART)
def test_colours_come_back_out_of_the_haze(name: str) -> None:
    for metres in (0.5, 2.0, 5.0, 9.0):
        seen = POOL.seen(bgr(name), np.array(metres))
        told = colour_of(seen, np.array(POOL.veil), metres, POOL)
        assert told is not None
        assert told[0] == name
        assert told[1] > 0.9


@pytest.mark.parametrize("kind", [GATE, BUOY, PATH])
def test_confidence_never_falls_with_the_score(kind: str) -> None:
    told = [confidence_of(kind, score) for score in np.linspace(0.0, 1.0, 101)]
    assert told == sorted(told)
    assert told[0] >= 0.0
    assert told[-1] < 1.0


def test_things_that_look_the_same_are_told_apart_by_where_they_are_expected() -> None:
    one = Sought(BUOY, "near", "red", 0.3, (3.0, 0.0, 1.5))
    other = Sought(BUOY, "far", "red", 0.3, (9.0, 0.0, 1.5))
    assert name_of((one, other), (4.0, 0.0, 1.5)) == "near"
    assert name_of((one, replace(other, place=None)), (4.0, 0.0, 1.5)) is None
    assert name_of((replace(one, place=None),), (4.0, 0.0, 1.5)) == "near"


def test_each_name_is_told_once_with_the_surest_place() -> None:
    things = tuple(Thing(BUOY, "buoy", 4.0, side, 1.6, 0.0, "yellow", 0.3) for side in (-0.8, 0.8))
    around, pose = Surroundings(bottom=4.5, things=things), Pose(0.0, 0.0, 1.5)
    sightings = detect(*Renderer(around).pair(FRONT_CAMERA, pose), FRONT_CAMERA, BUOYS)
    assert len(sightings) == 2
    (told,) = detections_of(sightings, FRONT_CAMERA, pose, 1.0)
    assert told.confidence == max(each.confidence for each in sightings)


def test_an_object_that_is_not_where_it_is_expected_is_seen_where_it_is() -> None:
    thing = Thing(BUOY, "buoy", 4.0, 0.8, 1.6, 0.0, "yellow", 0.3)
    expected = Sought(BUOY, "buoy", "yellow", 0.3, (6.0, -1.0, 1.6))
    eyes = Eyes(pool_sheet(), Surroundings(bottom=4.5, things=(thing,)), sought=(expected,))
    (told,) = eyes.look(0.0, Pose(0.0, 0.0, 1.5))
    assert (told.north, told.east, told.depth) == pytest.approx((4.0, 0.8, 1.6), abs=0.1)


def test_distances_of_trials_are_those_of_the_scene() -> None:
    assert distance_of(Thing(BUOY, "b", 3.0, 4.0, 1.0), Pose(0.0, 0.0, 1.0)) == 5.0
