"""The page of the documentation that says what each target can express."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby

from mmrs_core.cli.generate import is_policy, policy_lines
from mmrs_core.generation.capabilities.judging import VERDICTS, TargetCapability

_PREFACE = """\
# {title}

What `mmrs-gen` can write of a behaviour, element by element. This page is generated: each line comes
from a minimal behaviour that was tried, with the element and without. `mmrs-gen --capabilities` prints it for
the targets that are installed, those of plug-ins included; `mmrs-gen --capabilities wpl --json` for programs.

| verdict | meaning |
|---|---|
"""


def page_of(
    title: str, tables: Mapping[str, Sequence[TargetCapability]], descriptions: Mapping[str, str]
) -> str:
    """Return the page in Markdown: a section for each target, in the order of the tables."""
    verdicts = "".join(f"| {verdict} | {meaning} |\n" for verdict, meaning in VERDICTS.items())
    sections = (f"\n## {name}\n\n{descriptions[name]}\n{_section(rows)}" for name, rows in tables.items())
    return _PREFACE.format(title=title) + verdicts + "".join(sections)


def _section(rows: Sequence[TargetCapability]) -> str:
    plain = sorted((row for row in rows if not is_policy(row)), key=lambda row: _order(row, rows))
    tables = (
        _table(group, ((row.element, row.verdict, row.how) for row in some))
        for group, some in groupby(plain, key=lambda row: row.group)
    )
    policies = [row for row in rows if is_policy(row)]
    return "".join(tables) + _table("policy", policy_lines(policies), "responses")


def _order(row: TargetCapability, rows: Sequence[TargetCapability]) -> int:
    return next(index for index, each in enumerate(rows) if each.group == row.group)


def _table(group: str, rows: Iterable[tuple[str, str, str]], last: str = "how, or why not") -> str:
    return f"\n| {group} | verdict | {last} |\n|---|---|---|\n" + "".join(_lines(rows))


def _lines(rows: Iterable[tuple[str, str, str]]) -> Iterator[str]:
    for cells in rows:
        yield f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |\n"
