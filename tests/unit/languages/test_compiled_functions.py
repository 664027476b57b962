"""The odd one out after many of a kind, for which reader and writer have compiled a function by then."""

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages import behaviour
from mmrs_core.languages.element import Element, held, metaclass_of, path_of
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.writing import to_xmi
from mmrs_core.languages.xmi import quick_reader
from mmrs_core.languages.xmi.events import DEEPEST_NESTING
from mmrs_core.languages.xmi.quick_writer import QuickWriter, writer_for
from mmrs_core.languages.xmi.writer import XmiWriter

MANY = 40
LION = '  <animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3"/>\n'

ODD_LIONS = [
    '<animals xsi:type="zoo:Lion" name="leo" weight="1_0.5" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight=" 1.5" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="\u0661.\u0665" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5d" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="nan" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="NaN" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3.0"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.99" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3" xmi:id="x"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3" bogus="3"/>',
    '<animals name="leo" weight="1.5" mate="//@animals.1" teeth="3" xsi:type="zoo:Lion"/>',
    '<animals name="leo" weight="1.5" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lyon" name="leo" weight="1.5" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3">text</animals>',
    '<animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3"><cub/></animals>',
    '<animals xmlns:zoo="urn:far" xsi:type="zoo:Lion" name="a" weight="1.5" mate="//@animals.1" teeth="3"/>',
    '<zoo:animals xsi:type="zoo:Lion" name="leo" weight="1.5" mate="//@animals.1" teeth="3"/>',
    '<animals xsi:type="zoo:Keeper" name="leo" weight="1.5" mate="//@animals.1" teeth="3"/>',
]


def read(text, registry, monkeypatch, compiled):
    with monkeypatch.context() as patch:
        if not compiled:
            patch.setattr(quick_reader, "_OFTEN", 10**9)
        return read_text(text, "a.xmi", registry)


def described(model):
    return model.diagnostics, [
        (type(element).__name__, element._mmrs_line, path_of(element), values_of(element))
        for element in model.elements()
    ]


def values_of(element):
    if type(element)._mmrs_metaclass is None:
        return element._mmrs_xml
    features = metaclass_of(element).features
    return [[shown(value) for value in held(element, feature)] for feature in features]


def shown(value):
    return path_of(value) if isinstance(value, Element) else repr(value)


def carefully(roots, registry):
    return XmiWriter(tuple(roots), registry, None).document({}).encode()


@pytest.mark.parametrize("odd", ODD_LIONS)
def test_an_odd_element_after_many_alike_is_read_as_if_it_were_alone(odd, zoo, zoo_text, monkeypatch):
    text = zoo_text(LION * MANY + odd + "\n" + LION)
    assert described(read(text, zoo, monkeypatch, True)) == described(read(text, zoo, monkeypatch, False))


def test_a_fault_after_many_elements_alike_names_its_own_line(zoo, zoo_text):
    lion = '\n<animals xsi:type="zoo:Lion" name="leo" weight="1.5"/>'
    text = zoo_text(lion * MANY + lion.replace("1.5", "heavy"))
    (fault,) = read_text(text, "a.xmi", zoo).diagnostics
    assert (fault.code, fault.place.line) == ("XMI005", text[: text.index(b"heavy")].count(b"\n") + 1)


def test_a_second_element_where_one_may_be_is_a_fault_even_in_the_hundredth_owner(core):
    one = '<moves xsi:type="behaviour:HeadTo" name="m"><heading angle="1.0"/></moves>'
    two = one.replace("<heading", '<heading angle="2.0"/><heading')
    text = (
        '<behaviour:Robot xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        f'xmlns:behaviour="urn:mmrs:behaviour:1.0">{one * MANY}{two}</behaviour:Robot>'
    )
    model = read_text(text.encode(), "a.xmi", core)
    assert [fault.code for fault in model.diagnostics] == ["XMI009"]
    assert model.roots[0].moves[-1].heading.angle == 2.0


def test_elements_alike_that_nest_too_deeply_are_refused(zoo, zoo_text):
    depth = DEEPEST_NESTING + 1
    cubs = '<cubs xsi:type="zoo:Lion" name="c">' * depth + "</cubs>" * depth
    text = zoo_text(f'<animals xsi:type="zoo:Lion" name="a">{cubs}</animals>')
    with pytest.raises(UnreadableError, match=f"nested deeper than {DEEPEST_NESTING} levels"):
        read_text(text, "a.xmi", zoo)


ODD_MOVES = {
    "minus nothing": lambda move: setattr(move, "distance", -0.0),
    "the default": lambda move: setattr(move, "distance", 0.0),
    "a small number": lambda move: setattr(move, "distance", 1e-4),
    "a large number": lambda move: setattr(move, "distance", 1e7),
    "a negative number": lambda move: setattr(move, "speed", -0.001),
    "no number": lambda move: setattr(move, "speed", float("nan")),
    "a whole number": lambda move: setattr(move, "distance", 3),
    "nothing, said": lambda move: setattr(move, "speed", 0.0),
    "a text to be escaped": lambda move: setattr(move, "name", 'a "b" <c> & d\n'),
    "an empty text": lambda move: setattr(move, "name", ""),
    "no text": lambda move: setattr(move, "name", None),
    "no target": lambda move: setattr(move, "target", None),
    "a target of no type": lambda move: setattr(move, "target", []),
    "a target that is a text": lambda move: setattr(move, "target", "x"),
    "something inside": lambda move: setattr(move, "heading", behaviour.Heading(angle=1.0)),
}


def flight(core, odd):
    """A robot of many moves, of which the last but one is odd."""
    places = [behaviour.GeoCoordinate(latitude=1.0 + number, longitude=2.0) for number in range(MANY)]
    moves = [behaviour.GoTo(name="m", target=place, distance=5.0, speed=0.5) for place in places]
    odd(moves[-2])
    return behaviour.Behaviour(robots=[behaviour.Robot(id="r", moves=moves)], targets=places)


@pytest.mark.parametrize("odd", ODD_MOVES.values(), ids=ODD_MOVES)
def test_an_odd_element_after_many_alike_is_written_as_if_it_were_alone(odd, core):
    root = flight(core, odd)
    assert to_xmi([root], core) == carefully([root], core)


@pytest.mark.parametrize("value", ["x", True, []], ids=repr)
def test_a_value_of_a_wrong_type_after_many_elements_alike_is_refused_by_its_path(value, core):
    root = flight(core, lambda move: setattr(move, "distance", value))
    with pytest.raises(ValueError, match=rf"/moves\[{MANY - 2}\]: distance: .* is not of the type EDouble"):
        to_xmi([root], core)


def test_a_character_that_xml_cannot_hold_is_refused_after_many_elements_alike(core):
    root = flight(core, lambda move: setattr(move, "name", "a\x01"))
    with pytest.raises(ValueError, match=rf"/moves\[{MANY - 2}\]: name: holds U\+0001"):
        to_xmi([root], core)


def test_an_element_that_refers_to_itself_is_written_as_a_link(zoo):
    otters = [zoo.create("urn:test:zoo", "Otter", name=f"o{number}") for number in range(MANY)]
    otters[-1].mate = otters[-1]
    root = zoo.create("urn:test:zoo", "Zoo", animals=otters)
    assert to_xmi([root], zoo) == carefully([root], zoo)
    assert b"href=" in to_xmi([root], zoo)


def test_elements_of_other_files_among_many_alike_are_written_as_links(zoo, zoo_text, tmp_path):
    for name in ("one", "two"):
        (tmp_path / f"{name}.xmi").write_bytes(zoo_text(LION * MANY))
    one, two = (read_model(tmp_path / f"{name}.xmi", zoo).roots[0] for name in ("one", "two"))
    one.favourites = [*one.animals[:2], two.animals[-1]]
    two.animals[0].cubs.append(one.animals[-1])
    text = to_xmi([one], zoo, file=tmp_path / "one.xmi")
    assert text.count(b"two.xmi#//@animals.39") == 1
    assert text == XmiWriter((one,), zoo, tmp_path / "one.xmi").document({}).encode()


def test_a_model_deeper_than_functions_may_call_each_other_is_written(zoo):
    root = zoo.create("urn:test:zoo", "Lion", name="root")
    lion = root
    for _ in range(3_000):
        lion.cubs = [zoo.create("urn:test:zoo", "Lion", name="cub")]
        lion = lion.cubs[0]
    assert to_xmi([root], zoo) == carefully([root], zoo)


def test_a_model_whose_file_gave_identifiers_keeps_them(zoo, zoo_text):
    lions = "".join(f'<animals xsi:type="zoo:Lion" xmi:id="i{n}" name="l" mate="i{n}"/>' for n in range(MANY))
    model = read_text(zoo_text(lions), "a.xmi", zoo)
    assert not isinstance(writer_for(model.roots, zoo, None), QuickWriter)
    assert to_xmi(model.roots, zoo).count(b"xmi:id=") == MANY
