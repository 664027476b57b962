"""The map is well-formed, complete, and safe whatever the names are."""

from dataclasses import replace

from shapely.geometry import Point, Polygon
from svg_reading import SVG, parsed, tip, with_class

from mmrs_core.pictures.preview.labels import Label, Labels, around, width_of
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.picture import Leg, Picture, Zone
from mmrs_core.pictures.preview.projection import projection_of
from mmrs_core.scene import AreaUse

A_NAME = Label("a name", around((200.0, 200.0), 5.0), "name")
HOSTILE = "</title><script>alert('x')</script>]]>&\"\x07\u202e"


def test_every_leg_of_every_robot_is_drawn(picture):
    drawn = with_class(map_of(picture), "leg")
    seen_from_above = [
        leg for robot in picture.robots for leg in robot.legs if leg.kind in ("transit", "work")
    ]
    assert len(drawn) == len(seen_from_above) == 6


def test_robots_differ_in_colour_and_in_dashes(picture):
    robots = with_class(map_of(picture), "robot")
    assert len({robot.get("stroke") for robot in robots}) == len(robots) == 2
    dashes = {tuple(leg.get("stroke-dasharray") for leg in with_class(robot, "leg")) for robot in robots}
    assert len(dashes) == 2


def test_areas_are_drawn_as_drawn_and_with_their_clearance(picture):
    root = parsed(map_of(picture))
    assert len(with_class(root, "zone")) == 3
    assert len(with_class(root, "kept")) == 3


def test_obstacles_tell_their_heights(picture):
    words = " ".join(parsed(map_of(picture)).itertext())
    assert "tower (0.0 m to 35.0 m)" in words


def test_covered_ground_is_one_shape_for_each_robot_that_covers(picture):
    covered = with_class(map_of(picture), "covered")
    assert [shape.get("data-robot") for shape in covered] == ["0"]
    assert covered[0].get("d").count("M") == 2


def _extent(picture):
    shown = projection_of(picture)
    return shown.east - shown.west, shown.north - shown.south


def test_a_leg_says_who_what_and_when(picture):
    tips = [title.text for title in parsed(map_of(picture)).iter(f"{SVG}title")]
    assert "Alba: work for field, 0:11 to 0:31, up 20.0 m, 2 actions" in tips


def test_hostile_names_stay_words(picture_named):
    picture = picture_named(Alba=HOSTILE, field=HOSTILE, tower=HOSTILE, mission=HOSTILE)
    root = parsed(map_of(picture, standalone=True))
    assert not list(root.iter(f"{SVG}script"))
    words = "".join(root.itertext())
    assert "<script>alert('x')</script>" in words
    assert "\x07" not in words


def test_the_legend_names_every_robot(picture):
    root = parsed(map_of(picture, standalone=True))
    words = "".join(with_class(root, "legend")[0].itertext())
    assert "Alba" in words
    assert "Brezza" in words
    assert "forbidden area" in words


def test_a_map_without_anything_is_still_a_map():
    root = parsed(map_of(Picture("", "local coordinates", ())))
    assert float(root.get("width")) > 0


def test_far_away_areas_do_not_shrink_the_map(picture):
    far = Zone("country", AreaUse.FORBIDDEN, ((-9e5, -9e5), (9e5, -9e5), (9e5, 9e5), (-9e5, 9e5)))
    before, after = _extent(picture), _extent(replace(picture, zones=(*picture.zones, far)))
    assert max(after) < 3 * max(before)


def test_words_do_not_cover_each_other():
    labels = Labels(400.0)
    for _ in range(4):
        labels.put(A_NAME)
    at = [label.at for label in labels.placed]
    assert len(at) == 4
    wide = width_of("a name")
    pairs = [(a, b) for i, a in enumerate(at) for b in at[i + 1 :]]
    assert all(abs(a[0] - b[0]) >= wide or abs(a[1] - b[1]) >= 12 for a, b in pairs)


def test_an_obstacle_that_robots_pass_over_is_drawn_lightly(picture):
    root = parsed(map_of(picture))
    assert [tip(zone)[:5] for zone in with_class(root, "passed")] == []
    over = Leg("transit", ((50.0, 25.0, 50.0), (80.0, 25.0, 50.0)), 0.0, 3.0)
    robots = (replace(picture.robots[0], legs=(over,)),)
    light = with_class(map_of(replace(picture, robots=robots)), "passed")
    assert [tip(zone)[:5] for zone in light] == ["tower"]


def test_nothing_in_the_map_comes_from_elsewhere(picture):
    markup = map_of(picture)
    without_namespace = markup.replace('xmlns="http://www.w3.org/2000/svg"', "")
    assert "http" not in without_namespace
    assert "@import" not in without_namespace


def test_a_task_is_drawn_as_its_symbol_says(picture):
    root = parsed(map_of(picture))
    (area,) = with_class(root, "area")
    assert (area.get("stroke"), tip(area)) == ("#c2571a", "field: photo grid, 0:11 to 0:31")
    assert [icon.text for icon in with_class(root, "icon") if icon.get("fill") == "#c2571a"] == ["G\u00a0"]


def test_every_map_is_equally_wide_and_no_higher_than_a_page(picture):
    for stretch in ((1.0, 1.0), (1.0, 50.0), (50.0, 1.0)):
        robots = tuple(
            replace(
                robot,
                legs=tuple(
                    replace(leg, points=tuple((e * stretch[0], n * stretch[1], u) for e, n, u in leg.points))
                    for leg in robot.legs
                ),
            )
            for robot in picture.robots
        )
        shown = projection_of(replace(picture, robots=robots))
        assert abs(shown.width - 1000.0) < 1e-6
        assert 400.0 < shown.height <= 800.001


def test_words_are_placed_off_a_line_where_there_is_room():
    labels = Labels(400.0, 400.0)
    labels.avoid([(0.0, 186.0), (400.0, 186.0)])
    labels.put(A_NAME)
    _, y = labels.placed[0].at
    assert not y - 12 < 186.0 < y + 3


def box_around(labels):
    """Return what the only words cover, and the line that joins them to what they name, if any."""
    (label,) = labels.placed
    (x, y), half = label.at, width_of("a name") / 2
    return Polygon.from_bounds(x - half, y - 12, x + half, y + 3), label.leader


def test_words_do_not_stand_on_something_else_than_they_name():
    labels, beside = Labels(400.0, 400.0), [(150.0, 150.0), (250.0, 150.0), (250.0, 193.0), (150.0, 193.0)]
    labels.lay_out(beside)
    labels.put(A_NAME)
    covered, _ = box_around(labels)
    assert not covered.intersects(Polygon(beside))


def test_words_may_stand_on_the_area_in_which_lies_what_they_name():
    labels, field = Labels(400.0, 400.0), [(100.0, 100.0), (300.0, 100.0), (300.0, 300.0), (100.0, 300.0)]
    labels.lay_out(field)
    labels.put(A_NAME)
    covered, leader = box_around(labels)
    assert Polygon(field).covers(covered)
    assert leader is None


def test_words_far_from_what_they_name_are_joined_to_it_by_a_line():
    labels = Labels(400.0, 400.0)
    labels.keep_off((120.0, 170.0, 280.0, 230.0))
    labels.put(A_NAME)
    covered, leader = box_around(labels)
    start, end = map(Point, leader)
    assert covered.distance(start) < 0.1
    assert Point(200.0, 200.0).distance(end) < 10.0


def test_words_are_placed_on_what_is_large_enough_for_them():
    labels = Labels(1000.0, 1000.0)
    labels.put(Label("a name", (300.0, 300.0, 600.0, 500.0), "name"))
    assert labels.placed[0].at == (450.0, 404.0)


def test_tasks_at_one_point_stand_side_by_side(picture):
    point = {"rings": (), "lines": (), "point": (30.0, 30.0)}
    tasks = tuple(replace(picture.tasks[0], name=name, **point) for name in ("first", "second"))
    badges = with_class(map_of(replace(picture, tasks=tasks)), "badge")
    assert [tip(badge).split(":")[0] for badge in badges] == ["first", "second"]
    assert badges[0].get("transform") != badges[1].get("transform")
