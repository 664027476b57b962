"""The bus: slots of robots in one process or in many, and notifies that set them exactly once.

A slot belongs to its robot. A notify is a command to the owner: one message where its slots are never
reset, else two, so that the logs, merged by logical time, tell what happened. ``owners`` has what keeps
slots, ``outgoing`` what commands other owners, and ``words.py`` says with what messages. ``node.py`` is one
process's end. ``carriers`` has what carries messages, also one that reaches other processes and machines,
and ``gateway`` lets programs without Zenoh take part.
"""

from .carriers.carrier import Carrier
from .meeting import PATIENCE, Beginning, Incomplete, begin_together
from .node import Node
from .outgoing.delivery import Delivery
from .owners.journal import FileJournal, NoJournal
from .owners.members import Member, Recorded
from .owners.owner import Owned
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
