"""The context layer of MML: the surroundings of a mission.

The classes come from ``context.ecore`` when they are first asked for; the stub beside this file lists them.
"""

from __future__ import annotations

from mmrs_core.languages.registry import members_of
from mmrs_core.languages.uris import CONTEXT

NS_URI = CONTEXT
__getattr__, __dir__ = members_of(NS_URI)
