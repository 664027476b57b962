import pytest

from mmrs_core.languages.values.codecs import parse_base64, parse_bytes, parse_schema_bytes
from mmrs_core.languages.values.texts import (
    described,
    doubt_of_class,
    parse_class_name,
    render_character,
    render_collapsed,
    shown,
    words_of,
)


@pytest.mark.parametrize("text", ["a\u00a0b", "a\tb", "a\nb", "a\u2028b", "a\u3000b", "\x85"])
def test_only_a_blank_parts_the_values_of_a_list(text):
    assert words_of(f" {text}  c ") == [text, "c"]


@pytest.mark.parametrize(
    "name", ["int", "java.lang.String", "java.util.Map$Entry", "[Ljava.lang.String;", "[[I", "void"]
)
def test_javas_own_classes_are_beyond_doubt(name):
    assert doubt_of_class(parse_class_name(name)) == ""


@pytest.mark.parametrize("name", ["no.such.Class", "String", "org.eclipse.emf.ecore.EObject", "[Lno.Such;"])
def test_of_any_other_class_nobody_here_knows_whether_eclipse_has_it(name):
    assert "only where a plug-in brings that class" in doubt_of_class(parse_class_name(name))


@pytest.mark.parametrize("text", ["", "no class", "byte[]", "a..b", "1a", "[Q", "[La.b"])
def test_what_can_be_no_class_is_refused(text):
    with pytest.raises(ValueError, match="not the name of a class"):
        parse_class_name(text)


@pytest.mark.parametrize("text", ["", "ab", "😀"])
def test_a_character_has_sixteen_bits(text):
    with pytest.raises(ValueError, match="not one character of 16 bits"):
        render_character(text)


@pytest.mark.parametrize("text", [" a", "a  b", "a\tb", "a\n"])
def test_blanks_that_a_type_does_not_keep_are_never_written(text):
    with pytest.raises(ValueError, match="holds blanks that its type does not keep"):
        render_collapsed(text)


def test_a_last_hexadecimal_digit_without_partner_is_a_byte_for_ecore_only():
    assert parse_bytes("0aF") == b"\x0a\x0f"
    with pytest.raises(ValueError, match="an odd number of hexadecimal digits"):
        parse_schema_bytes("0aF")


def test_bits_that_belong_to_no_byte_are_refused_in_base_64():
    with pytest.raises(ValueError, match="bits behind the last byte in base 64"):
        parse_base64("Cv9=")


def test_messages_quote_long_values_in_part():
    assert shown("x" * 61) == repr("x" * 57) + "..."
    assert described("x" * 100) == "'" + "x" * 76 + "..."
    assert described(10**5000) == "a number of several thousand digits"
