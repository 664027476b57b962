"""The conformance classes find faulty contributions, and load what a plug-in builds on without testing it."""

from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import pytest
from mmrs_multicopter import plugin as multicopter

from mmrs_core.behaviour.program import Move
from mmrs_core.contributions.checks import Check, Status, Verdict
from mmrs_core.contributions.rules import ElementKind, MoveKind, MoveSpec, Rule
from mmrs_core.contributions.targets import FileSpec, Target, TracedStep
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_core.scene import AreaUse, Part, Stroke, Work
from mmrs_core.testing.conformance import (
    CheckCase,
    CheckConformance,
    ElementKindConformance,
    MetamodelConformance,
    MoveKindConformance,
    PluginConformance,
    RuleConformance,
    TargetConformance,
)
from mmrs_core.testing.programs import sample_of
from mmrs_core.testing.scenes import square
from mmrs_core.testing.small_programs import go, program, robot
from mmrs_core.transformation.kinds import starting_time, stays

BALLOON = "urn:mmrs:testing:balloon:1.0"
ECORE = f"""<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"
    name="balloon" nsURI="{BALLOON}" nsPrefix="balloon">
  <eClassifiers xsi:type="ecore:EClass" name="Release" eSuperTypes="urn:mmrs:multicopter:1.0#//TakeOff">
    <eAnnotations source="http://www.eclipse.org/emf/2002/GenModel">
      <details key="documentation" value="Releases the rope."/>
    </eAnnotations>
  </eClassifiers>
</ecore:EPackage>
"""


@pytest.fixture
def balloons(tmp_path):
    """Return a plug-in whose move extends a move of another plug-in."""
    file = tmp_path / "balloon.ecore"
    file.write_text(ECORE)
    kind = MoveKind((BALLOON, "Release"), stays, starting_time, frozenset({"grounded"}))
    return SimpleNamespace(
        mmrs_metamodels=hookimpl(lambda: (MetamodelSource(BALLOON, file, "balloons"),)),
        mmrs_move_kinds=hookimpl(lambda: (kind,)),
    )


def kit_for(plugin, base, **attributes):
    """Return a conformance class for a plug-in, as a test module would have it."""
    return type("Tested", (base,), {"plugin": plugin, "name": "balloons", **attributes})


@pytest.mark.parametrize(
    "more",
    [{"more_plugins": (multicopter,)}, {"more_metamodels": tuple(multicopter.mmrs_metamodels())}],
    ids=["plugins", "metamodels"],
)
def test_what_a_plugin_builds_on_is_loaded_and_not_tested(balloons, more):
    kit = kit_for(balloons, PluginConformance, **more)
    kit().test_it_conflicts_with_nothing_in_the_core(kit.with_core())
    kit().test_every_move_has_a_kind(kit.with_core())


def test_a_missing_metamodel_is_named_with_what_loads_it(balloons):
    with pytest.raises(pytest.fail.Exception, match=r"multicopter:1\.0.*more_plugins"):
        kit_for(balloons, MetamodelConformance).with_core()


MAST = Part((("urn:mmrs:testing:masts:1.0", "Mast"),), {"name": "mast"})


def kit_for_masts(areas):
    """Return the conformance class for a plug-in whose masts make these areas."""
    kind = ElementKind(MAST.metaclasses[0], lambda element, everything: areas)
    plugin = SimpleNamespace(mmrs_element_kinds=hookimpl(lambda: (kind,)))
    return kit_for(plugin, ElementKindConformance, elements={"Mast": (MAST,)})(), kind


def test_areas_of_elements_are_obstacles_to_planner_and_checks():
    kit, kind = kit_for_masts((square("mast", 30.0, 0.0, 1.0, 20.0),))
    kit.test_areas_are_sound_and_named(kind)
    kit.test_planning_keeps_out_of_it(kind)
    kit.test_checks_find_a_robot_that_enters_it(kind)


@pytest.mark.parametrize(
    "area",
    [
        replace(square("mast", 0.0, 0.0, 1.0), shell=((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0))),
        replace(square("mast", 0.0, 0.0, 1.0), low=5.0, high=4.0),
        replace(square("mast", 0.0, 0.0, 1.0), use=AreaUse.EMERGENCY),
        square("", 0.0, 0.0, 1.0),
    ],
    ids=["crossed", "upside down", "emergency", "unnamed"],
)
def test_an_unsound_area_of_an_element_is_found(area):
    kit, kind = kit_for_masts((area,))
    with pytest.raises(AssertionError):
        kit.test_areas_are_sound_and_named(kind)


def test_an_area_that_concerns_some_robots_only_is_found():
    kit, kind = kit_for_masts((replace(square("mast", 30.0, 0.0, 1.0), types=frozenset({"other"})),))
    with pytest.raises(pytest.fail.Exception, match="DID NOT RAISE"):
        kit.test_planning_keeps_out_of_it(kind)


def rises_by(up):
    """Return the path of a take-off whose end is as high as `up` states."""
    return lambda move, here, home: (
        (here, (*here[:2], up(here, home))) if up(here, home) is not None else None
    )


@pytest.mark.parametrize(
    ("up", "fault"),
    [
        (lambda here, home: home and home[2] + 9.0, "unknown without a home"),
        (lambda here, home: 9.0, "approx"),
        (lambda here, home: here[2], "assert 0.0 > 0.0"),
    ],
    ids=["above home", "above the origin", "nowhere"],
)
def test_a_take_off_that_targets_cannot_express_is_found(up, fault):
    kind = MoveKind((BALLOON, "Release"), rises_by(up), starting_time, frozenset(), manoeuvre="take_off")
    kit = kit_for(None, MoveKindConformance, moves={"Release": Move("up", (kind.metaclass,), {})})()
    with pytest.raises(AssertionError, match=fault):
        kit.test_what_vehicles_make_of_it_is_known_without_a_home(kind)


@pytest.mark.parametrize(
    ("seconds", "east", "fault"), [(4.0, 0.0, None), (4.1, 0.0, "hold lacks"), (4.0, 1.0, "approx")]
)
def test_moves_of_a_rule_that_do_not_fit_its_stroke_are_found(seconds, east, fault):
    def moves(stroke, task, robot, scene):
        hold = MoveSpec(("urn:mmrs:behaviour:1.0", "HoldPosition"), {"duration": seconds})
        there = (east, *stroke.points[0][1:])
        return (*((MoveSpec(("urn:mmrs:behaviour:1.0", "GoTo"), target=there),) if east else ()), hold)

    work = Work((Stroke(((0.0, 0.0, 5.0),), hold=4.0),), divisible=False, rule="rest")
    rule = Rule("rest", (BALLOON, "Rest"), lambda task, robot, scene: work, moves)
    kit = kit_for(SimpleNamespace(), RuleConformance, tasks={"rest": {}})()
    with pytest.raises(AssertionError, match=fault) if fault else nullcontext():
        kit.test_moves_of_its_own_end_with_the_stroke_and_fit_into_its_seconds(rule, kit.with_core())


@pytest.fixture
def cards(tmp_path):
    """Return a function from a template to the conformance class for a target that writes moves with it."""

    def files(given):
        for number, one in enumerate(given.program.robots):
            steps = tuple(TracedStep(move.id, one.id, move.id) for move in one.moves)
            yield FileSpec(f"card_{number}.txt", "card.jinja", {"steps": steps, "robot": one}, steps)

    def kit(template):
        (tmp_path / "card.jinja").write_text(template)
        target = Target("cards", "cards", tmp_path, files, lambda given: ())
        plugin = SimpleNamespace(mmrs_targets=hookimpl(lambda: (target,)))
        return kit_for(plugin, TargetConformance)(), target

    return kit


def test_a_step_that_no_line_of_the_template_serves_is_found(cards):
    line = "{{ step.move | comment }}\n"
    kit, target = cards(f"{{% for step in steps %}}{{% serves step %}}{line}{{% endserves %}}{{% endfor %}}")
    kit.test_every_step_that_it_declares_is_served_by_lines(target)
    kit, target = cards(f"{{% for step in steps %}}{line}{{% endfor %}}")
    with pytest.raises(AssertionError, match=r"no lines of the template serve these steps"):
        kit.test_every_step_that_it_declares_is_served_by_lines(target)


def test_a_target_that_loses_something_silently_is_found(cards):
    kit, target = cards("{% for move in robot.moves %}{{ move.id | comment }}{% endfor %}")
    with pytest.raises(pytest.fail.Exception, match=r"make no difference(.|\n)*action: Move\.postActions"):
        kit.test_nothing_is_lost_silently(target)


def kit_for_check(found, made, **attributes):
    """Return the conformance class for a check with these verdicts, whatever the behaviour."""
    check = Check("calm", "It is calm.", lambda given: found, "wait")
    plugin = SimpleNamespace(mmrs_checks=hookimpl(lambda: (check,)))
    return kit_for(plugin, CheckConformance, cases={"calm": CheckCase(made, made, **attributes)})(), check


def test_a_check_that_does_not_know_a_move_is_told_what_is_not_loaded():
    unknown = Verdict("calm", Status.UNKNOWN, "alpha", message="no plug-in provides the move kind 'TakeOff'")
    kit, check = kit_for_check((unknown,), sample_of("multicopter").plain.program)
    words = (
        r"unknown: alpha: no plug-in provides the move kind 'TakeOff'\n"
        r"(.|\n)*not loaded: the kind of move TakeOff of urn:mmrs:multicopter:1\.0; name its plug-in in"
        r"(.|\n)*not given: robot type 'Kind'"
    )
    for law in (kit.test_a_violation_is_found_and_located, kit.test_a_behaviour_with_the_property_is_safe):
        with pytest.raises(pytest.fail.Exception, match=words):
            law(check)


@pytest.mark.parametrize(
    ("message", "fits"),
    [
        ("comes too near", True),
        ("GoTo 'out' comes too near", True),
        ("r: GoTo 'out' comes too near", True),
        ("Comes too near", False),
        ("comes too near.", False),
    ],
)
def test_messages_of_checks_are_lower_case_but_for_names(message, fits):
    found = Verdict("calm", Status.VIOLATED, "r", message=message)
    kit, check = kit_for_check((found,), program(robot("r", [go("out", (30.0, 0.0, 0.0))])))
    with nullcontext() if fits else pytest.raises(AssertionError):
        kit.test_verdicts_name_their_check_and_are_lower_case(check)
