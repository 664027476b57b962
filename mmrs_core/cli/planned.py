"""What a planned behaviour must be, and where it may go, before it is written."""

from __future__ import annotations

from pathlib import Path

from mmrs_core.analysis.constraints import check_planned
from mmrs_core.cli.protection import files_of, refuse_handwritten, refuse_inputs, refuse_inside
from mmrs_core.cli.session import Stages, require_safe
from mmrs_core.diagnostics import has_errors, in_order
from mmrs_core.errors import InvalidModelError


def require_writable(stages: Stages, file: Path, way_out: str = "") -> None:
    """Do nothing if the behaviour of a mission may be written there.

    Args:
        stages: its models are read, if they were not yet.
        file: what is to be written.
        way_out: what the user can do instead of replacing a behaviour that somebody wrote by hand;
            empty: it may be replaced.

    Raises:
        ProtectedError: if the file is an input, lies among the types of robot, or was written by hand.
        InvalidModelError: if the mission is not valid.
    """
    mission = next(iter(files_of(stages.models.models)))
    refuse_inputs((file,), stages.session.inputs)
    refuse_inside(file, mission.parent / "robots")
    if way_out:
        refuse_handwritten(file, stages.session.contributions.languages, way_out)


def require_sound(stages: Stages, name: str) -> None:
    """Do nothing if the behaviour of a mission may be carried out, and can be read again.

    Args:
        stages: goes as far as to the verdicts.
        name: of the mission, for messages.

    Raises:
        RefusedError: if the behaviour is not safe, or not known to be.
        InvalidModelError: if it breaks a constraint, with all diagnostics.
    """
    require_safe(stages.program, stages.verdicts, name)
    contributions = stages.session.contributions
    faults = check_planned(
        stages.transformed[0], stages.models, contributions.constraints, contributions.languages
    )
    if has_errors(faults):
        raise InvalidModelError(f"{name}: the behaviour that was planned is not valid", in_order(faults))
