"""Laws for rules."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import dist, inf
from typing import ClassVar

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import Rule, barriers
from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.segments import legs_of, prism_distance
from mmrs_core.languages.registry import Registry
from mmrs_core.planning.strokes import serve_seconds
from mmrs_core.scene import Area, Kinematics, Part, Position, Robot, Scene, Task, Value, Work
from mmrs_core.testing.conformance.declared import Conformance, declared, law, made_by
from mmrs_core.testing.scenes import FLYER, sample_robot, sample_scene, sample_task, square

SMALL = 1e-6


class RuleConformance(Conformance):
    """Every rule of a plug-in gives work that can be done, or refuses it: it never does anything else.

    Attributes:
        tasks: the attributes of a task that the rule serves, by the rule's name. A robot at the origin
            must be able to do it where nothing is in the way.
        robot: that does them; with whatever devices they need.
        elements: of the context, that the tasks refer to; the areas that they make are added to `areas`.
        areas: of the context, such as obstacles that the rule itself reads.
    """

    tasks: ClassVar[Mapping[str, Mapping[str, Value]]]
    robot: ClassVar[Robot] = sample_robot()
    elements: ClassVar[tuple[Part, ...]] = ()
    areas: ClassVar[tuple[Area, ...]] = ()

    def test_every_rule_has_a_task(self) -> None:
        """No rule goes untested, and no task is left over."""
        assert set(self.tasks) == {each.name for each in declared(self.plugin, "rules")}

    def test_a_rule_is_about_a_task_that_exists(self, rule: Rule, registry: Registry) -> None:
        """Its metaclass is a task of the languages."""
        assert registry.metaclass(*rule.metaclass).is_kind("urn:mmrs:mission:1.0", "Task")

    def test_work_names_its_rule_and_has_something_to_do(self, rule: Rule) -> None:
        """Moves are traced to the rule by the name in the work."""
        work = self._work(rule)
        assert work.rule == rule.name
        assert work.strokes

    def test_a_relay_is_the_work_of_one_robot(self, rule: Rule) -> None:
        """Others wait for one robot at one place."""
        work = self._work(rule)
        assert not (work.relays and work.divisible)

    def test_equal_tasks_make_equal_work(self, rule: Rule) -> None:
        """Plans are the same whenever they are made."""
        assert self._work(rule) == self._work(rule)

    def test_actions_and_cuts_lie_on_their_strokes_in_order(self, rule: Rule) -> None:
        """Actions may be at the ends, cuts lie between them."""
        for stroke in self._work(rule).strokes:
            length = sum(dist(a, b) for a, b in pairwise(stroke.points))
            at = [action.at for action in stroke.commands]
            assert at == sorted(at)
            assert all(-SMALL <= each <= length + SMALL for each in at)
            assert list(stroke.cuts) == sorted(set(stroke.cuts))
            assert all(0.0 < each < length for each in stroke.cuts)

    def test_actions_are_ones_that_the_robot_can_do(self, rule: Rule) -> None:
        """Their device is one that the robot carries, and supports the action."""
        devices = self.robot.type.devices
        for stroke in self._work(rule).strokes:
            for each in stroke.commands:
                able = [devices[each.device]] if each.device else devices.values()
                assert any(each.action in device.actions for device in able)

    def test_moves_of_its_own_end_with_the_stroke_and_fit_into_its_seconds(
        self, rule: Rule, alone: Contributions
    ) -> None:
        """Planning counts the strokes: moves that need longer than their stroke make its times wrong.

        Not asked of a stroke to an object, which may be found anywhere.
        """
        if rule.moves is None:
            return
        limits, task, scene = self._limits(), self._task(rule), self._scene()
        for stroke in (each for each in self._work(rule).strokes if each.object is None):
            specs = rule.moves(stroke, task, self.robot, scene)
            steps = list(made_by(specs, stroke.points[0], self.robot.home, alone))
            paths = [path for _, _, path in steps if path is not None]
            least = sum(
                kind.seconds(move, path, limits, self.robot.travel_mode)[0]
                for kind, move, path in steps
                if path is not None
            )
            assert (paths[-1] if paths else stroke.points)[-1] == pytest.approx(stroke.points[-1], abs=SMALL)
            assert least <= serve_seconds(stroke, self.robot, limits) + SMALL, "hold lacks seconds"

    def test_coverage_lies_in_the_area_asked_for(self, rule: Rule) -> None:
        """What is covered is inside the shell and outside of its holes."""
        coverage = self._work(rule).coverage
        if coverage is None:
            return
        asked = shapely.Polygon(coverage.shell, coverage.holes)
        for shell, holes in coverage.target:
            assert shapely.Polygon(shell, holes).difference(asked).area <= SMALL * asked.area

    def test_work_keeps_clear_of_an_obstacle_or_is_refused(self, rule: Rule) -> None:
        """An obstacle that is put on the way is gone around by the work, or makes it impossible."""
        places = _places(self._work(rule))

        @law(examples=20)
        @given(st.sampled_from(places), st.floats(0.1, 30.0))
        def holds(place: Position, half: float) -> None:
            self._clear(rule, square("mast", place[0], place[1], half, place[2] + 50.0))

        holds()

    @pytest.mark.parametrize("share", [0.0, 0.5, 1.0, 2.0])
    def test_work_stays_below_the_ceiling_or_is_refused(self, rule: Rule, share: float) -> None:
        """A robot that goes less high than the work does less, or does not do it."""
        highest = max(up for _, _, up in _places(self._work(rule)))
        self._bounded(rule, replace(self._limits(), ceiling=share * highest, floor=-inf))

    @pytest.mark.parametrize("more", [-10.0, 0.5, 50.0])
    def test_work_stays_above_the_floor_or_is_refused(self, rule: Rule, more: float) -> None:
        """A robot that goes less low than the work does less, or does not do it."""
        lowest = min(up for _, _, up in _places(self._work(rule)))
        self._bounded(rule, replace(self._limits(), floor=lowest + more, ceiling=inf))

    def test_a_task_that_lacks_what_it_may_lack_is_served_or_refused(
        self, rule: Rule, registry: Registry
    ) -> None:
        """Whatever the metamodel lets a task leave out, the rule can do without, or says why not."""
        whole = self._task(rule)
        metaclass = registry.metaclass(*rule.metaclass)
        for name in whole.part.attributes:
            if metaclass.feature(name).required:
                continue
            attributes = {**whole.part.attributes, name: None}
            self._try(rule, replace(whole, part=replace(whole.part, attributes=attributes)), self.robot)

    def test_a_robot_without_devices_is_served_or_refused(self, rule: Rule) -> None:
        """A robot that cannot do a task is refused with a reason, and others do it."""
        bare = replace(self.robot, type=replace(self.robot.type, devices={}))
        self._try(rule, self._task(rule), bare)

    def _task(self, rule: Rule) -> Task:
        return sample_task(rule.metaclass, **self.tasks[rule.name])

    def _scene(self, *areas: Area) -> Scene:
        known, drawn = self.with_core(), (*self.areas, *areas)
        kinds = known.robot_kinds, known.element_kinds
        made = barriers(tuple(self.elements), drawn, (self.robot.type,), *kinds)
        return sample_scene(self.robot, areas=(*drawn, *made), elements=self.elements)

    def _work(self, rule: Rule) -> Work:
        return rule.work(self._task(rule), self.robot, self._scene())

    def _limits(self) -> Kinematics:
        return self.robot.kinematics or FLYER

    def _clear(self, rule: Rule, obstacle: Area) -> None:
        try:
            work = rule.work(self._task(rule), self.robot, self._scene(obstacle))
        except InfeasibleError:
            return
        for line in _lines(work):
            wanted = obstacle.safety_distance + self.robot.clearance
            assert _distance(line, obstacle) >= wanted - SMALL

    def _bounded(self, rule: Rule, limits: Kinematics) -> None:
        work = self._try(rule, self._task(rule), replace(self.robot, kinematics=limits))
        for _, _, up in _places(work) if work else ():
            assert limits.floor - SMALL <= up <= limits.ceiling + SMALL

    def _try(self, rule: Rule, task: Task, robot: Robot) -> Work | None:
        """Return the work; None where it is refused."""
        try:
            return rule.work(task, robot, replace(self._scene(), robots=(robot,)))
        except InfeasibleError:
            return None


def _lines(work: Work) -> list[tuple[Position, ...]]:
    entry = [(work.entry,)] if work.entry is not None else []
    return [*entry, *(stroke.points for stroke in work.strokes)]


def _places(work: Work) -> list[Position]:
    return [place for line in _lines(work) for place in line]


def _distance(points: Sequence[Position], area: Area) -> float:
    return float(prism_distance(legs_of(points), area.shell, area.low, area.high).min())
