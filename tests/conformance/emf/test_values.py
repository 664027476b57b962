"""Texts of values, as EMF reads them and as we do."""

from datetime import UTC, datetime
from decimal import Decimal
from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest
from emf_description import model_lines

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, registry_with
from mmrs_core.languages.writing import write_model

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]

ECORE = Path(__file__).parents[2] / "fixtures" / "models" / "values.ecore"
NAMES = (
    ' xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:v="urn:test:values" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
)

READ = {
    "EBoolean": ["TRUE", "tRue", "false"],
    "EByte": ["+127", "-128"],
    "EInt": ["+5", "-0", "007", "-2147483648", "00000000000000000000000000000005", "٣", "-００５"],
    "ELong": ["+00000000000000000000000000009223372036854775807"],
    "EBigInteger": ["+5", "9" * 5000, f"-{'7' * 20000}", "0" * 5000 + "1", "٣"],
    "EDouble": [
        "0x1p3", "0X1.8P-2d", "-0x.8p1F", "0x1.p1", "0xap0", "0x1p99999999999", "0x0p99999999999",
        "-0x1p-99999999999", "0x1.00000000000008p0", "0x1.00000000000008000001p0", "0x0.0000000000001p-1022",
        "1f", "1D", "1e5f", ".5", "5.", " 5.0 ", "5.0\t", "1e400", "-1e400", "1e-400", "-0", "NaN", "-NaN",
        "+Infinity", "1e0000000000000000000005", "0.1000000000000000055511151231257827", "9" * 5000,
    ],
    "EFloat": ["0.1", "16777217", "0x1p3", "1e39", "-1e39", "3.4028235E38", "3.4028236e38", "0x1p128", "NaN"],
    "EBigDecimal": [
        "1E3", "1E+400000", "1e-5", ".5", "5.", "+1", "1E2147483647", "1E-2147483647",
        "1E00000000000000000005", "0E-10", "0E5", "-0", "٣", "1E٣", "0.00000001", "1" * 5000,
    ],
    "EChar": ["x", "65", "6", "+5", "005", "٣"],
    "EByteArray": ["0AFF", "0aF", "a", ""],
    "EJavaObject": ["ACED0005740001" + "78", "aced000574000178"],
    "EJavaClass": ["java.lang.String", "int", "[B", "[Ljava.lang.String;", "java.util.Map$Entry"],
    "Boolean": ["1", " 1 ", "0", "true\t", "false"],
    "Int": ["+5", " 5 ", "++5", "+-5"],
    "Integer": ["+5", " 5 ", "\n5", "٣"],
    "UnsignedByte": ["255", "256", "-1", " +7"],
    "Decimal": ["1E5", " 0.10 ", "1E400", "1E-400", "1E999999999", "1E-999999999", "+1", "-0"],
    "Double": ["INF", "+INF", "-INF", " INF ", "Infinity", " 5 ", "0x1p3", "1f", "NaN"],
    "Float": ["INF", "1e39", " 5 "],
    "HexBinary": ["0a", " 0aFF ", ""],
    "Base64Binary": ["Cv8=", "C v 8=", " Cv8=\n", "", "AAAA AAAA"],
    "QName": ["b", " b ", ":b"],
    "NOTATION": [" b "],
    "Token": ["  a  b ", "a\tb", "a\u00a0\u00a0b", "", "a\u2028 b"],
    "NMTOKEN": [" a ", "a b"],
    "NMTOKENS": ["a b", " a ", ""],
    "NCName": [" a ", "a:b"],
    "ID": [" a b "],
    "IDREFS": [" a  b"],
    "Language": [" en "],
    "NormalizedString": [" a b "],
    "AnyURI": [" a b "],
    "AnySimpleType": [" x "],
    "manyEString": [
        "a b", "a\u00a0b", "a\tb", "a\nb", " a ", "\u00a0", "\u3000x", "a\u2028b", "\x85", "a  b",
        "",
    ],
    "manyEInt": ["1 2", " 1  2 "],
    "manyEBigDecimal": ["1 1.0 1.00"],
    "bytesByDefault": ["0AFF", "0A", ""],
}  # fmt: skip
"""By attribute, what EMF and we read as the same value, and what we write of it EMF finds equal."""

REFUSED = {
    "EBoolean": [" true", "1", "", "yes"],
    "EByte": ["0x1", "128"],
    "EInt": ["2147483648", "1_000", "0x10", "", "5 ", "-", "+", "+-5", "𝟛", "\u00a05"],
    "ELong": ["9223372036854775808", "5L"],
    "EBigInteger": ["+-5", "", "𝟛", "1 "],
    "EDouble": [
        "1_000", "infinity", "INF", "\u00a05.0", "٣", "1e", "", "0x1", "0x.p1", "NaNd", "\x855",
        "nan",
    ],
    "EBigDecimal": [
        "1E99999999999999999999", "1E2147483648", "1E-2147483648", "0.1E-2147483647", "NaN", ".E1", ".", " 1",
        "1d", "𝟛",
    ],
    "EChar": [""],
    "EByteArray": ["0a FF", "zz", "0a F", "٣٣"],
    "EDate": ["2024-05", "2024", "", "x2024-05-01", "\u00a02024-05-01", "yesterday"],
    "EJavaObject": ["x", "", "rO0ABXQAAXg="],
    "EJavaClass": ["", "byte[]", "java.lang.Object[]"],
    "Boolean": ["TRUE", "True", "", "yes", "\u00a01"],
    "Integer": ["5.0", "", "+ 5"],
    "UnsignedByte": ["40000"],
    "Decimal": ["++1", "1E2147483648", "INF"],
    "Double": ["inf", "nan", "\u00a05"],
    "HexBinary": ["0aF", "0a FF", "0g"],
    "Base64Binary": ["Cv8", "Cv9=", "C\u00a0v8=", "=", "AAAAA==="],
    "QName": ["a b", "a:b:c", "", "-", ".7", "1a", "a:1"],
    "manyEInt": ["1\t2", "1\u00a02", "1 x"],
}  # fmt: skip
"""By attribute, what is no value for EMF and for us."""

CUT = {
    "EChar": ["ab", "𝟛", "70000", "-1", "😀", "99999999999"],
    "EDate": [
        "12024-01-01T00:00:00.000+0000",
        "-0044-03-15T00:00:00.000+0000",
        "0099-01-01T00:00:00.000+0000",
        "24-05-01T00:00:00.000+0000",
        "1500-02-29T00:00:00.000+0000",
        "1581-30-01T00:00:00.000+0000",
        "1582-10-04T00:00:00.000+0000",
        "1582-10-14T23:59:59.999+0000",
        "2024-05-01T10:11:12.123 PST",
    ],
}
"""What EMF takes, changed beyond recognition, beyond what Python can hold, or counted in the Julian calendar;
we say so, and refuse it."""


def cases(texts):
    return [
        pytest.param(name, text, id=f"{name}-{number}")
        for name in texts
        for number, text in enumerate(texts[name])
    ]


@pytest.fixture(scope="module")
def known(referee):
    """Return the referee while it knows the metamodel of values."""
    with referee.knowing(ECORE) as told:
        assert [
            fault for fault in told.faults if "dotted.parts" not in fault and "EJavaClass" not in fault
        ] == []
        yield referee


@pytest.fixture(scope="module")
def values():
    """Return the registry that knows it."""
    return registry_with([MetamodelSource("urn:test:values", ECORE, "values")])


def written(file, attribute, text):
    """Write a model with a text in an attribute, every character of it escaped that XML would change."""
    quoted = quoteattr(text, {"\t": "&#9;", "\n": "&#10;", "\r": "&#13;"})
    file.write_text(f"<v:Value{NAMES} {attribute}={quoted}/>", encoding="utf-8")
    return file


def read(file, values):
    model = read_model(file, values)
    assert model.diagnostics == ()
    return model


def theirs(referee, file):
    answer = referee.ask("dump", file)
    assert answer.faults == []
    return list(answer.lines[1:])


@pytest.mark.parametrize(("attribute", "text"), cases(READ))
def test_emf_and_we_read_the_same_value_and_ours_is_equal_when_written(
    known, values, tmp_path, attribute, text
):
    file = written(tmp_path / "case.xmi", attribute, text)
    model = read(file, values)
    assert list(model_lines(model.roots, "case.xmi")) == theirs(known, file)
    write_model(model.roots, tmp_path / "ours.xmi", values)
    assert "EQUAL" in known.ask("equal", file, tmp_path / "ours.xmi").lines


@pytest.mark.parametrize(("attribute", "text"), cases(READ))
def test_a_value_comes_back_from_our_json_form_as_emf_read_it(known, values, tmp_path, attribute, text):
    file = written(tmp_path / "case.xmi", attribute, text)
    write_model(read(file, values).roots, tmp_path / "case.json", values)
    write_model(read(tmp_path / "case.json", values).roots, tmp_path / "ours.xmi", values)
    assert "EQUAL" in known.ask("equal", file, tmp_path / "ours.xmi").lines


@pytest.mark.parametrize(("attribute", "text"), cases(REFUSED))
def test_emf_and_we_refuse_the_same_texts(known, values, tmp_path, attribute, text):
    file = written(tmp_path / "case.xmi", attribute, text)
    assert {fault.code for fault in read_model(file, values).diagnostics} == {"XMI005"}
    assert known.ask("dump", file).faults != []


@pytest.mark.parametrize(("attribute", "text"), cases(CUT))
def test_what_emf_takes_otherwise_without_a_word_we_refuse(known, values, tmp_path, attribute, text):
    file = written(tmp_path / "case.xmi", attribute, text)
    assert [fault.code for fault in read_model(file, values).diagnostics] == ["XMI005"]
    assert known.ask("dump", file).faults == []


UNREADABLE = {
    "EInt": (2**40, "1099511627776"),
    "EByte": (300, "300"),
    "EShort": (-40000, "-40000"),
    "ELong": (2**63, "9223372036854775808"),
    "EFloat": (1e39, "1.0E39"),
    "EDouble": (10**400, f"1{'0' * 400}"),
    "EBigDecimal": (Decimal("NaN"), "NaN"),
    "EChar": ("ab", "ab"),
    "ECharacterObject": ("", ""),
    "EDate": (datetime(2024, 5, 1, microsecond=123456, tzinfo=UTC), "2024-05-01T00:00:00.123456+0000"),
    "EJavaObject": ("x", "x"),
    "EJavaClass": ("no class", "no class"),
    "UnsignedByte": (40000, "40000"),
    "Decimal": (Decimal("Infinity"), "Infinity"),
    "Token": (" a  b ", " a  b "),
    "QName": ("a b", "a b"),
}
"""By attribute, a value that no file can hold, and what a careless writer would write of it."""


@pytest.mark.parametrize("attribute", UNREADABLE)
def test_what_emf_could_not_read_again_is_told_and_never_written(known, values, tmp_path, attribute):
    value, careless = UNREADABLE[attribute]
    root = values.create("urn:test:values", "Value")
    setattr(root, attribute, value)
    found = check_conformance(Model(tmp_path / "case.xmi", (root,)), values)
    assert [(fault.code, fault.place.path) for fault in found] == [("ECO003", "/")]
    for name in ("ours.xmi", "ours.json"):
        with pytest.raises(ValueError, match=f"^/: {attribute}: "):
            write_model([root], tmp_path / name, values)
    assert list(tmp_path.iterdir()) == []
    assert not survives(known, written(tmp_path / "careless.xmi", attribute, careless), careless)


def survives(referee, file, text):
    """Return whether EMF reads a file without a word and writes the text that it read."""
    out = file.with_suffix(".out")
    return not referee.ask("save", file, out).faults and f'"{text}"' in out.read_text(encoding="utf-8")


LINKS = {
    "an identifier with a no-break space": 'some="x\u00a0y"><parts identifier="x\u00a0y"/>',
    "references apart by tab and line feed": 'some="//@parts.0&#9;//@parts.1&#10;//@parts.2">'
    "<parts/><parts/><parts/>",
    "a feature with a dot in its name": 'one="//@dotted.parts.0"><dotted.parts/>',
    "a reference by idref": '><parts identifier="a"/><one xmi:idref="a"/>',
    "a typed reference by idref": '><one xsi:type="v:Value" xmi:idref="a"/><parts xmi:id="a"/>',
    "references by idref": '><some xmi:idref="b"/><some xmi:idref="a"/>'
    '<parts identifier="a"/><parts identifier="b"/>',
    "a date as an element with blanks": "><EDate> 2024-05-01T10:11:12.123+0200 </EDate>",
    "no values": 'manyEString="">',
}


@pytest.mark.parametrize("title", LINKS)
def test_emf_and_we_read_the_same_from_awkward_texts(known, values, tmp_path, title):
    file = tmp_path / "case.xmi"
    file.write_text(f"<v:Value{NAMES} {LINKS[title]}</v:Value>", encoding="utf-8")
    model = read(file, values)
    assert list(model_lines(model.roots, "case.xmi")) == theirs(known, file)
    write_model(model.roots, tmp_path / "ours.xmi", values)
    assert "EQUAL" in known.ask("equal", file, tmp_path / "ours.xmi").lines


def test_a_query_in_an_href_says_nothing_of_the_file(known, values, tmp_path):
    (tmp_path / "far.xmi").write_text(f'<v:Value{NAMES} identifier="far"/>')
    file = tmp_path / "case.xmi"
    file.write_text(f'<v:Value{NAMES}><one href="far.xmi?x#far"/></v:Value>')
    assert list(model_lines(read(file, values).roots, "case.xmi")) == theirs(known, file)


VERSIONS = [
    "http://schema.omg.org/spec/XMI/2.1",
    "http://schema.omg.org/spec/XMI/2.0",
    "http://www.omg.org/spec/XMI/20110701",
    "http://www.omg.org/spec/XMI/20131001",
]
OTHER_XMI = {
    "one root": '<v:Value {} xmi:id="_1" one="_1"><parts xmi:type="v:Value" xmi:uuid="u"/></v:Value>',
    "several roots": '<xmi:XMI {}><v:Value xmi:id="_1" one="_2"/><v:Value xmi:id="_2" one="_1"/></xmi:XMI>',
    "by idref": '<v:Value {}><one xmi:idref="_1"/><parts xmi:id="_1"/></v:Value>',
}


@pytest.mark.parametrize("title", OTHER_XMI)
@pytest.mark.parametrize("version", VERSIONS, ids=lambda uri: uri.rpartition("/")[2])
def test_emf_and_we_read_the_same_from_other_versions_of_xmi(known, values, tmp_path, version, title):
    file = tmp_path / "case.xmi"
    head = f'xmi:version="2.1" xmlns:xmi="{version}" xmlns:v="urn:test:values"'
    file.write_text(OTHER_XMI[title].replace("{}", head))
    model = read(file, values)
    assert list(model_lines(model.roots, "case.xmi")) == theirs(known, file)
    write_model(model.roots, tmp_path / "ours.xmi", values)
    assert b'xmlns:xmi="http://www.omg.org/XMI"' in (tmp_path / "ours.xmi").read_bytes()
    assert "EQUAL" in known.ask("equal", file, tmp_path / "ours.xmi").lines


@pytest.mark.parametrize("text", ["2024-05-01", "2024-05-01T00:00:00.000+0000", "2024-05-02"])
def test_a_date_is_left_out_only_where_emf_finds_it_the_default_in_any_zone(
    known, elsewhere, values, tmp_path, text
):
    file = written(tmp_path / "case.xmi", "dateByDefault", text)
    write_model(read(file, values).roots, tmp_path / "ours.xmi", values)
    with elsewhere.knowing(ECORE):
        for each in (known, elsewhere):
            assert "EQUAL" in each.ask("equal", file, tmp_path / "ours.xmi").lines


def test_emf_loses_characters_of_a_file_that_is_not_ascii_as_it_says_and_we_do_not_read_it(
    known, values, tmp_path
):
    file = tmp_path / "case.xmi"
    file.write_text(f'<?xml version="1.0" encoding="ASCII"?><v:Value{NAMES} EString="ä"/>', encoding="utf-8")
    assert r"VALUE case.xmi#0 EString ['\65533;\65533;']" in known.ask("dump", file).lines
    with pytest.raises(UnreadableError, match="not ASCII, as its first line says; save it as UTF-8"):
        read_model(file, values)
