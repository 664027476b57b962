"""Which example uses which metaclass: a table, kept current in the examples' README."""

import pytest

from mmrs_core.languages.element import descendants, metaclass_of

pytestmark = pytest.mark.together("examples")

BEGIN, END = "<!-- metaclasses: begin -->\n", "<!-- metaclasses: end -->\n"


def used_by(roots, abstract):
    """Return the metaclasses of all elements of the roots, and the abstract ones that these specialise."""
    elements = [element for root in roots for element in (root, *descendants(root))]
    direct = {metaclass_of(element).key for element in elements}
    inherited = {name for element in elements for name in metaclass_of(element).ancestry}
    return direct | (inherited & abstract)


@pytest.fixture(scope="module")
def uses(missions, taken, read, folder_of, metaclasses):
    """Return the metaclasses that each example uses, in its files and in what is derived from them."""
    abstract = {metaclass.key for metaclass in metaclasses if metaclass.abstract}
    roots = {name: [*read(folder_of(name)), taken(name).behaviour] for name in missions}
    roots["handwritten"] = read(folder_of("handwritten"))
    return {name: used_by(found, abstract) for name, found in roots.items()}


@pytest.fixture(scope="module")
def metaclasses(contributions):
    """Return every metaclass of the languages."""
    packages = contributions.languages.packages
    ours = [package for package in packages if package.ns_uri.startswith("urn:mmrs:")]
    return [metaclass for package in ours for metaclass in package.metaclasses]


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
