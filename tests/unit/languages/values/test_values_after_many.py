"""An odd value after many usual ones, when reader and writers have compiled functions for it."""

from datetime import UTC, datetime
from itertools import product

import pytest

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_json, to_xmi

MANY = 40
USUAL = {
    "weight": "1.5",
    "speed": "2.5",
    "teeth": "3",
    "cage": "4",
    "grade": "x",
    "chip": "0AFF",
    "born": "2024-05-01T10:11:12.123+0200",
}


def lion(**values):
    said = "".join(f' {name}="{text}"' for name, text in (USUAL | values).items())
    return f'<animals xsi:type="zoo:Lion" name="leo"{said}/>'


@pytest.mark.parametrize(
    ("attribute", "text", "value"),
    [
        ("weight", "0x1p3", 8.0),
        ("weight", " 5.0 ", 5.0),
        ("weight", "1e39", 1e39),
        ("speed", "0x1p3", 8.0),
        ("speed", "1e39", float("inf")),
        ("speed", "-1e39", float("-inf")),
        ("teeth", "00000000000000000000000000000005", 5),
        ("chip", "0aF", b"\x0a\x0f"),
        ("born", "1582-10-14T24:00:00.000+0000", datetime(1582, 10, 15, tzinfo=UTC)),
    ],
)
def test_it_is_read_as_if_it_were_alone(zoo, zoo_text, attribute, text, value):
    model = read_text(zoo_text(lion() * MANY + lion(**{attribute: text})), "a.xmi", zoo)
    assert model.diagnostics == ()
    assert getattr(model.roots[0].animals[-1], attribute) == value


@pytest.mark.parametrize(
    ("attribute", "text"),
    [
        *product(("weight", "speed"), ("\u00a05.0", "1_0.5", "0x1", "nan")),
        ("born", "1500-02-29T00:00:00.000+0000"),
    ],
)
def test_it_is_refused_as_if_it_were_alone(zoo, zoo_text, attribute, text):
    model = read_text(zoo_text(lion() * MANY + lion(**{attribute: text})), "a.xmi", zoo)
    assert [(fault.code, fault.place.path) for fault in model.diagnostics] == [
        ("XMI005", f"/animals[{MANY}]")
    ]


UNWRITABLE = {
    "speed": 1e39,
    "weight": 10**400,
    "teeth": 2**31,
    "cage": -129,
    "grade": "ab",
    "born": datetime(2024, 5, 1, microsecond=1, tzinfo=UTC),
}


@pytest.mark.parametrize("attribute", UNWRITABLE)
@pytest.mark.parametrize("write", [to_xmi, to_json])
def test_it_is_never_written_if_no_file_could_hold_it(zoo, zoo_text, attribute, write):
    model = read_text(zoo_text(lion() * (MANY + 1)), "a.xmi", zoo)
    setattr(model.roots[0].animals[MANY], attribute, UNWRITABLE[attribute])
    with pytest.raises(ValueError, match=rf"^/animals\[{MANY}\]: {attribute}: "):
        write(model.roots, zoo)


@pytest.mark.parametrize("attribute", UNWRITABLE)
def test_it_is_told_with_its_place_if_no_file_could_hold_it(zoo, zoo_text, attribute):
    model = read_text(zoo_text(lion() * (MANY + 1)), "a.xmi", zoo)
    setattr(model.roots[0].animals[MANY], attribute, UNWRITABLE[attribute])
    found = check_conformance(Model(None, model.roots), zoo)
    assert [(fault.code, fault.place.path) for fault in found] == [("ECO003", f"/animals[{MANY}]")]


def test_a_date_of_doubt_is_told_with_its_place(zoo, zoo_text):
    model = read_text(zoo_text(lion() * MANY + lion(born="2024-05-01")), "a.xmi", zoo)
    (found,) = check_conformance(model, zoo)
    assert (found.code, found.severity.value, found.place.path) == ("ECO014", "warning", f"/animals[{MANY}]")
    assert found.message == (
        "Lion 'leo': born: '2024-05-01' is read as 2024-05-01T00:00:00.000+0000, "
        "and by Eclipse in the time zone of its machine"
    )
    assert found.hint == "write 2024-05-01T00:00:00.000+0000"
