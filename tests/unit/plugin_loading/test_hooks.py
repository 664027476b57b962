"""Every hook, shown by a plug-in object that uses it."""

import inspect
import re
import sys
from dataclasses import replace
from importlib.metadata import EntryPoint
from pathlib import Path
from types import SimpleNamespace

import pytest

from mmrs_core import hookspecs, plugins
from mmrs_core.contributions.checks import Check
from mmrs_core.contributions.commands import Command
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.contributions.drawings import DrawingReader, Exporter
from mmrs_core.contributions.execution import Condition
from mmrs_core.contributions.fixes import Fix
from mmrs_core.contributions.hooks import Hook
from mmrs_core.contributions.registry import CORE_HOOKS
from mmrs_core.contributions.robot_types import RobotTypeFile
from mmrs_core.contributions.rules import ElementKind, MoveKind, RobotKind, Rule
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.contributions.targets import Target
from mmrs_core.contributions.timing import VehicleTiming
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.errors import PluginError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.classes import ElementClass
from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.importers import Imported, Importer, Recognition
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.plugins import language, load_plugins
from mmrs_core.testing.scenes import FLYER, sample_type
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.timing import AutopilotTiming, LegTiming

KITE = ("urn:test:kite:1.0", "Kite")
ZOO = Path(__file__).parents[2] / "fixtures" / "models" / "zoo.ecore"


class Leg(bl.GoTo):
    """A subclass with a property of its own."""

    @property
    def twice(self):
        return 2.0 * self.distance


def plugin_with(hook, function):
    """Return a plug-in object that implements one hook by that function."""
    return type("Plugin", (), {hook: staticmethod(hookimpl(function))})()


def type_of_plugin(**hooks):
    """Return a plug-in object that implements hooks by these functions."""
    return type("Plugin", (), {name: staticmethod(hookimpl(each)) for name, each in hooks.items()})()


def contributions_with(hook, *declared):
    plugin = plugin_with(hook, lambda: declared)
    return load_plugins(only_core=True, extra={"kites": plugin}).contributions


def unused(*arguments):
    raise AssertionError("loading plug-ins calls no contribution")


def test_every_hook_has_a_test():
    hooks = [
        name for name, _ in inspect.getmembers(hookspecs, inspect.isfunction) if name.startswith("mmrs_")
    ]
    here = vars(sys.modules[__name__])
    assert hooks
    assert [name for name in hooks if f"test_hook_{name}" not in here] == []


def test_what_a_hook_declares_is_what_its_signature_says():
    declaring = {
        name: inspect.signature(hook).return_annotation
        for name, hook in inspect.getmembers(hookspecs, inspect.isfunction)
        if name.startswith("mmrs_") and not inspect.signature(hook).parameters
    }
    kinds = {hook.name: f"Iterable[{plugins._kind(hook).__name__}]" for hook in CORE_HOOKS.values()}
    assert kinds == declaring


def test_hook_mmrs_metamodels(tmp_path):
    ecore = tmp_path / "kite.ecore"
    ecore.write_text(
        '<?xml version="1.0"?><ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
        ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="kite" nsURI="urn:test:kite:1.0"'
        ' nsPrefix="kite"><eClassifiers xsi:type="ecore:EClass" name="Kite"'
        ' eSuperTypes="urn:mmrs:robot:1.0#//Robot"/></ecore:EPackage>'
    )
    contributions = contributions_with("mmrs_metamodels", MetamodelSource(KITE[0], ecore, "kites"))
    kite = contributions.languages.metaclass(*KITE)
    assert ("urn:mmrs:robot:1.0", "Robot") in kite.ancestry


def test_hook_mmrs_element_classes():
    contributions = contributions_with("mmrs_element_classes", ElementClass(Leg))
    assert contributions.languages.create("urn:mmrs:behaviour:1.0", "GoTo", distance=2.0).twice == 4.0
    told = [each.name for each in contributions.catalogue() if each.sort == "element_classes"]
    assert told == ["urn:mmrs:behaviour:1.0#//GoTo"]


def test_hook_mmrs_migrations():
    migration = Migration(KITE[0], "urn:test:kite:1.1", classes={"Kite": "Wing"})
    contributions = contributions_with("mmrs_migrations", migration)
    assert contributions.migrations == (migration,)
    assert contributions.languages.migrations == (migration,)


def test_hook_mmrs_importers():
    def recognise(data, file, registry, stored):
        return Recognition(data.decode()) if data.startswith(b"kite ") else None

    def convert(candidates, registry, known, notes):
        names = (each.content.split()[1] for each in candidates)
        robots = (registry.create("urn:mmrs:robot:1.0", "Robot", name=name) for name in names)
        return [Imported((robot,), ()) for robot in robots]

    importer = Importer("Kites", recognise, lambda file, *_: file, convert, covers=lambda ns_uri: False)
    contributions = contributions_with("mmrs_importers", importer)
    model = read_text(b"kite red", "red.xmi", contributions.languages)
    assert [(type(root).__name__, root.name) for root in model.roots] == [("Robot", "red")]
    assert model.importer == importer


def test_hook_mmrs_fixes():
    fix = Fix("KITE001", "shorten the line", lambda wrong: [])
    assert contributions_with("mmrs_fixes", fix).fixes["KITE001"].title == "shorten the line"


def test_hook_mmrs_constraints():
    constraint = Constraint("KITE001", "a kite has a string", KITE, unused, "tie one on")
    assert constraint in contributions_with("mmrs_constraints", constraint).constraints


def test_hook_mmrs_rules():
    rule = Rule("kite_task", KITE, unused)
    assert contributions_with("mmrs_rules", rule).rules[KITE] == rule


def test_hook_mmrs_robot_kinds():
    kind = RobotKind("kite", KITE, unused, unused, unused, unused)
    assert contributions_with("mmrs_robot_kinds", kind).robot_kinds[KITE] == kind


def test_hook_mmrs_vehicle_timings():
    slow = AutopilotTiming(LegTiming(acceleration=0.5, speed=3.0, settling=2.0), launch=7.0)
    kite_type = sample_type(speed=(0.0, 8.0), acceleration=2.0)
    kind = RobotKind("kite", KITE, lambda robot, scene: FLYER, unused, unused, unused, vehicle="kite")
    timing = VehicleTiming("kite", lambda robot_type: slow)
    plugin = type_of_plugin(mmrs_robot_kinds=lambda: (kind,), mmrs_vehicle_timings=lambda: (timing,))
    known = load_plugins(only_core=True, extra={"kites": plugin}).contributions
    robot = SimpleNamespace(type=kite_type, payload=0.0, travel_mode="NORMAL")
    found = known.robot_kinds[KITE].kinematics(robot, SimpleNamespace(position_error=0.0))
    assert (found.timing.acceleration, found.timing.settling, found.launch) == (0.5, 2.0, 7.0)
    assert (found.cruise, found.fastest) == (3.0, 3.0)
    assert known.vehicle_timings == {"kite": timing}


def test_hook_mmrs_move_kinds():
    kind = MoveKind(KITE, unused, unused, frozenset({"airborne"}))
    assert contributions_with("mmrs_move_kinds", kind).move_kinds[KITE] == kind


def test_hook_mmrs_element_kinds():
    kind = ElementKind(KITE, unused)
    assert contributions_with("mmrs_element_kinds", kind).element_kinds[KITE] == kind


def test_hook_mmrs_checks():
    check = Check("string", "the string holds", unused)
    assert check in contributions_with("mmrs_checks", check).checks


KNOTS = Hook("mmrs_knots", "How to knot", "mmrs_core.contributions.execution:Condition", "identifier")


def test_hook_mmrs_hooks():
    knot = Condition("reef", unused)
    makers, users = plugin_with("mmrs_hooks", lambda: [KNOTS]), plugin_with("mmrs_knots", lambda: [knot])
    found = load_plugins(only_core=True, extra={"users": users, "weavers": makers}).contributions
    assert found.hooks == {"mmrs_knots": KNOTS}
    assert found.extensions == {"knots": {"reef": knot}}
    assert ("users", "knots", "reef") in {(e.plugin, e.sort, e.name) for e in found.catalogue()}


@pytest.mark.parametrize("known", [True, False])
def test_a_hook_that_no_plug_in_specifies_is_refused_unless_it_is_optional(known):
    implementation = hookimpl(optionalhook=known)(lambda: ())
    plugin = type("Plugin", (), {"mmrs_knots": staticmethod(implementation)})()
    if known:
        assert load_plugins(only_core=True, extra={"kites": plugin}).contributions.extensions == {}
        return
    with pytest.raises(PluginError, match=r"plug-in 'kites' of .*: unknown hook 'mmrs_knots'"):
        load_plugins(only_core=True, extra={"kites": plugin})


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        (["bow"], "mmrs_knots gives a str, not a Condition"),
        ([Condition("reef", unused), Condition("reef", unused)], "knot 'reef': contributed twice by 'users'"),
    ],
)
def test_what_a_plug_ins_hook_declares_is_checked_like_the_cores(declared, message):
    makers, users = plugin_with("mmrs_hooks", lambda: [KNOTS]), plugin_with("mmrs_knots", lambda: declared)
    found = load_plugins(only_core=True, extra={"users": users, "weavers": makers}).contributions
    with pytest.raises(PluginError, match=message):
        _ = found.extensions


@pytest.mark.parametrize("name", ["mmrs_rules", "mmrs_knots"])
def test_a_hook_is_specified_once(name):
    makers = plugin_with("mmrs_hooks", lambda: [KNOTS, replace(KNOTS, name=name)])
    with pytest.raises(PluginError, match=rf"'weavers' of .*: hook '{name}' is specified already"):
        load_plugins(only_core=True, extra={"weavers": makers})


def test_hook_mmrs_targets(tmp_path):
    target = Target("kite", "code for kites", tmp_path, unused, unused)
    assert contributions_with("mmrs_targets", target).targets["kite"] == target


def test_hook_mmrs_vehicles():
    vehicle = VehicleFactory("kite", "drives kites", unused)
    assert contributions_with("mmrs_vehicles", vehicle).vehicles["kite"] == vehicle


def test_hook_mmrs_conditions():
    condition = Condition("wind is strong", unused)
    assert contributions_with("mmrs_conditions", condition).conditions["wind is strong"] == condition


def test_hook_mmrs_map_symbols():
    symbol = MapSymbol(KITE, "kite", "#aa0000", "K")
    assert contributions_with("mmrs_map_symbols", symbol).map_symbols[KITE] == symbol


def test_hook_mmrs_robot_types(tmp_path):
    kite = RobotTypeFile("Kite 12", tmp_path / "kite-12.xmi", "kite with a camera")
    assert contributions_with("mmrs_robot_types", kite).robot_types["Kite 12"] == kite


def test_hook_mmrs_drawing_readers():
    reader = DrawingReader("kite drawing", (".kite",), unused, unused)
    assert reader in contributions_with("mmrs_drawing_readers", reader).drawing_readers


def test_hook_mmrs_exporters():
    exporter = Exporter("kite", "files of kites", ".kite", unused)
    assert contributions_with("mmrs_exporters", exporter).exporters["kite"] == exporter


def test_hook_mmrs_commands():
    command = Command("kite", "fly a kite", "kites.command:main")
    assert command in contributions_with("mmrs_commands", command).commands


def test_hook_mmrs_stage_finished():
    seen = []
    plugin = plugin_with("mmrs_stage_finished", lambda stage, result: seen.append((stage, result)))
    assert load_plugins(only_core=True, extra={"kites": plugin}).observe_stage("plan", 42) == {}
    assert seen == [("plan", 42)]


def test_hook_mmrs_step_executed():
    seen = []
    record = StepRecord("run", "kite", 0, 1, 0.0, "begin", "start")
    plugin = plugin_with("mmrs_step_executed", lambda record: seen.append(record))
    assert load_plugins(only_core=True, extra={"kites": plugin}).observe_step(record) == {}
    assert seen == [record]


@pytest.mark.parametrize("error", [OSError(28, "no space left"), SystemExit(3), KeyError("kite")])
def test_an_observer_that_fails_is_named_and_keeps_no_other_from_seeing(error):
    seen = []

    def fail(stage, result):
        raise error

    first = plugin_with("mmrs_stage_finished", lambda stage, result: seen.append("first"))
    broken = plugin_with("mmrs_stage_finished", fail)
    last = plugin_with("mmrs_stage_finished", lambda stage, result: seen.append("last"))
    loaded = load_plugins(only_core=True, extra={"a": first, "broken": broken, "z": last})
    assert loaded.observe_stage("plan", 42) == {
        "plug-in 'broken' of distribution 'given by the caller'": error
    }
    assert sorted(seen) == ["first", "last"]


def test_two_rules_for_one_metaclass_name_both_plug_ins():
    one = plugin_with("mmrs_rules", lambda: [Rule("one", KITE, unused)])
    two = plugin_with("mmrs_rules", lambda: [Rule("two", KITE, unused)])
    loaded = load_plugins(only_core=True, extra={"first": one, "second": two})
    with pytest.raises(PluginError, match="'first' and 'second'"):
        _ = loaded.contributions.rules


def test_two_element_classes_for_one_metaclass_name_both_plug_ins_and_distributions():
    one = plugin_with("mmrs_element_classes", lambda: [ElementClass(Leg)])
    two = plugin_with("mmrs_element_classes", lambda: [ElementClass(type("Other", (bl.GoTo,), {}))])
    loaded = load_plugins(only_core=True, extra={"first": one, "second": two})
    words = (
        "urn:mmrs:behaviour:1.0#//GoTo: two Python classes for it, "
        "Leg of plug-in 'first' of distribution 'given by the caller' and "
        "Other of plug-in 'second' of distribution 'given by the caller'"
    )
    with pytest.raises(PluginError, match=re.escape(words)):
        _ = loaded.contributions.languages
    with pytest.raises(PluginError, match=re.escape(words)):
        loaded.contributions.check()


def test_the_classes_that_a_plug_in_subclasses_are_those_of_the_languages_that_it_is_loaded_with():
    installed = load_plugins().contributions.languages
    drone = language("urn:mmrs:multicopter:1.0").member("Drone")
    assert isinstance(installed.create("urn:mmrs:multicopter:1.0", "Drone"), drone)
    tethered = type("Tethered", (drone,), {"length": 30.0})
    plugin = plugin_with("mmrs_element_classes", lambda: [ElementClass(tethered)])
    others = {
        "kites": plugin,
        "wings": plugin_with("mmrs_metamodels", lambda: [MetamodelSource("urn:test:zoo", ZOO)]),
    }
    for extra in ({"kites": plugin}, others):
        made = load_plugins(extra=extra).contributions.languages.create("urn:mmrs:multicopter:1.0", "Drone")
        assert (made.length, isinstance(made, drone), isinstance(made, tethered)) == (30.0, True, True)


def test_the_classes_of_a_language_stay_those_of_the_plug_ins_however_many_other_languages_come_and_go(
    tmp_path,
):
    drone = language("urn:mmrs:multicopter:1.0").member("Drone")
    for number in range(9):
        file = tmp_path / f"{number}.ecore"
        file.write_text(ZOO.read_text())
        registry_with([MetamodelSource("urn:test:zoo", file)])
    installed = load_plugins().contributions.languages
    assert isinstance(installed.create("urn:mmrs:multicopter:1.0", "Drone"), drone)


def test_two_migrations_from_one_version_name_both_plug_ins():
    one = plugin_with("mmrs_migrations", lambda: [Migration(KITE[0], "urn:test:kite:1.1")])
    two = plugin_with("mmrs_migrations", lambda: [Migration(KITE[0], "urn:test:kite:2.0")])
    loaded = load_plugins(only_core=True, extra={"first": one, "second": two})
    with pytest.raises(PluginError, match=r"migration 'urn:test:kite:1\.0'.*'first' and 'second'"):
        _ = loaded.contributions.migrations


def test_migrations_that_lead_in_a_circle_are_refused():
    circle = (Migration(KITE[0], "urn:test:kite:1.1"), Migration("urn:test:kite:1.1", KITE[0]))
    with pytest.raises(PluginError, match="its migrations lead in a circle"):
        _ = contributions_with("mmrs_migrations", *circle).languages


def test_a_misspelt_hook_is_an_error_that_names_the_plug_in():
    plugin = plugin_with("mmrs_ruels", lambda: [])
    with pytest.raises(PluginError, match=r"'kites'.*mmrs_ruels"):
        load_plugins(only_core=True, extra={"kites": plugin})


def test_a_hook_that_fails_names_the_plug_in():
    def fails():
        raise KeyError("string")

    loaded = load_plugins(only_core=True, extra={"kites": plugin_with("mmrs_rules", fails)})
    with pytest.raises(PluginError, match=r"'kites'.*mmrs_rules fails"):
        _ = loaded.contributions.rules


def test_a_plug_in_that_does_not_import_names_its_distribution(monkeypatch):
    broken = EntryPoint("broken", "no.such.module", "mmrs.plugins")
    monkeypatch.setattr(plugins, "entry_points", lambda group: [broken])
    with pytest.raises(PluginError, match=r"plug-in 'broken' of distribution .* does not load"):
        load_plugins()


def test_two_plug_ins_of_one_name_are_an_error(monkeypatch):
    twice = [EntryPoint("kites", "json", "mmrs.plugins"), EntryPoint("kites", "csv", "mmrs.plugins")]
    monkeypatch.setattr(plugins, "entry_points", lambda group: twice)
    with pytest.raises(PluginError, match="'kites' is used by both"):
        load_plugins()


def test_catalogue_says_who_contributed_what():
    rule = Rule("kite_task", KITE, unused)
    plugin = plugin_with("mmrs_rules", lambda: [rule])
    loaded = load_plugins(only_core=True, extra={"kites": plugin})
    declared = loaded.contributions._declared
    assert ("kites", rule) in declared("rules")


def test_a_hook_that_is_gone_is_told_with_what_takes_its_place():
    plugin = plugin_with("mmrs_backends", lambda: ())
    with pytest.raises(PluginError, match=r"'kites' of .*: hook 'mmrs_backends' is gone: .*'mmrs_vehicles'"):
        load_plugins(only_core=True, extra={"kites": plugin})
