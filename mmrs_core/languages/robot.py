"""The Robot Language (RL): what each robot type is and can do.

The classes come from ``robot.ecore`` when they are first asked for; the stub beside this file lists them.
"""

from __future__ import annotations

from mmrs_core.languages.registry import members_of
from mmrs_core.languages.uris import ROBOT

NS_URI = ROBOT
__getattr__, __dir__ = members_of(NS_URI)
