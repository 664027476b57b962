"""Dialects whose files are read as if they were models of ours: migrated in memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages.dialects import Foreign, Migrated
from mmrs_core.languages.element import Element

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry


@dataclass(frozen=True, slots=True)
class ForeignDialect:
    """Models of another tool, which every command takes.

    Attributes:
        name: what messages call the dialect.
        mapping: the file that says what becomes of what; docs/migrate.md explains its keys.
        notes: whether all that is not just as it was is listed; else what was lost or is doubtful is counted.
    """

    name: str
    mapping: Path
    notes: bool = True

    def quiet(self) -> ForeignDialect:
        """Return the same dialect, which does not list what is not just as it was."""
        return replace(self, notes=False)

    def recognised(self, data: bytes, file: str, registry: Registry, *, stored: bool) -> Foreign | None:
        """Return a file of this dialect, as `Dialect` says.

        Raises:
            PluginError: if the mapping is none.
        """
        from mmrs_core.migration.recognition import recognised
        from mmrs_core.migration.rules.mapping_file import read_dialect

        try:
            dialect = read_dialect(self.mapping)
        except UnreadableError as fault:
            raise PluginError(f"dialect '{self.name}': {fault}") from fault
        found = recognised(data, file, dialect, registry)
        return Foreign(self, replace(found, stored=stored), found.is_guess) if found is not None else None

    def ready(self, file: Foreign, registry: Registry) -> Foreign:
        """Return a file with the rules by which it is migrated, as `Dialect` says."""
        from mmrs_core.migration.recognition import Recognised
        from mmrs_core.migration.rules.mapping_file import read_mapping

        found = file.content
        assert isinstance(found, Recognised)  # as `recognised` made it
        name = found.opened.file
        if found.opened.document is None:
            raise UnreadableError.of("FIL009", found.opened.what, name)
        try:
            mapping = read_mapping(self.mapping, registry)
        except UnreadableError as fault:
            raise UnreadableError.of("FIL010", f"of {self.name}, and not migrated: {fault}", name) from fault
        return replace(file, content=replace(found, mapping=mapping))

    def migrated(
        self, files: Sequence[Foreign], registry: Registry, known: Sequence[Element]
    ) -> tuple[Migrated, ...]:
        """Return what files became, as `Dialect` says."""
        from mmrs_core.migration.in_memory import migrated
        from mmrs_core.migration.recognition import Recognised

        found = [each.content for each in files if isinstance(each.content, Recognised)]
        return migrated(found, self.name, registry, known, notes=self.notes)
