"""Conformance tests for kinds of context elements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from math import isfinite
from typing import ClassVar

import pytest
import shapely

from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.contributions.rules import ElementKind
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.positions import refuse_blocked
from mmrs_core.scene import Area, AreaUse, Part, Position
from mmrs_core.testing.conformance.declared import Conformance, declared
from mmrs_core.testing.scenes import sample_robot, sample_scene
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, program, robot, robot_type


class ElementKindConformance(Conformance):
    """Every kind of context elements makes areas that planner and checks keep all robots out of.

    Attributes:
        elements: by the name of the kind's metaclass: an element that makes at least one area, then those
            that it refers to.
    """

    elements: ClassVar[Mapping[str, Sequence[Part]]]

    def test_every_kind_has_an_element(self) -> None:
        """No kind goes untested, and no element is left over."""
        assert set(self.elements) == {each.metaclass[1] for each in declared(self.plugin, "element_kinds")}

    def test_areas_are_sound_and_named(self, element_kind: ElementKind) -> None:
        """Their outlines do not cross themselves, their heights are in order, and messages can name them."""
        for area in self._areas(element_kind):
            assert area.name
            assert area.use is not AreaUse.EMERGENCY
            assert shapely.Polygon(area.shell).is_valid, area.shell
            assert area.low < area.high
            assert area.safety_distance >= 0.0

    def test_equal_elements_make_equal_areas(self, element_kind: ElementKind) -> None:
        """Plans and checks see the same areas."""
        assert self._areas(element_kind) == self._areas(element_kind)

    def test_an_element_without_figures_makes_areas_or_is_refused(self, element_kind: ElementKind) -> None:
        """A missing figure never crashes."""
        bare = replace(self.elements[element_kind.metaclass[1]][0], attributes={})
        with suppress(InfeasibleError):
            tuple(element_kind.areas(bare, (bare,)))

    def test_planning_keeps_out_of_it(self, element_kind: ElementKind) -> None:
        """No work leads through any of its areas, whichever robot does it."""
        for area in self._areas(element_kind):
            scene = sample_scene(areas=(area,))
            with pytest.raises(InfeasibleError):
                refuse_blocked(sample_robot(), scene, (_inside(area),), "the work")

    def test_checks_find_a_robot_that_enters_it(self, element_kind: ElementKind) -> None:
        """The clearance of a behaviour that leads through any of its areas is violated."""
        known = self.with_core()
        (clearance,) = (check for check in known.checks if check.name == "clearance")
        for area in self._areas(element_kind):
            through = program(robot("r", [go("through", _inside(area))]))
            types = {ROBOT_TYPE: robot_type()}
            given = CheckInput(through, types, known.robot_kinds, known.move_kinds, (area,))
            found = [each for each in clearance.run(given) if each.status is Status.VIOLATED]
            assert [each.area for each in found] == [area.name]

    def _areas(self, kind: ElementKind) -> tuple[Area, ...]:
        element, *others = self.elements[kind.metaclass[1]]
        found = tuple(kind.areas(element, (element, *others)))
        assert found, f"{kind.metaclass[1]}: makes no area of its sample element"
        return found


def _inside(area: Area) -> Position:
    """Return a position within an area."""
    middle = shapely.Polygon(area.shell).representative_point()
    if isfinite(area.low):
        up = (area.low + area.high) / 2.0 if isfinite(area.high) else area.low + 1.0
    else:
        up = area.high - 1.0 if isfinite(area.high) else 0.0
    return middle.x, middle.y, up
