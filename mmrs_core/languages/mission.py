"""The mission layer of MML: what is to be done, as tasks on a map.

The classes come from ``mission.ecore`` when they are first asked for; the stub beside this file lists them.
"""

from __future__ import annotations

from mmrs_core.languages.registry import members_of
from mmrs_core.languages.uris import MISSION

NS_URI = MISSION
__getattr__, __dir__ = members_of(NS_URI)
