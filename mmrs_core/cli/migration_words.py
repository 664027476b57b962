"""What a migration tells people: what each file was, what was written, and what is not just as it was."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mmrs_core.cli.output import counted
from mmrs_core.migration.findings import Category, Group, grouped
from mmrs_core.migration.migrate import Migration


def migration_lines(migration: Migration, project: Path) -> Iterator[str]:
    """Yield the report of a migration."""
    for source in migration.sources:
        found = "; ".join(f"{package}: {file}" for package, file in source.metamodels.items())
        yield f"{source.file}: {source.what}" + (f" (metamodels: {found})" if found else "")
    groups = grouped(migration.findings)
    for category in Category:
        own = [group for group in groups if group.category is category]
        if own:
            yield ""
            yield f"{category.value} ({counted(sum(len(group.findings) for group in own), 'value')}):"
            for group in own:
                yield from _group_lines(group)
    yield ""
    for output in migration.outputs:
        yield f"written: {project / output.path} (from {', '.join(output.sources)})"
    if not migration.outputs:
        yield "nothing to migrate"


def _group_lines(group: Group) -> Iterator[str]:
    yield f"  {group.reason}"
    for finding in group.findings:
        yield f"    {finding.place} {finding.place.path}: {finding.subject}"
