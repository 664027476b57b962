"""Which example uses which metaclass: a table, kept current in the examples' README."""

from __future__ import annotations

import pytest

from mmrs_core.languages.element import descendants, metaclass_of

pytestmark = pytest.mark.together("examples")

BEGIN, END = "<!-- metaclasses: begin -->\n", "<!-- metaclasses: end -->\n"
MISSIONS = (
    "carbon-dioxide",
    "pool",
    "mixed-team",
    "solar-park",
    "drone-and-rover",
    "outfall",
    "pool-course",
    "two-auv-survey",
    "lost-float",
    "barn",
    "ridge",
)
LANGUAGES = (
    "urn:mmrs:mission:1.0",
    "urn:mmrs:context:1.0",
    "urn:mmrs:robot:1.0",
    "urn:mmrs:behaviour:1.0",
    "urn:mmrs:multicopter:1.0",
    "urn:mmrs:auv:1.1",
    "urn:mmrs:auv-tasks:1.0",
    "urn:mmrs:rover:1.0",
    "urn:mmrs:survey:1.0",
    "urn:mmrs:solar:1.0",
)


def used_by(roots, abstract):
    """Return the metaclasses of all elements of the roots, and the abstract ones that these specialise."""
    elements = [element for root in roots for element in (root, *descendants(root))]
    direct = {metaclass_of(element).key for element in elements}
    inherited = {name for element in elements for name in metaclass_of(element).ancestry}
    return direct | (inherited & abstract)


@pytest.fixture(scope="module")
def uses(taken, read, folder_of, metaclasses):
    """Return the metaclasses that each example uses, in its files and in what is derived from them."""
    abstract = {metaclass.key for metaclass in metaclasses if metaclass.abstract}
    roots = {name: [*read(folder_of(name)), taken(name).behaviour] for name in MISSIONS}
    roots["handwritten"] = read(folder_of("handwritten"))
    return {name: used_by(found, abstract) for name, found in roots.items()}


@pytest.fixture(scope="module")
def metaclasses(contributions):
    """Return every metaclass of the languages."""
    packages = {package.ns_uri: package for package in contributions.languages.packages}
    return [metaclass for uri in LANGUAGES for metaclass in packages[uri].metaclasses]


def table(uses, metaclasses):
    """Return the table as Markdown."""
    lines = [f"| language | metaclass | {' | '.join(uses)} |", f"|---|---|{':-:|' * len(uses)}"]
    for metaclass in metaclasses:
        language = metaclass.ns_uri.split(":")[2]
        name = f"*{metaclass.name}*" if metaclass.abstract else metaclass.name
        marks = ["x" if metaclass.key in found else "" for found in uses.values()]
        lines.append(f"| {language} | {name} | {' | '.join(marks)} |")
    return "\n".join(lines) + "\n"


def test_no_metaclass_of_the_languages_is_unused_by_all_examples(uses, metaclasses):
    unused = [each.key for each in metaclasses if not any(each.key in found for found in uses.values())]
    assert unused == []


def test_the_table_in_the_readme_is_current(uses, metaclasses, folder_of, update_golden):
    readme = folder_of("README.md")
    before, rest = readme.read_text(encoding="utf-8").split(BEGIN)
    shown, after = rest.split(END)
    if update_golden:
        readme.write_text(before + BEGIN + table(uses, metaclasses) + END + after, encoding="utf-8")
        return
    assert shown == table(uses, metaclasses)
