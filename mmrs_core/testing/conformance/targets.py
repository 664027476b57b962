"""Laws for targets of code generation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import pytest

from mmrs_core.contributions.targets import Target, TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.capabilities.judging import TargetCapability, capabilities_of, lost, probes
from mmrs_core.generation.manifest import manifest_in
from mmrs_core.generation.render import render
from mmrs_core.languages.uris import BEHAVIOUR
from mmrs_core.testing.conformance.declared import Conformance, declared
from mmrs_core.testing.programs import installed, two_robots

UNHEARD_OF = (("urn:mmrs:testing:nowhere:1.0", "Somersault"), (BEHAVIOUR, "Move"))

LOST = """these make no difference to the files:
write them, refuse them by name in Target.refusals, or say in Target.capabilities why nothing is lost"""


class TargetConformance(Conformance):
    """Conformance of targets: equal files for equal behaviours, and refusals of what cannot be expressed.

    Attributes:
        inputs: a behaviour that the target can express, by the target's name. Default: two robots of the kind
            that it is made for, one of which waits until the other has used its device (`two_robots`).
    """

    inputs: ClassVar[Mapping[str, TargetInput]] = {}
    _tables: ClassVar[dict[str, tuple[TargetCapability, ...]]] = {}

    def test_there_is_a_target(self) -> None:
        """A plug-in whose targets are tested has one, and no input is left over."""
        names = {each.name for each in declared(self.plugin, "targets")}
        assert names
        assert set(self.inputs) <= names

    def test_its_templates_are_there(self, target: Target) -> None:
        """Templates travel with the plug-in."""
        assert target.templates.is_dir()

    def test_it_is_called_and_described_for_the_command_line(self, target: Target) -> None:
        """The name is typed, the description is one line."""
        assert target.name == target.name.lower()
        assert " " not in target.name
        assert target.description
        assert "\n" not in target.description

    def test_it_writes_files_that_can_be_read(self, target: Target) -> None:
        """There is something beside the manifest, and all that templates make is text in UTF-8."""
        given = self._input(target)
        files = render(target, given)
        assert len(files) > 1
        binary = {spec.path for spec in target.files(given) if spec.data is not None}
        for file in files:
            assert file.path in binary or file.content.decode("utf-8")

    def test_equal_behaviours_make_equal_files(
        self, target: Target, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        """Neither the time, nor the folder, nor the machine gets into them."""
        first = render(target, self._input(target))
        monkeypatch.chdir(tmp_path)
        monkeypatch.setenv("HOME", str(tmp_path))
        assert render(target, self._input(target)) == first

    def test_a_move_that_nobody_knows_is_refused(self, target: Target) -> None:
        """A move is never left out without a word; the words name the robot and the move."""
        given = self._input(target)
        robot, *others = given.program.robots
        moves = list(robot.moves)
        moves[1] = replace(moves[1], metaclasses=UNHEARD_OF)
        changed = replace(given.program, robots=(replace(robot, moves=tuple(moves)), *others))
        with pytest.raises(UnsupportedError) as refusal:
            render(target, replace(given, program=changed))
        assert any(robot.id in each and moves[1].id in each for each in refusal.value.elements)

    def test_the_lines_that_serve_a_step_are_there(self, target: Target) -> None:
        """What templates say by the tag ``serves`` is about robots and moves of the behaviour."""
        given = self._input(target)
        *files, manifest = render(target, given)
        lines = {file.path: len(file.content.splitlines()) for file in files}
        moves = {(robot.id, move.id) for robot in given.program.robots for move in robot.moves}
        robots = {(robot.id, "") for robot in given.program.robots}
        for entry in manifest_in(manifest.content).trace:
            assert entry.first <= entry.last <= lines[entry.file]
            assert (entry.step.robot, entry.step.move) in moves | robots

    def test_every_step_that_it_declares_is_served_by_lines(self, target: Target) -> None:
        """Templates mark each step of `FileSpec.trace` by the tag ``serves``, for `mmrs-gen explain`."""
        given = self._input(target)
        rendered = {spec.path for spec in target.files(given) if spec.template.endswith(".jinja")}
        *_, manifest = render(target, given)
        entries = [each for each in manifest_in(manifest.content).trace if each.file in rendered]
        steps = [f"{each.file}: {each.step.step}" for each in entries if not each.first]
        assert not steps, "no lines of the template serve these steps of FileSpec.trace ({% serves step %})"

    def test_nothing_is_lost_silently(self, target: Target) -> None:
        """What changes what robots do is written or refused, or the capabilities say why nothing is lost.

        Each element is tried: a behaviour with it must not make the same files as one without it.
        """
        names = [f"{row.group}: {row.element}" for row in lost(target, self._table(target))]
        if names:
            pytest.fail(f"{LOST}\n  " + "\n  ".join(names), pytrace=False)

    def test_its_table_of_capabilities_is_about_what_it_expresses_and_refuses(self, target: Target) -> None:
        """The words of a target are for elements that it expresses, or whose absence loses nothing.

        A refusal is about something that the behaviour without it is not refused for.
        """
        contributions, rows = installed(), self._table(target)
        kept = [row.element for row in rows if row.verdict in ("expressed", "no difference")]
        for begin in target.capabilities:
            assert any(element.startswith(begin) for element in kept), begin
        for probe, row in zip(probes(target, contributions), rows, strict=True):
            refused = row.verdict in ("lossy", "refused")
            assert bool(tuple(target.refusals(probe.given))) is refused, row.element

    def _table(self, target: Target) -> tuple[TargetCapability, ...]:
        """Return what the target does with each element, which takes seconds to find out."""
        if target.name not in self._tables:
            self._tables[target.name] = capabilities_of(target, installed())
        return self._tables[target.name]

    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def _tried_once(cls) -> None:
        cls._tables = {}

    def _input(self, target: Target) -> TargetInput:
        return self.inputs.get(target.name) or two_robots(target)
