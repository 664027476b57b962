"""Random texts as values: what EMF reads as which, and what it refuses."""

import re
from collections import Counter
from pathlib import Path
from random import Random
from xml.sax.saxutils import quoteattr

import pytest
from emf_description import model_lines

from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, registry_with

pytestmark = [pytest.mark.together("emf"), pytest.mark.peer]

ECORE = Path(__file__).parents[2] / "fixtures" / "models" / "values.ecore"
HEAD = '<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:v="urn:test:values">\n'
SEED = 20261121
COUNTS = [pytest.param(10), pytest.param(100, marks=pytest.mark.thorough)]
TEXTS_A_FILE = 500
NUMBERS = (
    "EByte",
    "EShort",
    "EInt",
    "ELong",
    "EBigInteger",
    "EDouble",
    "EBigDecimal",
    "EByteArray",
    "EBoolean",
)
SCHEMA = ("Boolean", "Int", "Integer", "UnsignedByte", "Decimal", "Double", "HexBinary", "Base64Binary")
WORDS = (
    "NaN",
    "Infinity",
    "-INF",
    "+INF",
    "true",
    " 1 ",
    "FALSE",
    "0a F",
    "Cv8=",
    "C v9=",
    "٣",
    "\u00a05",
    "",
)
STRICTER = re.compile(r"a zone by name|before 15 October 1582")
"""Of dates, what we refuse and EMF does not."""


def number(random):
    """Return something like a number, in one notation or another."""
    parts = [
        random.choice(["", "", "+", "-", " ", "++"]),
        random.choice(["", "", "", "0x", "0X"]),
        random.choice(["", "0" * 30, "7", "12", "300", "40000", "2147483648", "abc", "9" * 25]),
        random.choice(["", "", ".", ".5", ".25", ".ab"]),
        random.choice(["", "", "e5", "E-7", "e400", "p3", "P-2", "e2147483648", "p99999999999"]),
        random.choice(["", "", "", "f", "D", "L", " ", "\t"]),
    ]
    return random.choice(WORDS) if random.random() < 0.2 else "".join(parts)


def date(random):
    """Return something like a date."""
    blank, figures = random.choice(["", "", "", " ", "\t"]), lambda most: str(random.randrange(most))
    year = random.choice(["2024", "1999", "1583", "1582", figures(9999)])
    day = f"{year}-{figures(14)}-{blank}{figures(33)}"
    clock = f"{random.choice('TTTTt ')}{figures(30)}:{blank}{figures(70)}"
    seconds = f":{figures(70)}{random.choice(['', f'.{figures(10 ** random.randrange(1, 9))}', ',5', '.'])}"
    zone = random.choice(
        ["", "Z", "+0200", "-2359", " +0545", "+02:00", "+2400", "UTC", "gmt", "GMT-7:15", "x"]
    )
    return blank + "".join((day, clock, seconds, zone)[: random.randrange(1, 5)])


def drawn(random):
    """Return an attribute and a text for it."""
    kind = random.randrange(3)
    if kind == 0:
        return "EDate", date(random)
    return random.choice(NUMBERS if kind == 1 else SCHEMA), number(random)


@pytest.fixture(scope="module")
def known(referee):
    with referee.knowing(ECORE):
        yield referee


@pytest.fixture(scope="module")
def values():
    return registry_with([MetamodelSource("urn:test:values", ECORE, "values")])


@pytest.mark.parametrize("count", COUNTS)
def test_emf_and_we_take_random_texts_for_the_same_values_or_refuse_them(
    known, values, tmp_path, tell, count
):
    verdicts = Counter()
    for turn in range(count):
        random = Random(SEED + turn)
        texts = [drawn(random) for _ in range(TEXTS_A_FILE)]
        file = tmp_path / "texts.xmi"
        file.write_text(HEAD + "".join(map(element, texts)) + "</xmi:XMI>\n", encoding="utf-8")
        model = read_model(file, values)
        stricter = {fault.place.line for fault in model.diagnostics if STRICTER.search(fault.message)}
        ours = {fault.place.line for fault in model.diagnostics} - stricter
        answer = known.ask("dump", file)
        theirs = {int(fault.split(": ")[1]) for fault in answer.faults}
        assert [texts[line - 2] for line in sorted(ours ^ theirs)] == []
        left_out = {f"texts.xmi#{line - 2}" for line in stricter}
        found = [line for line in model_lines(model.roots, "texts.xmi") if line.startswith("VALUE")]
        wanted = [
            line for line in answer.lines if line.startswith("VALUE") and line.split()[1] not in left_out
        ]
        assert found == wanted
        verdicts.update(read=len(found), refused=len(theirs), stricter=len(stricter))
    assert min(verdicts["read"], verdicts["refused"]) > count * TEXTS_A_FILE // 5
    tell(
        f"both: {verdicts['read']} random texts read as the same values by EMF and by us, "
        f"{verdicts['refused']} refused by both, {verdicts['stricter']} dates refused by us alone "
        f"(seeds {SEED} to {SEED + count - 1})"
    )


def element(drawn):
    attribute, text = drawn
    quoted = quoteattr(text, {"\t": "&#9;"})
    return f"<v:Value {attribute}={quoted}/>\n"
