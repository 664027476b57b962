"""Areas that elements of a context are to some robots and not to others."""

from dataclasses import replace

import pytest

from mmrs_core.contributions.rules import ElementKind, barriers
from mmrs_core.scene import Area, AreaUse, Capability, Frame, Part, Robot, RobotType, Scene
from mmrs_core.scene.attributes import element_called
from mmrs_core.transformation.kinds import PLAIN_ROBOT, ROBOT

POND, ROCK = ("urn:test:1.0", "Pond"), ("urn:test:1.0", "Rock")
LINE, ELEMENT = ("urn:test:1.0", "Line"), ("urn:test:1.0", "Element")
SQUARE = ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0))
AREA = Area("mast", AreaUse.OBSTACLE, SQUARE)


def robot_type(name):
    capability = Capability(0.0, None, (0.0, 1.0))
    return RobotType(name, (ROBOT,), (), 0.5, None, (capability,), (), {}, Part((), {}))


def robot(name):
    return Robot(name, robot_type(name), (0.0, 0.0, 0.0), True, 0.0, "SAFE", 0.5)


@pytest.fixture
def kinds():
    """Return robot kinds of which the plain one cannot swim."""

    def barrier(robot_type, element):
        return Area("pond", AreaUse.OBSTACLE, SQUARE) if element.is_a(POND) else None

    return {ROBOT: replace(PLAIN_ROBOT, barrier=barrier)}


def test_an_element_bars_every_type_that_cannot_pass_it(kinds):
    found = barriers((Part((POND,), {}),), (), [robot_type("b"), robot_type("a")], kinds, {})
    assert [each.types for each in found] == [frozenset({"a"}), frozenset({"b"})]


def test_an_element_that_hinders_nobody_bars_nobody(kinds):
    assert barriers((Part((ROCK,), {}),), (), [robot_type("a")], kinds, {}) == ()


def test_a_kind_without_barriers_may_go_anywhere():
    assert barriers((Part((POND,), {}),), (), [robot_type("a")], {ROBOT: PLAIN_ROBOT}, {}) == ()


def test_a_robot_of_no_known_kind_has_no_barrier(kinds):
    stranger = replace(robot_type("a"), metaclasses=(("urn:test:1.0", "Stranger"),))
    assert barriers((Part((POND,), {}),), (), [stranger], kinds, {}) == ()


def test_an_element_of_a_kind_bars_everybody_where_the_elements_that_it_names_are():
    def wires(line, everything):
        ends = [element_called(everything, name) for name in line.attributes["pylons"]]
        shell = tuple((each.attributes["east"], 0.0) for each in ends if each is not None)
        yield Area("wires", AreaUse.OBSTACLE, shell)

    pylon = Part((POND,), {"name": "west", "east": 1.0})
    mast = replace(AREA, part=Part((POND,), {"name": "east", "east": 9.0}))
    line = Part((LINE, ELEMENT), {"pylons": ("west", "east", "fallen")})
    kinds = {ELEMENT: ElementKind(ELEMENT, lambda *given: ()), LINE: ElementKind(LINE, wires)}
    (found,) = barriers((line, pylon), (mast,), [robot_type("a")], {}, kinds)
    assert (found.shell, found.types) == (((1.0, 0.0), (9.0, 0.0)), None)


def test_an_element_of_a_kind_spares_the_robots_that_are_at_home_there():
    ferry = replace(robot_type("ferry"), metaclasses=(("urn:test:1.0", "Ferry"), ROBOT))
    kinds = {POND: ElementKind(POND, lambda *given: (AREA,), spares=frozenset({("urn:test:1.0", "Ferry")}))}
    for types, concerned in (([ferry, robot_type("a")], frozenset({"a"})), ([robot_type("a")], None)):
        (found,) = barriers((Part((POND,), {}),), (), types, {}, kinds)
        assert found.types == concerned


def test_a_robot_keeps_only_from_the_areas_that_concern_its_type():
    wall = Area("wall", AreaUse.OBSTACLE, SQUARE)
    pond = replace(wall, name="pond", types=frozenset({"a"}))
    refuge = replace(wall, name="refuge", use=AreaUse.EMERGENCY)
    scene = Scene("s", Frame("EPSG:4326", None, None), (), (), (), areas=(wall, pond, refuge))
    assert [each.name for each in scene.kept_from(robot("a"))] == ["wall", "pond"]
    assert [each.name for each in scene.kept_from(robot("b"))] == ["wall"]
