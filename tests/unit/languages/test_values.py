from datetime import UTC, datetime, timedelta, timezone
from decimal import Decimal

import pytest

from mmrs_core.languages.writing import to_xmi


def faults(model):
    return [fault.code for fault in model.diagnostics]


def test_a_literal_that_differs_from_its_name_is_read_as_the_name(lion):
    assert lion('mood="is-hungry"').mood == "HUNGRY"


def test_a_literal_that_differs_from_its_name_is_written_as_the_literal(lion, zoo):
    leo = lion('mood="is-hungry"')
    assert b'mood="is-hungry"' in to_xmi([leo._mmrs_container], zoo)


def test_the_default_of_an_enumeration_is_its_first_literal_whatever_its_value(lion):
    assert lion("").mood == "CALM"


def test_a_default_is_found_by_literal(lion):
    assert lion("").hungry == "HUNGRY"


@pytest.mark.parametrize("text", ["NOPE", "HUNGRY", "is-Calm", ""])
def test_a_text_that_is_no_literal_is_a_fault_and_never_a_silent_none(read_zoo, text):
    model = read_zoo(f'<animals xsi:type="zoo:Lion" name="Leo" mood="{text}"/>')
    assert faults(model) == ["XMI005"]
    assert "is-calm, is-hungry, ANGRY" in model.diagnostics[0].message


@pytest.mark.parametrize(("text", "value"), [("true", True), ("TRUE", True), ("False", False)])
def test_truth_values_are_read_in_any_case(lion, text, value):
    assert lion(f'tame="{text}"').tame is value


@pytest.mark.parametrize("text", ["1", "yes", "", " true"])
def test_other_words_are_no_truth_values(read_zoo, text):
    assert faults(read_zoo(f'<animals xsi:type="zoo:Lion" name="L" tame="{text}"/>')) == ["XMI005"]


@pytest.mark.parametrize("text", ["1_000", " 5 ", "4294967296", "-2147483649", "5.0", "", "𝟛", "9" * 5000])
def test_what_java_takes_for_no_int_is_a_fault(read_zoo, text):
    assert faults(read_zoo(f'<animals xsi:type="zoo:Lion" name="L" teeth="{text}"/>')) == ["XMI005"]


@pytest.mark.parametrize(
    ("text", "value"), [("+5", 5), ("-2147483648", -(2**31)), ("0" * 30 + "5", 5), ("٣", 3)]
)
def test_what_java_takes_for_an_int_is_read(lion, text, value):
    assert lion(f'teeth="{text}"').teeth == value


@pytest.mark.parametrize(
    ("text", "value"),
    [("1.5d", 1.5), ("2F", 2.0), (".5", 0.5), ("3.", 3.0), ("1E-3", 0.001), (" 4 ", 4.0), ("0x1.8p3", 12.0)],
)
def test_javas_notation_of_real_numbers_is_read(lion, text, value):
    assert lion(f'weight="{text}"').weight == value


@pytest.mark.parametrize(
    "text",
    ["nan", "inf", "infinity", "1,5", "1_0.0", "0x1", "0x1_0p3", "", "1.5 m", "٣.٥", "１", "\u00a05.0"],
)
def test_other_notations_of_real_numbers_are_faults(read_zoo, text):
    assert faults(read_zoo(f'<animals xsi:type="zoo:Lion" name="L" weight="{text}"/>')) == ["XMI005"]


@pytest.mark.parametrize("text", ["NaN", "Infinity", "-Infinity"])
def test_javas_special_numbers_survive_a_round_trip(lion, zoo, text):
    leo = lion(f'weight="{text}"')
    assert f'weight="{text}"'.encode() in to_xmi([leo._mmrs_container], zoo)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.5, "0.5"),
        (42, "42.0"),
        (-0.0, "-0.0"),
        (1e7, "1.0E7"),
        (9999999.0, "9999999.0"),
        (0.001, "0.001"),
        (0.0001, "1.0E-4"),
        (12345678.9, "1.23456789E7"),
        (5e-324, "4.9E-324"),
        (1.7976931348623157e308, "1.7976931348623157E308"),
    ],
)
def test_real_numbers_are_written_as_java_writes_them(zoo, value, text):
    leo = zoo.create("urn:test:zoo", "Lion", name="L", weight=value)
    assert f'weight="{text}"'.encode() in to_xmi([leo], zoo)


def test_a_date_keeps_its_instant(lion, zoo):
    leo = lion('born="2024-05-01T10:11:12.123+0200"')
    assert leo.born == datetime(2024, 5, 1, 8, 11, 12, 123000, UTC)
    assert b'born="2024-05-01T10:11:12.123+0200"' in to_xmi([leo._mmrs_container], zoo)


def test_a_date_in_another_zone_is_written_with_that_zone(zoo):
    zone = timezone(timedelta(hours=-3, minutes=-30))
    leo = zoo.create("urn:test:zoo", "Lion", name="L", born=datetime(2024, 1, 2, 3, 4, 5, 6000, zone))
    assert b'born="2024-01-02T03:04:05.006-0330"' in to_xmi([leo], zoo)


@pytest.mark.parametrize("text", ["2024-05", "yesterday", "2024-05-01T10:11:12.123 CEST", "12024-01-01"])
def test_no_date_is_a_fault(read_zoo, text):
    assert faults(read_zoo(f'<animals xsi:type="zoo:Lion" name="L" born="{text}"/>')) == ["XMI005"]


def test_the_rarer_types_are_read(lion):
    leo = lion('chip="0aFF" cage="-128" steps="9223372036854775807" grade="x" price="1.50" shade="#fff"')
    values = (leo.chip, leo.cage, leo.steps, leo.grade, leo.price, leo.shade)
    assert values == (b"\x0a\xff", -128, 2**63 - 1, "x", Decimal("1.50"), "#fff")


@pytest.mark.parametrize("text", ['cage="128"', 'chip="0a ff"', 'chip="zz"', 'grade="xy"', 'price="dear"'])
def test_wrong_values_of_the_rarer_types_are_faults(read_zoo, text):
    assert faults(read_zoo(f'<animals xsi:type="zoo:Lion" name="L" {text}/>')) == ["XMI005"]


def test_an_unsettable_value_equal_to_its_default_stays_set(lion, zoo):
    leo = lion('age="0" teeth="30"')
    text = to_xmi([leo._mmrs_container], zoo)
    assert b'age="0"' in text
    assert b"teeth" not in text


def test_nil_is_not_the_default(lion, zoo):
    leo = lion("", '<motto xsi:nil="true"/>')
    assert leo.motto is None
    assert b'<motto xsi:nil="true"/>' in to_xmi([leo._mmrs_container], zoo)


def test_nil_is_a_fault_for_a_number(read_zoo):
    model = read_zoo('<animals xsi:type="zoo:Lion" name="L"><teeth xsi:nil="true"/></animals>')
    assert faults(model) == ["XMI005"]


def test_a_derived_value_is_kept_and_a_transient_one_is_not(zoo):
    leo = zoo.create("urn:test:zoo", "Lion", name="L", rank=3, guess=4)
    text = to_xmi([leo], zoo)
    assert b'rank="3"' in text
    assert b"guess" not in text


def test_many_values_are_read_from_elements_and_from_an_attribute(lion):
    assert lion("", "<tags>a b</tags><tags/><tags>c</tags>").tags == ["a b", "", "c"]
    assert lion('weights="1.0  2.0"').weights == [1.0, 2.0]
    assert lion('moods="is-calm ANGRY"').moods == ["CALM", "ANGRY"]


def test_many_values_are_written_as_elements(zoo):
    leo = zoo.create("urn:test:zoo", "Lion", name="L", moods=["ANGRY"], tags=["a & <b>", "c d"])
    assert b"""
  <moods>ANGRY</moods>
  <tags>a &amp; &lt;b></tags>
  <tags>c d</tags>
""" in to_xmi([leo], zoo)


def test_repeated_values_are_kept_as_read(lion):
    assert lion("", "<tags>a</tags><tags>a</tags>").tags == ["a", "a"]
