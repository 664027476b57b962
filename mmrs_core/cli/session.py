"""Takes a mission through the stages, each when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, TypeVar

from mmrs_core.cli.failures import RefusedError
from mmrs_core.cli.interruption import ended_by_interrupt, interrupted
from mmrs_core.cli.observers import Observers
from mmrs_core.cli.output import progress, report, tell
from mmrs_core.cli.protection import files_of
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.checks import Status, Verdict
from mmrs_core.pictures.figures import clock
from mmrs_core.pipeline import BehaviourContext, explain, plan, read_models, refusals, valid_models, verify
from mmrs_core.planning.effort import Effort
from mmrs_core.stages import Stages

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Program
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.diagnostics import Diagnostic
    from mmrs_core.languages.model import Model
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.planning.explaining import PlanExplanation
    from mmrs_core.plugins import Plugins
    from mmrs_core.scene import Plan, Scene

Result = TypeVar("Result")

_DOING = {
    "check": "checking the models",
    "ground": "grounding the mission",
    "expand": "finding the work of every task",
    "plan": "planning",
    "transform": "writing the behaviour",
    "verify": "checking the behaviour",
}
"""What stages do, as it is shown while they do it."""
_UNKNOWN = "known to be safe: give what is missing, or name the property in the mission's acceptedUnknowns"
NO_CONTEXT = "no context: nothing is known of obstacles and forbidden areas"


class Session:
    """The plug-ins of a command, and the way stages are run with them: shown, and observed."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._inputs: list[Path] = []
        self.show: Callable[[str], None] = lambda far: None

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Return every file of models that was read so far, none of which may be overwritten."""
        return tuple(self._inputs)

    def have_read(self, models: Iterable[Model], context: object) -> None:
        """Remember the files of the models of a mission or behaviour; tell if there is no context."""
        self._inputs += files_of(models)
        if context is None:
            tell(f"{self._inputs[0].parent}: note: {NO_CONTEXT}")

    @cached_property
    def plugins(self) -> Plugins:
        """Return the plug-ins."""
        return self._settings.plugins()

    @cached_property
    def observers(self) -> Observers:
        """Return the observing plug-ins."""
        return Observers(self.plugins)

    @property
    def contributions(self) -> Contributions:
        """Return what the plug-ins contribute."""
        return self.plugins.contributions

    def stage(self, name: str, doing: str, make: Callable[[], Result]) -> Result:
        """Return what a stage makes, after telling the observers of it.

        Raises:
            KeyboardInterrupt: also for an interrupt that a library swallowed while the stage was made.
        """
        with progress(doing) as self.show:
            result = make()
        if interrupted():
            raise KeyboardInterrupt
        self.observers.see_stage(name, result)
        return result


class CommandStages(Stages):
    """The stages of a command's mission: shown, and observed."""

    def __init__(
        self,
        session: Session,
        mission: Path,
        *,
        context: Path | None = None,
        robots: Sequence[Path] = (),
        seed: int = 0,
        time_limit: float | None = None,
    ) -> None:
        super().__init__(lambda: self._valid[0], session.contributions, seed=seed)
        self._time_limit = time_limit
        self._end: float | None = None
        self._effort: Effort | None = None
        self.session = session
        self._mission = mission
        self._context = context
        self._robots = robots

    def stage(self, name: str, make: Callable[[], Result]) -> Result:
        """Return what a stage makes, after telling the observers of it."""
        return self.session.stage(name, _DOING[name], make)

    def planned(self, scene: Scene, seed: int) -> Plan:
        """Return the plan of an expanded scene; the first interrupt keeps the best that was found by then."""

        def show(best: float, least: float) -> None:
            bound = f", lower bound {clock(least)}" if least else ""
            self.session.show(f"mission time {clock(best)}{bound}; Ctrl-C keeps the best plan")

        before = self._effort
        if self._time_limit is not None and self._end is None:
            self._end = monotonic() + self._time_limit
        self._effort = Effort(None if self._end is None else self._end - monotonic(), monotonic, show)
        self._effort.stopped = before is not None and before.stopped
        with ended_by_interrupt(self._stop):
            return plan(scene, seed=seed, effort=self._effort)

    def _stop(self) -> bool:
        """End the search where it has found something to keep, and say so; return whether it has."""
        keeps = self._effort is not None and self._effort.stop()
        if keeps:
            with suppress(RuntimeError):  # of an interrupt in the middle of another line
                tell(
                    "interrupted: the plan is finished with what was found; Ctrl-C again ends without a plan"
                )
        return keeps

    @cached_property
    def explanation(self) -> PlanExplanation:
        """Return why the plan is as it is."""
        scene, plan, timed = self.scene, self.plan, self.timed
        with progress("explaining the plan"):
            return explain(scene, plan, timed)

    @cached_property
    def _valid(self) -> tuple[ModelSet, tuple[Diagnostic, ...]]:
        models, warnings = self.stage(
            "check",
            lambda: valid_models(
                self._mission, self._contributions, context=self._context, robots=self._robots
            ),
        )
        self.session.have_read(models.models, models.context)
        report(warnings)
        return models, warnings

    def readable(self) -> ModelSet | None:
        """Return the models as far as they can be read, valid or not; None where there is no mission."""
        models, _ = read_models(
            self._mission, self._contributions, context=self._context, robots=self._robots
        )
        return models

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Return what is doubtful about the models."""
        return self._valid[1]


def verdicts_of(session: Session, program: Program, place: BehaviourContext) -> tuple[Verdict, ...]:
    """Return what is known of every property of a behaviour."""
    return session.stage("verify", _DOING["verify"], lambda: verify(program, place, session.contributions))


def require_safe(program: Program, verdicts: Sequence[Verdict], name: str) -> None:
    """Require that a behaviour is safe to execute.

    Raises:
        RefusedError: if a property is violated, or unknown without the mission accepting that.
    """
    against = refusals(verdicts, program)
    if against:
        unknown = all(each.status is Status.UNKNOWN for each in against)
        raise RefusedError(f"{name}: the behaviour is not {_UNKNOWN if unknown else 'safe'}", against)
