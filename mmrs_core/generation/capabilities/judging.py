"""Tries out what a target does with each element of the Behaviour Language."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, zip_longest
from typing import Literal, TypeAlias

from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.targets import Target, TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.capabilities import behaviours, moves
from mmrs_core.generation.capabilities.probes import Probe, samples_of
from mmrs_core.generation.environment import environment_of
from mmrs_core.generation.render import Press

Verdict: TypeAlias = Literal["expressed", "no difference", "lossy", "refused"]
VERDICTS: dict[Verdict, str] = {
    "expressed": "it is in the generated files",
    "no difference": "the files are the same without it: it is for others than the robot's controller, "
    "or nothing is lost for the reason given",
    "lossy": "refused; with --allow-lossy it is left out, or is done as the list says",
    "refused": "refused, also with --allow-lossy",
}
"""Meaning of each verdict, as printed."""


FOR_OTHERS = ("Move.name", "Move.task", "Move.rule")
"""Features of moves that robots do not need: they are traced by the manifest."""

SHORT_OF = ("move", "heading", "transition", "device action", "action", "policy")
"""How the groups of elements begin without which robots do less, or something else, than was planned."""


@dataclass(frozen=True, slots=True)
class TargetCapability:
    """What a target does with an element.

    Attributes:
        group, element: as in `Probe`.
        how: how it is expressed, in the target's words; or why it is refused.
    """

    group: str
    element: str
    verdict: Verdict
    how: str = ""


def probes(target: Target, contributions: Contributions) -> tuple[Probe, ...]:
    """Return a minimal behaviour for each element of the Behaviour Language, and of what extends it."""
    samples = samples_of(target, contributions)
    return tuple(
        chain(
            behaviours.of_behaviours(samples),
            behaviours.of_robots(samples),
            behaviours.of_places(samples),
            moves.of_moves(samples),
            moves.of_plugins(samples, contributions),
            moves.of_headings(samples),
            moves.of_transitions(samples),
            moves.of_devices(samples),
            moves.of_actions(samples),
            behaviours.of_policies(samples),
        )
    )


def capabilities_of(target: Target, contributions: Contributions) -> tuple[TargetCapability, ...]:
    """Return what a target does with each element."""
    trial = Trial(target)
    return tuple(trial.judged(probe) for probe in probes(target, contributions))


def lost(target: Target, rows: Iterable[TargetCapability]) -> tuple[TargetCapability, ...]:
    """Return the elements that a target loses silently.

    They make no difference to the files and are not refused, though robots do less or otherwise without
    them. `Target.capabilities` says why nothing is lost: by the whole name of the element, by what precedes
    the colon in that of a policy or heading, or by an empty name for everything.
    """
    words = target.capabilities
    return tuple(
        row
        for row in rows
        if row.verdict == "no difference" and row.group.startswith(SHORT_OF) and row.element not in FOR_OTHERS
        if not words.keys() & {row.element, _sort(row), ""}
    )


def _sort(row: TargetCapability) -> str:
    """Return what comes before the colon in the name of a policy or heading, else all of the name."""
    return row.element.partition(":")[0] if row.group.startswith(("policy", "heading")) else row.element


class Trial:
    """A target that is tried out."""

    def __init__(self, target: Target) -> None:
        """Prepare the target's templates."""
        self._target = target
        self._press = Press(target, environment_of(target))
        self._without: dict[int, tuple[set[str], tuple[object, ...]]] = {}

    def judged(self, probe: Probe) -> TargetCapability:
        """Return what the target does with the element of a probe."""
        refused = self._refusals(probe.given)
        others_refused, others = self._of_others(probe.without)
        if reasons := refused - others_refused or refused:
            verdict: Verdict = "refused" if self._impossible(probe.given) else "lossy"
            words = "; ".join(sorted({_short(each) for each in reasons}))
            return TargetCapability(probe.group, probe.element, verdict, words)
        how = self._how(probe.element)
        same = all(file == other for file, other in zip_longest(self._rendered(probe.given), others))
        return TargetCapability(probe.group, probe.element, "no difference" if same else "expressed", how)

    def _how(self, element: str) -> str:
        words = self._target.capabilities
        fitting = [begin for begin in words if element.startswith(begin)]
        return words[max(fitting, key=len)] if fitting else ""

    def _refusals(self, input: TargetInput) -> set[str]:
        return set(self._target.refusals(input))

    def _impossible(self, input: TargetInput) -> bool:
        """Return whether a behaviour cannot be rendered."""
        try:
            for _ in self._rendered(input):
                pass
        except UnsupportedError:
            return True
        return False

    def _of_others(self, without: TargetInput) -> tuple[set[str], tuple[object, ...]]:
        """Return the refusals and the files of a behaviour that many probes share."""
        key = id(without)  # probes keep it
        if key not in self._without:
            self._without[key] = self._refusals(without), tuple(self._rendered_at_all(without))
        return self._without[key]

    def _rendered_at_all(self, input: TargetInput) -> Iterator[tuple[str, bytes] | UnsupportedError]:
        """Yield each file, then the reason why a behaviour cannot be rendered, if it cannot."""
        try:
            yield from self._rendered(input)
        except UnsupportedError as error:
            yield error

    def _rendered(self, input: TargetInput) -> Iterator[tuple[str, bytes]]:
        """Yield the path and content of each file that is rendered for this behaviour.

        Not what is copied, which is the same for every behaviour, nor the fingerprint, which never is.
        """
        mark = input.program.fingerprint.encode()
        for spec in self._target.files(input):
            if spec.source is None:
                yield spec.path, self._press.content(spec)[0].replace(mark, b"")


def _short(reason: str) -> str:
    """Return a refusal without the robot and the move that it is about."""
    head, _, rest = reason.partition(": ")
    return rest if rest and head.startswith("robot '") else reason
