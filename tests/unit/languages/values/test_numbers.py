import time
from decimal import Decimal
from math import inf

import pytest

from mmrs_core.languages.values import exact, real

render_long = exact.writer(None)


@pytest.mark.parametrize("digits", [1, 25, 4300, 4301, 5000, 99_999, 100_000])
@pytest.mark.parametrize("sign", ["", "-"])
def test_a_whole_number_of_any_length_comes_back_from_its_text(digits, sign):
    text = f"{sign}{'7' * digits}"
    assert render_long(exact.parse_whole(text, None)) == text


def test_a_whole_number_of_many_digits_is_one_like_any_other():
    number = exact.parse_whole("1" + "0" * 5000, None)
    assert number == 10**5000
    assert str(number) == repr(number) == f"{number}" == "1" + "0" * 5000


@pytest.mark.parametrize("digits", [100_001, 1_000_000, 10_000_000])
def test_a_whole_number_that_would_take_long_to_read_is_refused_at_once(digits):
    begin = time.process_time()
    with pytest.raises(ValueError, match="more than 100000 digits"):
        exact.parse_whole("9" * digits, None)
    assert time.process_time() - begin < 2


def test_a_whole_number_that_would_take_long_to_write_is_refused_at_once():
    with pytest.raises(ValueError, match="a whole number of 3321929 bits: more than 100000 digits"):
        render_long(10**1_000_000)
    with pytest.raises(ValueError, match="more than 100000 digits"):
        render_long(10**100_000)


def test_zeros_before_a_number_do_not_count():
    assert exact.parse_whole("-" + "0" * 1_000_000 + "5", 8) == -5


@pytest.mark.parametrize(
    ("bits", "value"),
    [(8, 128), (16, -32769), (32, 2**31), (64, 2**63), pytest.param(32, 10**5000, id="large")],
)
def test_a_whole_number_that_does_not_fit_is_never_written(bits, value):
    with pytest.raises(ValueError, match=f"does not fit into {bits} bits"):
        exact.writer(bits)(value)


@pytest.mark.parametrize(
    "text", ["1E2147483648", "1E-2147483648", "0.1E-2147483647", "1E99999999999999999999"]
)
def test_a_power_of_ten_beyond_javas_is_refused(text):
    with pytest.raises(ValueError, match="the power of ten does not fit into 32 bits"):
        exact.parse_decimal(text)


@pytest.mark.parametrize(
    "value", [Decimal("1E2147483648"), Decimal("1.5E2147483648"), Decimal("1E-2147483649")]
)
def test_a_power_of_ten_beyond_javas_is_never_written(value):
    with pytest.raises(ValueError, match="the power of ten does not fit into 32 bits"):
        exact.render_decimal(value)


@pytest.mark.parametrize("value", [Decimal("NaN"), Decimal("Infinity"), Decimal("sNaN")])
def test_a_decimal_number_that_is_not_finite_is_never_written(value):
    with pytest.raises(ValueError, match="not a finite number"):
        exact.render_decimal(value)


@pytest.mark.parametrize(
    ("text", "written"),
    [("0.10", "0.10"), ("1E5", "1E+5"), ("1E-9", "0.000000001"), ("12.5e3", "1.25E+4"), ("-0.5", "-0.5")],
)
def test_a_decimal_number_of_xml_schema_is_written_plainly_unless_its_scale_would_be_lost(text, written):
    assert exact.render_schema_decimal(exact.parse_schema_decimal(text)) == written


@pytest.mark.parametrize("text", ["1E999999999", "1E-999999999", "1E+2147483647"])
def test_a_decimal_number_of_a_huge_power_stays_short(text):
    assert len(exact.render_schema_decimal(exact.parse_schema_decimal(text))) < 20


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0x1p3", 8.0),
        ("-0X1.8P-2d", -0.375),
        ("0x.8p1", 1.0),
        ("0x1.p1F", 2.0),
        ("0x1p99999999999", inf),
        ("-0x1p99999999999", -inf),
        ("0x0p99999999999", 0.0),
        ("\x015.0\x1f", 5.0),
    ],
)
def test_javas_powers_of_two_and_blanks_are_read(text, value):
    assert real.parse_real(text) == value


@pytest.mark.parametrize(("text", "value"), [("1e39", inf), ("-1e39", -inf), ("3.4028235E38", 3.4028235e38)])
def test_a_number_beyond_32_bits_is_infinite_as_for_emf(text, value):
    assert real.parse_single(text) == value


@pytest.mark.parametrize("value", [1e39, -3.5e38])
def test_a_number_beyond_32_bits_is_never_written(value):
    with pytest.raises(ValueError, match="too large for a real number of 32 bits"):
        real.render_single(value)


@pytest.mark.parametrize("value", [2**70 + 1, 10**400, -(10**400)])
def test_a_whole_number_that_no_real_one_equals_is_never_written_as_one(value):
    with pytest.raises(ValueError, match=r"no real number of 64 bits equals it|too large for a real number"):
        real.render_real(value)


@pytest.mark.parametrize("hostile", ["0" * 100_000 + "!", "1e" + "0" * 100_000 + "!"])
@pytest.mark.parametrize("read", [real.parse_real, exact.parse_decimal])
def test_long_digits_before_a_foreign_sign_are_refused(read, hostile):
    with pytest.raises(ValueError, match="not a"):
        read(hostile)
