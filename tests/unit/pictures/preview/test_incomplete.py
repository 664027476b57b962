"""What cannot be read is never drawn as free ground: it is marked as incomplete, or listed as not drawn."""

from dataclasses import replace
from functools import cache
from html import unescape
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from svg_reading import with_class

from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.pictures.preview.features import pieces_of, zones_of
from mmrs_core.pictures.preview.from_models import MOST, picture_of_models, with_problems
from mmrs_core.pictures.preview.map import USES, map_of
from mmrs_core.pictures.preview.page import page
from mmrs_core.pipeline import check_models, read_models
from mmrs_core.resources import shipped
from mmrs_core.scene import Area, AreaUse

EXAMPLES = shipped("examples")
AREAS = {"forbiddenAreas": "forbidden area", "obstacles": "obstacle", "emergencyAreas": "emergency area"}
PLACES = (("task", "tasks"), ("robot", "team/robots"), ("context element", "elements"))
DAMAGED = ("carbon-dioxide", "solar-park", "lost-float")
ROBOT = "robots/quad-650.xmi"
VERTEX = 'latitude="42.369802" longitude="13.349126"'
SQUARE = ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0))


def pictured(folder, contributions, texts):
    """Return the picture of a mission with other texts in some of its files; None where it is refused."""
    unsaved = {(folder / name).resolve(): text for name, text in texts.items()}
    models, faults = read_models(folder, contributions, unsaved=unsaved)
    if models is None:
        return None
    problems = (*faults, *check_models(models, contributions))
    return picture_of_models(models, contributions.map_symbols, problems)


@pytest.fixture(scope="module")
def wholes(contributions):
    """Return the pictures of examples as they are, by name."""
    return {name: pictured(EXAMPLES / name, contributions, {}) for name in DAMAGED}


@pytest.fixture
def field(contributions):
    """Return a function: the picture of an example with words of its files replaced: (file, old, new)."""

    def drawn(*changes):
        folder, texts = EXAMPLES / "carbon-dioxide", {}
        for file, old, new in changes:
            text = texts.get(file) or (folder / file).read_text("utf-8")
            assert old in text
            texts[file] = text.replace(old, new, 1)
        return pictured(folder, contributions, {file: text.encode() for file, text in texts.items()})

    return drawn


def written(markup):
    """Return the text of a document without escapes."""
    return unescape(str(markup))


def gap(picture, what):
    (found,) = (each for each in picture.gaps if each.what == what)
    return found


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (('latitude="42', 'latitude="x42'), "1 of 4 coordinates has no position; latitude: 'x42.369802'"),
        (("latitude=", "latitud="), "1 of 4 coordinates has no position; latitud: no feature"),
        (('"mission:Geo', '"missing:Geo'), "1 of 4 coordinates has no position; missing:GeoCoordinate"),
        (("<shell", "<shel"), "shel: no feature of Area 'school'"),
    ],
)
def test_an_area_without_one_of_its_vertices_is_drawn_as_incomplete(field, damage, reason):
    vertex = f'<shell xsi:type="mission:GeoCoordinate" {VERTEX}/>'
    picture = field(("context.xmi", vertex, vertex.replace(*damage)))
    school = next(zone for zone in picture.zones if zone.name == "school")
    assert len(school.shell) == 3
    assert school.gap in reason
    assert school.kept == ()
    assert gap(picture, "forbidden area 'school'").reason.startswith(reason)
    assert gap(picture, "forbidden area 'school'").source == "context.xmi:8"
    drawing = written(map_of(picture, standalone=True))
    (outline,) = with_class(map_of(picture), "incomplete")
    assert outline.get("class") == "zone forbidden incomplete"
    assert outline.get("d").endswith("Z") is not reason.startswith("1 of 4")
    assert f"school, incomplete: {school.gap}" in drawing
    assert "incomplete: forbidden area 'school' (context.xmi:8)" in drawing


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (
            ("context.xmi", '<obstacles name="barn"', '<obstacles xsi:type="x:Y" name="barn"'),
            "obstacle 'barn'",
        ),
        (("context.xmi", "<context:Context", '<x:Context xmlns:x="urn:x"'), "context"),
        (("mission.xmi", 'home xsi:type="mission:Geo', 'home xsi:type="mission:Neo'), "robot 'Alba'"),
        (("mission.xmi", "survey:PhotoGridTask", "survey:PhotoTask"), "task 'west meadow'"),
        (("mission.xmi", "<tasks ", '<task name="x"/><tasks '), "mission.xmi"),
        (("mission.xmi", 'name="Carbon', 'crs="x" name="Carbon'), "forbidden area 'school'"),
    ],
)
def test_what_is_not_drawn_at_all_is_listed_with_its_source(field, change, what):
    end = ("context.xmi", "</context:Context>", "</x:Context>")
    picture = field(change, *([end] if what == "context" else []))
    listed = gap(picture, what)
    assert not listed.drawn
    assert listed.reason
    document = written(page(picture))
    assert f"not drawn: {what}" in document
    assert listed.source in document
    assert "not drawn, not planned" in document


@pytest.mark.parametrize(
    ("change", "unknown"),
    [
        (("mission.xmi", 'name="Cirro" type="Quad 650"', 'name="Cirro" type="Quad"'), ("Cirro",)),
        (("mission.xmi", 'positionError="0.5"', 'positionError="x"'), ("Alba", "Brezza", "Cirro")),
        (("mission.xmi", "positionError=", "positionEror="), ("Alba", "Brezza", "Cirro")),
        ((ROBOT, " width=", " widht="), ("Alba", "Brezza", "Cirro")),
    ],
)
def test_a_clearance_that_is_not_known_counts_as_unknown_and_not_as_none(field, change, unknown):
    picture = field(change)
    some = len(unknown) < len(picture.robots)
    assert {zone.unknown for zone in picture.zones} == {unknown}
    assert all(bool(zone.kept) is some for zone in picture.zones)
    drawn = "only that of other robots is drawn" if some else "none is drawn"
    assert gap(picture, f"clearance of {', '.join(unknown)}").reason == f"unknown; {drawn}"
    assert (f"which is not known of {unknown[0]}" in map_of(picture)) is some


def test_areas_are_not_grown_where_no_clearance_is_known():
    area = Area("pond", AreaUse.FORBIDDEN, SQUARE, safety_distance=3.0)
    assert [zone.kept for zone in zones_of([area], {"Alba": None})] == [()]
    (zone,) = zones_of([area], {"Alba": None, "Bora": 2.0})
    assert zone.kept
    assert (zone.clearance, zone.unknown) == (5.0, ("Alba",))


@given(st.lists(st.booleans(), min_size=1, max_size=8), st.booleans())
def test_the_pieces_of_an_outline_hold_every_known_vertex_once_and_join_only_neighbours(known, closed):
    points = [(float(i), 0.0) for i in range(len(known))]
    ring = tuple(
        (*point, 0.0) if there else (float("nan"),) * 3 for point, there in zip(points, known, strict=True)
    )
    pieces = pieces_of(ring, closed=closed)
    assert sorted(point for piece in pieces for point in piece) == [
        p for p, there in zip(points, known, strict=True) if there
    ]
    steps = {(b[0] - a[0]) % len(known) for piece in pieces for a, b in pairwise(piece)}
    assert steps <= {1 % len(known)}


def test_errors_are_shown_before_warnings_and_a_cut_list_says_how_many_more(picture, contributions):
    models, _ = read_models(EXAMPLES / "carbon-dioxide", contributions)
    warnings = [Diagnostic("MML998", Severity.WARNING, f"warning {index}") for index in range(MOST)]
    error = Diagnostic("MML999", Severity.ERROR, "an error")
    shown = with_problems(picture, models, [*warnings, error])
    assert shown.problems[0].message == "an error [MML999]"
    assert not shown.planned
    assert (len(shown.problems), shown.more_problems) == (MOST, 1)
    assert "and 1 more" in page(shown)
    assert "more" not in page(with_problems(picture, models, [error])).partition("</ol>")[2][:40]


def test_a_list_of_gaps_that_is_cut_says_how_many_more(field):
    picture = field(("mission.xmi", 'name="Carbon', 'crs="x" name="Carbon'))
    many = replace(picture, gaps=picture.gaps * 100)
    more = len(many.gaps) - 200
    assert f"and {more} more" in page(many)
    assert f"and {len(many.gaps) - 12} more" in map_of(many, standalone=True)


@cache
def sites():
    """Return (example, file, number of an element, attribute) for every attribute of some examples."""
    return [
        (name, str(file.relative_to(EXAMPLES / name)), number, attribute)
        for name in DAMAGED
        for file in sorted((EXAMPLES / name).rglob("*.xmi"))
        for number, element in enumerate(etree.parse(file).iter(etree.Element))
        for attribute in element.attrib
    ]


def damaged(text, number, attribute, damage):
    """Return a file with one attribute damaged."""
    root = etree.fromstring(text)
    element = [*root.iter(etree.Element)][number]
    value = element.attrib.pop(attribute)
    if damage == "rename":
        element.set(f"{attribute}x", value)
    else:
        element.set(attribute, {"garble": f"x{value}", "empty": "", "number": "1e999"}[damage])
    return etree.tostring(root)


def names_at(root, path):
    """Return the names of the elements at a path, as pictures name them."""
    return [each.get("name") or f"{each.tag}[{index}]" for index, each in enumerate(root.findall(path))]


def shapes(drawn, kind):
    """Return what a picture draws of the outermost areas, tasks, robots or elements, by name, in order."""
    if kind in AREAS.values():
        zones = [zone for zone in drawn.zones if USES[zone.use] == kind]
        return {each.name: (each.shell, each.low, each.high, each.gap) for each in zones}
    if kind == "task":
        return {each.name: (each.rings, each.lines, each.point, each.gap) for each in drawn.tasks}
    if kind == "robot":
        return {each.name: (each.home, each.gap) for each in drawn.robots}
    outer = [each for each in drawn.elements if not each.inner]
    return {each.name: (each.outlines, each.lines, each.marks, each.gap) for each in outer}


@given(st.data())
def test_whatever_attribute_is_damaged_nothing_vanishes_unmarked(contributions, wholes, data):
    example, file, number, attribute = data.draw(st.sampled_from(sites()))
    damage = data.draw(st.sampled_from(("garble", "rename", "empty", "number")))
    folder = EXAMPLES / example
    text = damaged((folder / file).read_bytes(), number, attribute, damage)
    whole, picture = wholes[example], pictured(folder, contributions, {file: text})
    if picture is None:
        return
    listed = {each.what for each in picture.gaps}
    texts = {name: (folder / name).read_bytes() for name in ("mission.xmi", "context.xmi")} | {file: text}
    roots = {name: etree.fromstring(text) for name, text in texts.items()}
    for kind, path in (*((kind, path) for path, kind in AREAS.items()), *PLACES):
        names = names_at(roots["mission.xmi" if path in ("tasks", "team/robots") else "context.xmi"], path)
        before, after = shapes(whole, kind), shapes(picture, kind)
        for name, shape in zip(names, before.values(), strict=True):
            assert f"{kind} {name!r}" in listed or after.get(name) == shape or "context" in listed
    for before, zone in zip(whole.zones, picture.zones, strict=False):
        if zone.name == before.name and not zone.gap:
            assert zone.kept == before.kept or zone.unknown
