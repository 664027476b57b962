"""Controllers of vehicles on CAN buses: the words of their programs, and what runs these."""

from typing import TYPE_CHECKING

from mmrs_auv.controllers.vocabulary import Operate
from mmrs_runtime import controllers
from mmrs_runtime.controllers import *  # noqa: F403  # all that programs of any vehicle say
from mmrs_runtime.controllers.vocabulary import Robot

if TYPE_CHECKING:
    from mmrs_auv.controllers.driver import main

__all__ = ["Operate", "Robot", "main"]
__all__ += controllers.__all__


def __getattr__(name: str) -> object:
    """Return what runs programs when it is asked for: to read one, its words are enough."""
    if name == "main":
        from mmrs_auv.controllers.driver import main

        return main
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
