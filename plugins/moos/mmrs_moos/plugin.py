"""The target moos."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_core.hookspecs import hookimpl

if TYPE_CHECKING:
    from mmrs_core.contributions.targets import Target


@hookimpl
def mmrs_targets() -> tuple[Target, ...]:
    """Contribute the target moos."""
    from mmrs_moos.target import MOOS

    return (MOOS,)
