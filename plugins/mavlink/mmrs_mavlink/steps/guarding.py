"""What looks after a robot in every wait of its thread."""

from __future__ import annotations

from collections.abc import Callable

from mmrs_runtime.faults import Displaced

from ..orders.obedience import Obedience
from .watch import Watch


def guarding(watch: Watch, obedience: Obedience) -> Callable[[], None]:
    """Return what raises whatever should end a wait, obeys orders, and takes a vehicle back that strays."""

    def guard() -> None:
        try:
            watch.check()
        except Displaced:
            obedience.regain()
        if not watch.looking:
            obedience.check()

    return guard
