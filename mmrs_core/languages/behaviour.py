"""The Behaviour Language (BL): what each robot does, move by move.

The classes come from ``behaviour.ecore`` when they are first asked for; the stub beside this file lists them.
"""

from __future__ import annotations

from mmrs_core.languages.registry import members_of
from mmrs_core.languages.uris import BEHAVIOUR

NS_URI = BEHAVIOUR
__getattr__, __dir__ = members_of(NS_URI)
