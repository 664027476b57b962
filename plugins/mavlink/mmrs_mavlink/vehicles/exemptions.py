"""Exemptions of a vehicle's failsafe for a lost ground station: none may stay where a policy answers."""

from __future__ import annotations

from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from ..services import parameters


def end_exemption(link: Link) -> str:
    """Make the failsafe for a lost link act in all modes of programs; return what operators should know.

    Raises:
        RefusedError: it would continue, and does not confirm that it will not.
    """
    exemption = link.profile.lost_link.exemption
    if exemption is None:
        return ""
    name = exemption.parameter
    was = round(parameters.read(link, [name]).get(name, 0.0))
    wanted = was & ~exemption.bits
    if wanted == was:
        return ""
    if not parameters.write(link, name, wanted):
        raise RefusedError(f"response to a lost link: the vehicle does not confirm {name} = {wanted}")
    return f"{name} = {wanted}, which was {was}: it answers a lost link in {exemption.where}, too"
