"""What differs between two models is told as people would tell it."""

import pytest

from mmrs_core.languages.comparison.changes import changes_between
from mmrs_core.languages.reading import read_text

OTHER_LANGUAGE = '<animals xsi:type="far:Thing" xmlns:far="urn:far" a="{}"/>'


@pytest.fixture
def changes(zoo, zoo_text):
    """Return a function that compares the contents of two zoos: (sort, before, after, feature, old, new)."""

    def compare(before: str, after: str, more: str = 'name="z"'):
        models = [read_text(zoo_text(text, more), "zoo.xmi", zoo) for text in (before, after)]
        found = changes_between(*(model.roots for model in models))
        return [(c.sort.value, c.before, c.after, c.feature, c.old, c.new) for c in found]

    return compare


def lion(name, more=""):
    return f'<animals xsi:type="zoo:Lion" name="{name}" {more}/>'


def test_equal_models_have_no_changes(changes):
    assert changes(lion("Leo") + lion("Lea"), lion("Leo") + lion("Lea")) == []


def test_a_default_that_is_written_down_is_no_change(changes):
    assert changes(lion("Leo"), lion("Leo", 'teeth="30"')) == []


def test_a_value_that_changed_is_told_as_files_write_it(changes):
    found = changes(lion("Leo", 'mood="is-calm"'), lion("Leo", 'mood="is-hungry"'))
    assert found == [("changed", "/animals[0]", "/animals[0]", "mood", None, ("is-hungry",))]


def test_one_that_was_put_in_front_moves_no_other(changes):
    assert changes(lion("Leo"), lion("Lea") + lion("Leo")) == [("added", "", "/animals[0]", "", None, None)]


def test_one_that_went_moves_no_other(changes):
    found = changes(lion("Lea") + lion("Leo"), lion("Leo"))
    assert found == [("removed", "/animals[0]", "", "", None, None)]


def test_another_order_is_the_fewest_moves(changes):
    names = ["a", "b", "c", "d"]
    found = changes("".join(map(lion, names)), "".join(map(lion, ["d", "a", "b", "c"])))
    assert found == [("moved", "/animals[3]", "/animals[0]", "", None, None)]


def test_another_container_is_a_move(changes):
    found = changes(
        lion("Leo") + '<animals xsi:type="zoo:Otter" name="Ot"/>',
        f'<animals xsi:type="zoo:Otter" name="Ot">{lion("Leo").replace("animals", "cubs")}</animals>',
    )
    assert found == [("moved", "/animals[0]", "/animals[0]/cubs[0]", "", None, None)]


def test_a_change_inside_what_moved_is_told_as_well(changes):
    found = changes(lion("a") + lion("b") + lion("c"), lion("c", 'teeth="3"') + lion("a") + lion("b"))
    assert [change[0] for change in found] == ["moved", "changed"]


def test_another_name_on_much_the_same_is_a_change_of_name(changes):
    rest = 'teeth="3" tame="true" weight="90.5"'
    found = changes(lion("Leo", rest), lion("Leon", rest))
    assert found == [("changed", "/animals[0]", "/animals[0]", "name", ("Leo",), ("Leon",))]


def test_another_class_is_one_that_went_and_one_that_came(changes):
    found = changes('<guest xsi:type="zoo:Lion" name="x"/>', '<guest xsi:type="zoo:Otter" name="x"/>')
    assert [change[:3] for change in found] == [("removed", "/guest", ""), ("added", "", "/guest")]


def test_a_reference_that_leads_to_the_same_element_is_no_change(changes):
    found = changes(
        lion("Leo") + lion("Lea", 'mate="//@animals.0"'), lion("Lea", 'mate="//@animals.1"') + lion("Leo")
    )
    assert [change[0] for change in found] == ["moved"]


def test_a_reference_that_leads_elsewhere_is_a_change(changes):
    both = lion("Leo") + lion("Lea")
    found = changes(both + '<favourites href="#//@animals.0"/>', both + '<favourites href="#//@animals.1"/>')
    assert found == [("changed", "/", "/", "favourites", ("/animals[0]",), ("/animals[1]",))]


def test_values_in_another_order_were_moved(changes):
    two = "<tags>a</tags><tags>b</tags>"
    one = lion("Leo").replace("/>", ">{}</animals>")
    found = changes(one.format(two), one.format("<tags>b</tags><tags>a</tags>"))
    assert found == [("moved", "/animals[0]", "/animals[0]", "tags", ("a", "b"), ("b", "a"))]


def test_elements_without_names_are_matched_by_what_they_say(changes):
    note = '<notes key="{}" value="{}"/>'
    found = changes(
        note.format("a", "1") + note.format("b", "2"), note.format("b", "2") + note.format("a", "9")
    )
    assert [change[0] for change in found] == ["moved", "changed"]


def test_what_was_kept_of_a_missing_language_is_compared_too(changes):
    found = changes(OTHER_LANGUAGE.format(1), OTHER_LANGUAGE.format(2))
    assert [(change[0], change[3]) for change in found] == [("changed", "content")]


def test_what_was_added_is_told_by_its_outermost_element(changes):
    inner = '<animals xsi:type="zoo:Otter" name="Ot"><cubs xsi:type="zoo:Otter" name="o"/></animals>'
    assert [change[:3] for change in changes("", inner)] == [("added", "", "/animals[0]")]


def test_ids_of_xmi_match_before_names(changes):
    found = changes(lion("Leo", 'xmi:id="l1"'), lion("Lea", 'xmi:id="l1"'))
    assert [change[3] for change in found] == ["name"]
