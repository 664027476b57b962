"""Laws for sample missions: they pass through the whole chain, by the commands that operators use."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import BytesIO, TextIOWrapper
from pathlib import Path
from typing import Any, ClassVar

import pytest

from mmrs_core.cli import run
from mmrs_core.plugins import load_plugins


class MissionConformance:
    """A mission that is valid, planned, verified, generated, simulated and shown.

    Attributes:
        folder: of the mission, with its ``mission.xmi`` and ``robots/``.
        rules: names of the rules that its moves must come from.
        targets: for code generation, that must be able to express it. None: one of those that are installed.
    """

    folder: ClassVar[Path]
    rules: ClassVar[Sequence[str]] = ()
    targets: ClassVar[Sequence[str] | None] = None

    @pytest.fixture(scope="class")
    @classmethod
    def planned(cls, tmp_path_factory: pytest.TempPathFactory) -> Path:
        """Return a copy of the folder, with the behaviour that was planned in it."""
        copy = tmp_path_factory.mktemp("planned") / "mission"
        shutil.copytree(cls.folder, copy)
        run_command("plan", copy, "--force")
        return copy

    def test_it_is_valid(self) -> None:
        """Nothing is wrong with it, and nothing is warned of; notes are welcome."""
        found = run_json("validate", self.folder)["diagnostics"]
        assert [each for each in found if each["severity"] != "note"] == []

    def test_every_rule_leads_to_moves(self, planned: Path) -> None:
        """The plan names for each move the rule that it came from."""
        behaviour = (planned / "behaviour.xmi").read_text(encoding="utf-8")
        assert [rule for rule in self.rules if f'rule="{rule}"' not in behaviour] == []

    def test_its_behaviour_passes_all_checks(self, planned: Path) -> None:
        """Every property is safe, or is one that does not matter here."""
        run_command("check", planned)

    def test_its_behaviour_is_carried_out(self, planned: Path) -> None:
        """The simulation ends well."""
        run_command("simulate", planned)

    def test_code_is_generated_from_it(self, planned: Path, tmp_path: Path) -> None:
        """Each target can express it; one at least where none is named, and any is installed."""
        if self.targets is None:
            known = load_plugins().contributions.targets
            runs = (run_mmrs("generate", planned, "--target", name, "-o", tmp_path / name) for name in known)
            assert not known or any(each.exit_code == 0 for each in runs)
        for target in self.targets or ():
            made = run_json("generate", planned, "--target", target, "-o", tmp_path / target)
            assert made["files"]

    def test_it_can_be_looked_at(self, tmp_path: Path) -> None:
        """The preview is a page that shows something."""
        run_command("preview", self.folder, "-o", tmp_path)
        (page,) = tmp_path.glob("*.html")
        assert "<svg" in page.read_text(encoding="utf-8")


@dataclass(frozen=True, slots=True)
class CommandRun:
    """How a command ended, and what it printed."""

    exit_code: int
    output: str
    messages: str


def run_mmrs(*arguments: object) -> CommandRun:
    """Run ``mmrs`` in this process; return its exit code, standard output and standard error."""
    output, messages = (TextIOWrapper(BytesIO(), "utf-8", write_through=True) for _ in range(2))
    with redirect_stdout(output), redirect_stderr(messages):
        exit_code = run([str(each) for each in arguments])
    return CommandRun(exit_code, *(each.buffer.getvalue().decode() for each in (output, messages)))


def run_command(*arguments: object) -> str:
    """Return what ``mmrs`` prints; the test fails if its exit code is not 0."""
    done = run_mmrs(*arguments)
    if done.exit_code != 0:
        words = " ".join(map(str, arguments))
        pytest.fail(f"mmrs {words}: exit code {done.exit_code}\n{done.output}{done.messages}")
    return done.output


def run_json(*arguments: object, any_code: bool = False) -> Any:
    """Return the object that ``mmrs … --json`` prints; the test fails if its exit code is not 0."""
    if any_code:
        return json.loads(run_mmrs(*arguments, "--json").output)
    return json.loads(run_command(*arguments, "--json"))
