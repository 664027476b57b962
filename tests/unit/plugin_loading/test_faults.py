"""A fault of a plug-in is told as the plug-in's, with what it contributed."""

import pytest
from mmrs_multicopter.testing import two_drones

from mmrs_core import pipeline
from mmrs_core.contributions.checks import Check
from mmrs_core.contributions.commands import Command
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.contributions.execution import Condition
from mmrs_core.contributions.rules import MoveKind, RobotKind, Rule
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.contributions.targets import FileSpec, Target
from mmrs_core.errors import InfeasibleError, PluginError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins

KITE = ("urn:test:kite:1.0", "Kite")
MISSPELT = ("urn:mmrs:mission:1.0", "PontTask")
BLAMED = "plug-in 'kites' of distribution 'given by the caller': "


def contributions_with(hook, *declared):
    plugin = type("Plugin", (), {hook: staticmethod(hookimpl(lambda: declared))})()
    return load_plugins(only_core=True, extra={"kites": plugin}).contributions


def fails(*arguments):
    raise KeyError("string")


def fails_later(*arguments):
    yield 1
    raise KeyError("string")


def calls(tmp_path):
    """Return, by name, a function that calls a contributed function that fails."""

    def contributed(sort, item):
        found = getattr(contributions_with(f"mmrs_{sort}", item), sort)
        each = list(found.values()) if hasattr(found, "values") else list(found)
        return next(other for other in each if other == item)

    constraint = Constraint("KITE001", "t", KITE, fails_later, "h")
    rule, check = Rule("wave", KITE, fails, fails), Check("string", "t", fails_later)
    robots, moves = RobotKind("kite", KITE, fails, fails, fails, fails), MoveKind(KITE, fails, fails, set())
    target = Target("kite-cards", "d", tmp_path, fails_later, fails_later)
    condition = Condition("windy", fails)
    return {
        "constraint 'KITE001'": lambda: list(contributed("constraints", constraint).check(1, 2)),
        "rule 'wave'": lambda: contributed("rules", rule).moves(1, 2),
        "robot kind 'kite'": lambda: contributed("robot_kinds", robots).launch(1.0),
        "move kind 'urn:test:kite:1.0#//Kite'": lambda: contributed("move_kinds", moves).path(1, 2, 3),
        "check 'string'": lambda: list(contributed("checks", check).run(1)),
        "target 'kite-cards'": lambda: list(contributed("targets", target).files(1)),
        "condition 'windy'": lambda: contributed("conditions", condition).holds(1),
    }


@pytest.mark.parametrize("what", calls(None))
def test_what_fails_names_plug_in_distribution_and_contribution(what, tmp_path):
    with pytest.raises(PluginError) as caught:
        calls(tmp_path)[what]()
    assert str(caught.value) == f"{BLAMED}{what} fails: KeyError('string')"
    assert isinstance(caught.value.__cause__, KeyError)


def test_an_error_that_the_contract_allows_passes():
    def refuses(*arguments):
        raise InfeasibleError("too windy")

    rule = contributions_with("mmrs_rules", Rule("wave", KITE, refuses)).rules[KITE]
    with pytest.raises(InfeasibleError, match="too windy"):
        rule.work(1, 2, 3)


def test_a_template_that_is_broken_names_the_plug_in_and_the_line(tmp_path):
    (tmp_path / "card.txt.jinja").write_text("first line\n{{ robot }}\n", "utf-8")

    def cards(given):
        yield FileSpec("card.txt", "card.txt.jinja", {"robot": given.program.robots[0].id})

    target = Target("kite-cards", "d", tmp_path, cards, lambda given: ())
    contributions = contributions_with("mmrs_targets", target)
    with pytest.raises(PluginError) as caught:
        pipeline.render(two_drones(), pipeline.BehaviourContext({}), "kite-cards", contributions)
    assert str(caught.value).startswith(f"{BLAMED}target 'kite-cards': template card.txt.jinja, line 2: ")


def test_what_works_gives_what_it_gives():
    rule = contributions_with("mmrs_rules", Rule("wave", KITE, lambda *given: given)).rules[KITE]
    assert rule.work(1, 2, 3) == (1, 2, 3)


@pytest.mark.parametrize("code", ["K001", "KITE01", "KITE0001", "kite001", "KITE1", ""])
def test_a_constraint_has_a_code_of_capitals_and_three_digits(code):
    contributions = contributions_with("mmrs_constraints", Constraint(code, "t", KITE, fails, "h"))
    with pytest.raises(PluginError, match=r"constraint .* of plug-in 'kites'.*two or more capitals"):
        _ = contributions.constraints


MISTAKEN = {
    "constraints": Constraint("KITE001", "t", MISSPELT, fails, "h"),
    "rules": Rule("wave", MISSPELT, fails),
    "robot_kinds": RobotKind("kite", MISSPELT, fails, fails, fails, fails),
    "move_kinds": MoveKind(MISSPELT, fails, fails, frozenset()),
    "map_symbols": MapSymbol(MISSPELT, "kite", "#aa0000", "K"),
}


@pytest.mark.parametrize("sort", MISTAKEN)
def test_a_class_that_an_installed_language_does_not_have_is_an_error(sort):
    contributions = contributions_with(f"mmrs_{sort}", MISTAKEN[sort])
    with pytest.raises(PluginError, match=r"'kites'.*PontTask: no class of urn:mmrs:mission:1.0.*PointTask"):
        getattr(contributions, sort)


def test_the_same_thing_twice_in_one_plug_in_names_it_once():
    contributions = contributions_with("mmrs_rules", Rule("wave", KITE, fails), Rule("other", KITE, fails))
    with pytest.raises(PluginError) as caught:
        _ = contributions.rules
    assert str(caught.value) == "rule 'urn:test:kite:1.0#//Kite': contributed twice by 'kites'"


def test_a_command_of_the_core_stays_the_cores():
    contributions = contributions_with("mmrs_commands", Command("plan", "h", "kites:plan"))
    with pytest.raises(PluginError, match="command 'plan': contributed by both 'core' and 'kites'"):
        _ = contributions.commands


def test_something_else_than_the_hook_declares_is_an_error():
    with pytest.raises(PluginError, match="mmrs_rules gives a str, not a Rule"):
        _ = contributions_with("mmrs_rules", "wave").rules


def test_all_that_is_installed_is_free_of_conflict():
    load_plugins().contributions.check()
