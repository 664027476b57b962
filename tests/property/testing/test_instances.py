"""Random instances are valid, and reach all that a metamodel allows."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import descendants, held, is_kind, metaclass_of
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_xmi
from mmrs_core.testing.instances import drafts_of, instances_of, models_of

HERE = Path(__file__).parent
PROJECT = HERE.parents[2]
RELAXED = settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
KNOTS = "urn:test:knots"


@pytest.fixture(scope="module")
def registry():
    """The core, the plug-ins, foreign metamodels, and one whose references are all hard to fill."""
    files = sorted((PROJECT / "plugins").glob("*/mmrs_*/metamodels/*.ecore"))
    fixtures = sorted((PROJECT / "tests" / "fixtures" / "models").glob("*.ecore"))
    return registry_of_files([*files, *fixtures, HERE / "knots.ecore"], ())[0]


def whole(root):
    return [root, *descendants(root)]


@RELAXED
@given(data=st.data())
def test_instances_of_every_metamodel_are_valid(registry, data):
    package = data.draw(st.sampled_from(registry.packages))
    root = data.draw(instances_of(registry, package.ns_uri))
    assert [str(fault) for fault in check_conformance(Model("m", (root,)), registry)] == []


@RELAXED
@given(data=st.data())
def test_files_keep_what_makes_an_instance_valid(registry, data):
    root = data.draw(instances_of(registry, data.draw(st.sampled_from((KNOTS, "urn:mmrs:mission:1.0")))))
    again = read_text(to_xmi([root], registry), "again.xmi", registry)
    assert [*again.diagnostics, *check_conformance(again, registry)] == []


@RELAXED
@given(data=st.data())
def test_references_that_must_lead_somewhere_do(registry, data):
    root = data.draw(instances_of(registry, KNOTS, "Rope"))
    for element in whole(root):
        for each in metaclass_of(element).features:
            if each.name in ("tight", "pairs", "either", "partner"):
                assert len(held(element, each)) >= each.lower


def found(strategy, wanted):
    profile = settings(RELAXED, max_examples=2000, database=None, phases=[Phase.generate])
    return find(strategy, wanted, settings=profile)


def test_subclasses_of_other_metamodels_are_drawn_too(registry):
    tasks = instances_of(registry, "urn:mmrs:mission:1.0", "Task")
    assert found(tasks, lambda task: is_kind(task, "urn:mmrs:survey:1.0", "RoadTask"))


def test_identifiers_differ_in_every_instance(registry):
    keepers = instances_of(registry, "urn:test:zoo", "Zoo", values=SAME_BADGES)
    assert found(keepers, lambda zoo: len({k.badge for k in zoo.keepers if k.badge}) > 1)


SAME_BADGES = {("http://www.eclipse.org/emf/2002/Ecore", "EString"): st.sampled_from("ab")}


@RELAXED
@given(data=st.data())
def test_identifiers_are_never_used_twice(registry, data):
    zoo = data.draw(instances_of(registry, "urn:test:zoo", "Zoo", values=SAME_BADGES))
    badges = [each.badge for each in whole(zoo) if is_kind(each, "urn:test:zoo", "Keeper") and each.badge]
    assert len(badges) == len(set(badges))


@pytest.mark.parametrize("feature", ["favourites", "star", "anything"])
def test_references_that_may_lead_somewhere_sometimes_do(registry, feature):
    zoos = instances_of(registry, "urn:test:zoo", "Zoo")
    assert found(zoos, lambda zoo: held(zoo, metaclass_of(zoo).feature(feature)))


def test_a_class_that_needs_what_cannot_stand_inside_it_is_refused(registry):
    with pytest.raises(ValueError, match=r"UnicastNotify: .* slot refers to Slot, which cannot stand inside"):
        instances_of(registry, "urn:mmrs:behaviour:1.0", "UnicastNotify")


def test_a_class_that_contains_itself_without_end_is_refused(registry):
    with pytest.raises(ValueError, match="Endless: no finite element"):
        instances_of(registry, KNOTS, "Endless")


def test_an_abstract_class_without_subclasses_is_refused(registry):
    with pytest.raises(ValueError, match="no class that elements can be made of"):
        instances_of(registry, KNOTS, "Ghost")


def test_more_levels_make_deeper_trees(registry):
    def depth(element):
        return 1 + max((depth(cub) for cub in element.cubs), default=0)

    cubs = instances_of(registry, "urn:test:zoo", "Lion", levels=4)
    assert found(cubs, lambda lion: depth(lion) > 3)


@RELAXED
@given(data=st.data())
def test_elements_that_need_others_are_drawn_beside_them(registry, data):
    roots = data.draw(models_of(registry, (KNOTS, "Knot"), (KNOTS, "Fibre"), (KNOTS, "Fibre")))
    assert [metaclass_of(root).name for root in roots] == ["Knot", "Fibre", "Fibre"]
    assert check_conformance(Model("m", roots), registry) == ()


def test_models_whose_needs_nothing_meets_are_refused(registry):
    with pytest.raises(ValueError, match="cannot stand inside it"):
        models_of(registry, (KNOTS, "Knot"), (KNOTS, "Strand"))


@RELAXED
@given(data=st.data())
def test_drafts_lack_values_but_hold_no_wrong_ones(registry, data):
    package = data.draw(st.sampled_from(registry.packages))
    root = data.draw(drafts_of(registry, package.ns_uri))
    codes = {fault.code for fault in check_conformance(Model("m", (root,)), registry)}
    assert codes <= {"ECO001", "ECO002"}


@pytest.mark.parametrize("code", ["ECO001", "ECO002"])
def test_drafts_lack_whatever_may_be_missing(registry, code):
    ropes = drafts_of(registry, KNOTS, "Rope")
    assert found(
        ropes, lambda rope: code in {fault.code for fault in check_conformance(Model("m", (rope,)), registry)}
    )


def test_even_what_cannot_stand_alone_has_drafts(registry):
    drafts = drafts_of(registry, "urn:mmrs:mission:1.0", "TaskDependency")
    assert found(drafts, lambda dependency: dependency.to is None)
