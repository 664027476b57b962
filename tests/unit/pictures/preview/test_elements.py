"""Context elements of any plug-in are found by the shape of their attributes."""

from dataclasses import replace

import pytest
from lxml import etree
from svg_reading import with_class

from mmrs_core.contributions.symbols import CORE_SYMBOLS, MapSymbol
from mmrs_core.pictures.palette import SYMBOL
from mmrs_core.pictures.preview.features import elements_of
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.page import page
from mmrs_core.pictures.preview.projection import projection_of
from mmrs_core.scene import Part

SOLAR, RING = "urn:test:solar:1.0", ("urn:mmrs:mission:1.0", "Ring")
GROUP, PANEL = (SOLAR, "PanelGroup"), (SOLAR, "Panel")
OF_GROUP = MapSymbol(GROUP, "panel group", "#123456", "P", ("rows", "tracking", "tilts", "place"))
OF_PANEL = MapSymbol(PANEL, "panel", "#654321", "p")
SHELL = ((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (30.0, 20.0, 0.0))
FLAT = tuple(point[:2] for point in SHELL)
POND = Part((RING,), {"points": SHELL})


def part(kind, **attributes):
    return Part((kind, ("urn:mmrs:context:1.0", "ContextElement")), attributes)


def of(*parts, symbols=()):
    return elements_of(parts, {symbol.metaclass: symbol for symbol in (OF_GROUP, *symbols)})


@pytest.mark.parametrize(
    ("attributes", "outlines", "lines", "marks"),
    [
        ({"position": (3.0, 4.0, 5.0)}, (), (), ((3.0, 4.0),)),
        ({"shell": SHELL}, (FLAT,), (), ()),
        ({"points": SHELL}, (), (FLAT,), ()),
        ({"anchors": SHELL}, (), (), FLAT),
        ({"basin": POND, "ponds": (POND,)}, (FLAT, FLAT), (), ()),
    ],
)
def test_attributes_are_drawn_by_their_shape(attributes, outlines, lines, marks):
    (each,) = of(part(GROUP, name="a", **attributes))
    assert (each.name, each.outlines, each.lines, each.marks) == ("a", outlines, lines, marks)


def test_what_it_contains_looks_as_its_own_metaclass_says():
    panels = tuple(part(PANEL, position=point) for point in SHELL)
    group, *inner = of(part(GROUP, shell=SHELL, panels=panels), symbols=[OF_PANEL])
    assert not group.inner
    assert [(each.symbol, each.inner) for each in inner] == [(OF_PANEL, True)] * 3


def test_what_it_contains_looks_like_itself_where_nobody_says_otherwise():
    _, inner = of(part(GROUP, shell=SHELL, panels=(part(PANEL, position=SHELL[1]),)))
    assert (inner.symbol, inner.marks) == (OF_GROUP, (FLAT[1],))


def test_an_element_that_only_refers_leads_from_one_to_the_next():
    pylons = (part(PANEL, name="a", position=SHELL[0]), part(PANEL, name="b", position=SHELL[1]))
    wires = part(GROUP, name="wires", pylons=("b", "a"))
    sign = part(GROUP, name="sign", on="wires")
    *_, line, mark = of(*pylons, wires, sign)
    assert (line.lines, line.marks) == ((((30.0, 0.0), (0.0, 0.0)),), ())
    assert (mark.lines, mark.marks) == ((), ((15.0, 0.0),))


def test_elements_that_refer_to_each_other_are_nowhere():
    one, other = of(part(GROUP, name="one", to="other"), part(GROUP, name="other", to="one"))
    assert not any((*one.lines, *one.marks, *other.lines, *other.marks))


def test_a_symbol_without_a_colour_has_that_of_the_palette():
    (mooring,) = of(part((SOLAR, "Mooring"), position=SHELL[0]))
    assert (mooring.symbol.label, mooring.symbol.colour) == ("mooring", SYMBOL)


def test_contained_values_without_a_place_are_no_elements():
    assert len(of(part(GROUP, shell=SHELL, properties=(Part(((SOLAR, "Pair"),), {"key": "a"}),)))) == 1


def test_an_element_without_a_place_is_still_told_of():
    (each,) = of(part(GROUP, name="spare"))
    assert (each.name, each.points) == ("spare", ())


def test_an_element_without_a_name_is_called_by_its_place_in_the_list():
    assert [each.name for each in of(part(GROUP), part(GROUP, name=""))] == ["elements[0]", "elements[1]"]


def test_the_fields_of_its_symbol_are_told():
    (each,) = of(part(GROUP, rows=12, tracking=True, tilts=(10.0, 12.5), place=(1.0, 2.0, 3.0), owner="me"))
    assert each.details == (("rows", "12"), ("tracking", "yes"), ("tilts", "10, 12.5"))


@pytest.fixture
def with_elements(picture):
    """Return a function: the picture with these elements."""
    return lambda *parts: replace(picture, elements=of(*parts))


def test_an_element_is_drawn_in_its_colour_with_its_icon(with_elements):
    picture = with_elements(part(GROUP, name="west", shell=SHELL), part(GROUP, name="mast", at=SHELL[1]))
    (outline,) = with_class(map_of(picture), "element")
    assert (outline.get("stroke"), outline.get("fill")) == ("#123456", "#123456")
    assert [icon.text for icon in with_class(map_of(picture), "icon") if icon.get("fill") == "#123456"] == [
        "P",
        "P\u00a0",
    ]


def test_an_element_tells_what_it_is(with_elements):
    words = map_of(with_elements(part(GROUP, name="west", shell=SHELL, rows=12)))
    assert "<title>west: panel group, rows 12</title>" in words


def test_the_key_and_the_legend_name_its_kind(with_elements):
    picture = with_elements(part(GROUP, name="west", shell=SHELL))
    assert "panel group</li>" in page(picture)
    assert "panel group" in "".join(with_class(map_of(picture, standalone=True), "legend")[0].itertext())


def test_the_page_lists_elements_and_those_without_a_position(with_elements):
    words = page(with_elements(part(GROUP, name="west", shell=SHELL, rows=12), part(GROUP, name="spare")))
    assert "<td><bdi>west</bdi></td><td><bdi>panel group</bdi></td><td><bdi>rows: 12</bdi></td>" in words
    assert (
        "<td><bdi>spare</bdi></td><td><bdi>panel group</bdi></td><td><bdi>without a position</bdi>" in words
    )


def test_hostile_words_of_a_plugin_stay_words(picture):
    bait = '</title><script>alert(1)</script>"'
    hostile = MapSymbol(GROUP, bait, "#123456", "<b", ("note",))
    elements = elements_of([part(GROUP, name=bait, shell=SHELL, note=bait)], {GROUP: hostile})
    markup = map_of(replace(picture, elements=elements), standalone=True)
    assert "<script>" not in markup
    assert etree.fromstring(markup.encode()) is not None
    assert page(replace(picture, elements=elements)).count("<script>") == page(picture).count("<script>")


def test_an_element_nearby_widens_the_map_and_one_far_away_does_not(picture):
    def extent(*positions):
        elements = of(*(part(GROUP, position=position) for position in positions))
        shown = projection_of(replace(picture, elements=elements))
        return shown.west, shown.east

    assert extent((200.0, 20.0, 0.0))[1] > extent()[1]
    assert extent((9e5, 20.0, 0.0)) == extent()


def test_an_outline_that_figures_make_is_drawn_beside_the_coordinates():
    def square(part):
        half = part.attributes["radius"]
        return (((-half, -half), (half, -half), (half, half), (-half, half)),)

    symbol = MapSymbol(GROUP, "panel group", "#123456", "", outlines=square)
    (each,) = elements_of([part(GROUP, position=(0.0, 0.0, 0.0), radius=2.0)], {GROUP: symbol})
    assert each.outlines == (((-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)),)
    assert each.marks == ((0.0, 0.0),)


def test_a_corridor_is_drawn_as_its_line_and_what_lies_between_its_sides():
    points = ((0.0, 0.0, 0.0), (40.0, 0.0, 0.0))
    gate = Part(
        (("urn:mmrs:context:1.0", "Corridor"),),
        {"name": "gate", "points": points, "width": 6.0, "use": "ENTRY"},
    )
    (each,) = elements_of([gate], {symbol.metaclass: symbol for symbol in CORE_SYMBOLS})
    ((outline,), lines) = each.outlines, each.lines
    assert lines == (((0.0, 0.0), (40.0, 0.0)),)
    assert {*outline} == {(0.0, 3.0), (40.0, 3.0), (40.0, -3.0), (0.0, -3.0)}
    assert each.tip == "gate: corridor, width 6, use ENTRY"
