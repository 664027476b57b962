"""Python subclasses of metaclasses: whoever makes an element, it is an instance of them."""

import re
from dataclasses import dataclass, replace

import pytest

from mmrs_core.analysis.constraints.unread import ReadNote, watching
from mmrs_core.errors import PluginError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import robot as rl
from mmrs_core.languages.classes import ElementClass
from mmrs_core.languages.comparison.changes import changes_between
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.ecore_api.bridge import from_pyecore, to_pyecore
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import Registry, core_registry, registry_with
from mmrs_core.languages.writing import to_json, to_xmi

OFTEN = 40
"""Of so many elements the last ones are read and written by compiled functions."""


class Leg(bl.GoTo):
    @property
    def twice(self):
        return 2.0 * self.distance

    @property
    def misspelt(self):
        return self.distnce


class Timed(bl.Move):
    __slots__ = ()

    def title(self):
        return f"{self.name}, timed"


@pytest.fixture(scope="module")
def registry():
    return registry_with((), classes=[ElementClass(Leg, "kites"), ElementClass(Timed)])


@pytest.fixture
def behaviour():
    """A behaviour of plain elements."""
    targets = [bl.RelativeCoordinate(x=float(at), y=0.0, z=0.0) for at in range(OFTEN)]
    moves = [bl.GoTo(name=f"leg {at}", distance=1.5, target=target) for at, target in enumerate(targets)]
    robot = bl.Robot(id="r", typeName="t", slots=[bl.Slot(name="s")], moves=[bl.Start(name="begin"), *moves])
    return bl.Behaviour(name="b", crs="EPSG:4326", robots=[robot], targets=targets)


def assert_all_are_subclasses(behaviour):
    start, *moves = behaviour.robots[0].moves
    assert {(type(move), move.twice, isinstance(move, Leg)) for move in moves} == {
        (type(moves[0]), 3.0, True)
    }
    assert not isinstance(start, Leg)
    assert start.title() == "begin, timed"
    assert moves[-1].title() == f"leg {OFTEN - 1}, timed"
    assert all(isinstance(move, bl.Move) and isinstance(move, Timed) for move in (start, *moves))


@pytest.mark.parametrize(("write", "file"), [(to_xmi, "b.xmi"), (to_json, "b.json")])
def test_readers_make_them_and_writers_write_their_metaclass(registry, behaviour, write, file):
    text = write([behaviour], core_registry())
    model = read_text(text, file, registry)
    assert model.diagnostics == ()
    assert_all_are_subclasses(model.roots[0])
    assert check_conformance(model, registry) == ()
    assert write(model.roots, registry) == text
    assert changes_between(model.roots, read_text(text, file, registry).roots) == ()


def test_they_come_back_from_pyecore(registry, behaviour):
    model = read_text(to_xmi([behaviour], registry), "b.xmi", core_registry())
    (back,) = from_pyecore(to_pyecore(model, registry), registry).roots
    assert_all_are_subclasses(back)


def test_factories_make_them(registry):
    made = registry.create("urn:mmrs:behaviour:1.0", "GoTo", name="m", distance=2.0)
    assert (made.twice, made.title(), isinstance(made, bl.GoTo)) == (4.0, "m, timed", True)
    assert metaclass_of(made) is metaclass_of(bl.GoTo)
    assert isinstance(registry.extended(()).create("urn:mmrs:behaviour:1.0", "Stop"), Timed)


def test_classes_of_languages_make_them_while_a_registry_is_in_use(registry):
    with registry.in_use():
        assert isinstance(bl.GoTo(), Leg)
        with core_registry().in_use():
            assert not isinstance(bl.GoTo(), Leg)
        assert not isinstance(core_registry().create("urn:mmrs:behaviour:1.0", "GoTo"), Leg)
    assert not isinstance(bl.GoTo(), Leg)


def test_other_registries_make_plain_elements(registry, behaviour):
    assert isinstance(registry.create("urn:mmrs:behaviour:1.0", "GoTo"), Leg)
    for other in (core_registry(), registry_with(())):
        assert not isinstance(other.create("urn:mmrs:behaviour:1.0", "GoTo"), Timed)
        (root,) = read_text(to_xmi([behaviour], registry), "b.xmi", other).roots
        assert not any(isinstance(move, Timed) for move in root.robots[0].moves)


def test_a_subclass_that_nobody_registered_makes_its_own_instances(behaviour):
    made = Leg(name="m", distance=2.0)
    assert (made.twice, isinstance(made, Leg), repr(made)) == (4.0, True, "<Leg 'm' at />")
    assert isinstance(type(made)(), Leg)
    behaviour.robots[0].moves = [made]
    assert b'<moves xsi:type="behaviour:GoTo" name="m" distance="2.0"/>' in to_xmi(
        [behaviour], core_registry()
    )


def test_a_subclass_of_an_abstract_class_makes_nothing_by_itself():
    with pytest.raises(ValueError, match="Timed: abstract, no element can be made of it"):
        Timed()


def test_attributes_of_a_subclass_are_its_own_and_no_features():
    made = Leg()
    made.note = "windy"
    assert made.note == "windy"
    with pytest.raises(ValueError, match=r"distanc: no feature of Leg; did you mean distance\?"):
        Leg(distanc=1.0)
    with pytest.raises(AttributeError, match=r"distnce: no feature of GoTo; did you mean distance\?"):
        _ = made.misspelt
    with pytest.raises(AttributeError, match="weight: no feature of GoTo"):
        _ = made.weight


def test_what_could_not_be_read_of_them_is_known(registry):
    made = registry.create("urn:mmrs:behaviour:1.0", "GoTo", distance=2.0)
    with watching([(made, "distance")]), ReadNote() as reading:
        assert made.twice == 4.0
    assert reading.is_unfounded
    assert isinstance(made, Leg)


def test_the_most_specific_of_several_counts():
    class Any(bl.Move):
        def words(self):
            return "any"

    class Going(Any, bl.GoTo):
        def words(self):
            return f"going as {super().words()}"

    registry = registry_with((), classes=[ElementClass(Any), ElementClass(Going)])
    assert registry.create("urn:mmrs:behaviour:1.0", "GoTo").words() == "going as any"
    assert registry.create("urn:mmrs:behaviour:1.0", "Stop").words() == "any"


def test_two_for_one_metaclass_are_an_error_that_names_both():
    class Other(bl.GoTo):
        pass

    with pytest.raises(
        PluginError, match=r"1\.0#//GoTo: two Python classes for it, Leg of a and \S+Other of b"
    ):
        registry_with((), classes=[ElementClass(Leg, "a"), ElementClass(Other, "b")])


def test_one_that_hides_a_feature_of_a_class_below_is_an_error():
    class Aimed(bl.Move):
        target = None

    with pytest.raises(PluginError, match=re.escape("kites: Aimed.target: hides the feature GoTo.target")):
        registry_with((), classes=[ElementClass(Aimed, "kites")])


def test_one_for_a_class_that_its_language_has_no_more_is_an_error(zoo):
    keeper = type("Guide", (zoo.metaclass("urn:test:zoo", "Keeper").interface,), {})
    newer = [replace(each, metaclasses=()) for each in zoo.packages if each.ns_uri == "urn:test:zoo"]
    with pytest.raises(PluginError, match="Guide of kites: urn:test:zoo has no class Keeper any more"):
        Registry(newer, classes=[ElementClass(keeper, "kites")])


def unfit():
    class Hiding(bl.GoTo):
        @property
        def distance(self):
            return 0.0

    class Beginning(bl.GoTo):
        def __init__(self):
            self.note = ""

    class Slotted(bl.GoTo):
        __slots__ = ("note",)

    class Both(bl.GoTo, rl.Device):
        pass

    return {
        "Hiding.distance: hides the feature GoTo.distance": Hiding,
        "Beginning.__init__: a Python subclass cannot replace it": Beginning,
        "Slotted.__slots__: not empty": Slotted,
        "Both: subclass of both GoTo and Device": Both,
        "Data.__init__: a Python subclass cannot replace it": dataclass(type("Data", (bl.GoTo,), {})),
    }


@pytest.mark.parametrize("message", unfit())
def test_what_no_element_can_be_is_refused_when_it_is_called_or_registered(message):
    kind = unfit()[message]
    for make in (kind, lambda: ElementClass(kind)):
        with pytest.raises(ValueError, match=re.escape(message)):
            make()


@pytest.mark.parametrize("kind", [bl.GoTo, type(bl.GoTo()), int, "GoTo"])
def test_what_is_no_subclass_is_refused(kind):
    with pytest.raises(ValueError, match="no Python subclass of a class of a language"):
        ElementClass(kind)
