"""What XMI has and JSON has not: identifiers, and text between elements."""

import re
from itertools import count

import pytest

from mmrs_core.languages.writing import to_xmi

TAGS = 12
"""Of so many in the fixture, spread over it, each with a text behind it."""


@pytest.fixture(scope="module")
def round_xmi(flyaq):
    return (flyaq / "round.xmi").read_text()


def test_references_by_identifier_lead_where_paths_lead(migrated, written, registry, flyaq, round_xmi):
    before, *own = re.split(r"(?=<drones )", round_xmi)
    for drone, text in enumerate(own):
        numbers = count()
        text = re.sub(
            r"<movements ", lambda _, n=numbers, d=drone: f'<movements xmi:id="m{d}-{next(n)}" ', text
        )
        own[drone] = text
    text = re.sub(r"//@drones\.(\d)/@movements\.(\d+)", r"m\1-\2", "".join([before, *own]))
    assert "@movements" not in text
    by_path = migrated(flyaq / "round.xmi", flyaq / "Heron.xmi")
    by_id = migrated(written("round.xmi", text), flyaq / "Heron.xmi")
    models = [[to_xmi((each.element,), registry) for each in found.outputs] for found in (by_path, by_id)]
    assert models[0] == models[1]


def test_an_identifier_that_nothing_has_leads_nowhere_and_is_told(migrated, told, written, round_xmi):
    text = round_xmi.replace('from="//@drones.0/@movements.0"', 'from="nobody"', 1)
    assert told(migrated(written("round.xmi", text)), "leads to nothing in this file: from nobody")


@pytest.mark.parametrize("share", range(TAGS))
def test_text_between_elements_is_told(migrated, told, written, round_xmi, share):
    ends = [match.end() for match in re.finditer(r"<[^?].*?>", round_xmi)][:-1]
    place = ends[len(ends) * share // TAGS]
    migration = migrated(written("round.xmi", f"{round_xmi[:place]}lost words{round_xmi[place:]}"))
    assert told(migration, "lost words")


def test_an_attribute_of_a_foreign_namespace_is_told(migrated, told, written, round_xmi):
    text = round_xmi.replace("<movements ", '<movements xmlns:o="urn:other" o:colour="red" ', 1)
    assert told(migrated(written("round.xmi", text)), "colour red")
