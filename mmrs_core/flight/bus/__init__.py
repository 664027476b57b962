"""The bus: slots of robots in one process or in many, and notifies that set them exactly once.

A slot belongs to its robot. A notify is a command to the owner in two steps, so that the logs, merged
by logical time, tell what happened: ``owner.py`` and ``errands.py`` say how, ``words.py`` with what
messages, ``slot.py`` what a slot is to its owner, and ``remembered.py`` what survives. ``node.py`` is one
process's end: what it has still to tell is in ``outbox.py``, what it answers in ``answering.py``.
``carrier.py`` says what carries messages, and ``over_zenoh.py`` is one that reaches other processes and
machines. ``gateway.py`` lets programs without Zenoh take part.
"""

from .carrier import Carrier
from .delivery import Delivery
from .journal import FileJournal, NoJournal
from .meeting import PATIENCE, Beginning, Incomplete, begin_together
from .members import Member, Recorded
from .node import Node
from .owner import Owned
from .watching import Unwelcome
from .words import CommandId, SlotId, SlotState

__all__ = [
    "PATIENCE",
    "Beginning",
    "Carrier",
    "CommandId",
    "Delivery",
    "FileJournal",
    "Incomplete",
    "Member",
    "NoJournal",
    "Node",
    "Owned",
    "Recorded",
    "SlotId",
    "SlotState",
    "Unwelcome",
    "begin_together",
]
