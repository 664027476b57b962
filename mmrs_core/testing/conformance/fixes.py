"""Conformance tests for fixes of ``mmrs validate --fix``."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import pytest

from mmrs_core.contributions.fixes import Fix
from mmrs_core.testing.conformance.declared import Conformance, declared
from mmrs_core.testing.conformance.missions import run_command, run_json, run_mmrs


@dataclass(frozen=True, slots=True)
class FixCase:
    """A problem of a project that a fix solves.

    Attributes:
        file: of the project, such as ``mission.xmi``.
        right: text that occurs there.
        wrong: text in its place that makes the problem; the fix gives `right` back.
    """

    file: str
    right: str
    wrong: str


class FixConformance(Conformance):
    """Every fix of a plug-in, which must be installed, solves its problem and changes nothing else.

    Attributes:
        folder: of a valid project, in XMI.
        cases: by code.
    """

    folder: ClassVar[Path]
    cases: ClassVar[Mapping[str, FixCase]]

    def test_every_fix_has_a_case(self) -> None:
        """No fix goes untested, and no case is left over."""
        assert set(self.cases) == {each.code for each in declared(self.plugin, "fixes")}

    def test_its_title_is_an_imperative(self, fix: Fix) -> None:
        """Titles are lower case, without a full stop."""
        assert fix.title[0].islower()
        assert not fix.title.endswith(".")

    def test_it_gives_the_right_text_back(self, fix: Fix, tmp_path: Path) -> None:
        """The problem is reported with its code, and fixing it changes nothing else of the file."""
        file, right = self._spoilt(fix, tmp_path)
        assert fix.code in _codes(file.parent)
        run_command("validate", file.parent, "--fix", "--yes")
        assert file.read_text(encoding="utf-8") == right

    def test_it_fixes_models_in_json_as_well(self, fix: Fix, tmp_path: Path) -> None:
        """One fix serves both formats."""
        file, _ = self._spoilt(fix, tmp_path)
        if run_mmrs("convert", file.parent, "-o", tmp_path / "json").exit_code != 0:
            pytest.skip("the problem is one of XMI only")
        assert fix.code in _codes(tmp_path / "json")
        run_command("validate", tmp_path / "json", "--fix", "--yes")
        assert fix.code not in _codes(tmp_path / "json")

    def _spoilt(self, fix: Fix, folder: Path) -> tuple[Path, str]:
        """Return the file of a copied project with the problem, and its text without."""
        case = self.cases[fix.code]
        copy = Path(shutil.copytree(self.folder, folder / "project"))
        text = (copy / case.file).read_text(encoding="utf-8")
        assert text.count(case.right) == 1, f"{case.file} must contain {case.right!r} exactly once"
        (copy / case.file).write_text(text.replace(case.right, case.wrong), encoding="utf-8")
        return copy / case.file, text


def _codes(project: Path) -> set[str]:
    return {each["code"] for each in run_json("validate", project, any_code=True)["diagnostics"]}
