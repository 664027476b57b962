"""What a migration tells people: what each file was, what was written, and what is not just as it was."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from mmrs_core.cli.output import counted
from mmrs_flyaq.command.verdicts import Verdict
from mmrs_flyaq.findings import Category, Finding, grouped
from mmrs_flyaq.migrate import Migration

_WORDS = {
    Category.LOST: "not carried over",
    Category.DOUBTFUL: "doubtful: look at it",
    Category.CHANGED: "changed in meaning or unit",
    Category.DEFAULTED: "defaulted, because the source does not say it",
}


def migration_lines(migration: Migration, project: Path) -> Iterator[str]:
    """Yield the report of a migration; every finding is in it."""
    for source in migration.sources:
        found = ", ".join(str(file) for file in source.metamodels.values())
        yield f"{source.file}: {source.what}" + (f" (by {found})" if found else "")
    groups = grouped(migration.findings)
    for category in Category:
        own = [group for group in groups if group.category is category]
        if own:
            yield ""
            yield f"{_WORDS[category]} ({counted(sum(len(group.findings) for group in own), 'value')}):"
            for group in own:
                yield f"  {group.reason}"
                yield from (f"    {line}" for line in _places(group.findings))
    yield ""
    for output in migration.outputs:
        yield f"written: {project / output.path} (from {', '.join(output.sources)})"


def verdict_lines(verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Yield whether what was written is valid, and what a behaviour still needs to be run.

    Of valid robot types beside a behaviour, the line of the behaviour says enough.
    """
    judged = {verdict.path.parent for verdict in verdicts if not verdict.alone}
    for verdict in verdicts:
        if verdict.alone and verdict.valid and verdict.path in judged:
            continue
        for name in verdict.missing:
            yield (
                f"{verdict.path}: to simulate or generate it, the robot type {name!r} is needed: migrate the"
                f" file that describes it into {verdict.path.parent}, too, write"
                f" {verdict.path.parent / 'robots' / name}.xmi, or say by --type which type is meant"
            )
        yield f"{verdict.path}: {verdict.word}{', with no mission beside it yet' * verdict.alone}"
    if not verdicts:
        yield "nothing to migrate, nothing written"


def _places(findings: Iterable[Finding]) -> Iterator[str]:
    """Yield where something happened, and to what; the same thing once for all its lines in a file."""
    lines: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        lines.setdefault((finding.place.file, finding.subject), []).append(finding)
    for (file, subject), same in lines.items():
        where = ",".join(str(finding.place.line) for finding in same)
        path = same[0].place.path if len(same) == 1 and same[0].place.path != "/" else ""
        yield f"{file}:{where}: {subject}" + (f", {path}" if path else "")
