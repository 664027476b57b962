"""The bus: slots of robots in one process or in many, and notifies that set them exactly once.

A slot belongs to its robot. A notify is a command to the owner: one message where its slots are never
reset, otherwise two, so that the logs, merged by logical time, show what happened. To follow one, read in
order:

``node.py``       one process's end of the bus; `Node.prepare` begins a notify, `Node.serve` answers one
``outgoing.py``   what one process sends until all have answered
``transactions.py``   the steps of one notify, with pauses and retries
``messages.py``   the messages and their encoding
``carriers/over_zenoh.py``   transport to other processes
``owners.py``     admission of messages, and who answers them
``owner.py``      the owner of a robot's slots, which applies a command once
``slot.py``       what a command does to a slot
``journal.py``    what is on the disk before a message is answered

In addition, ``watching.py`` tracks which robots are present, ``threads.py`` repeats what is due,
``meeting.py`` starts robots together, ``program_bus.py`` sets all of that up for a program, and ``gateway``
connects programs without Zenoh.
"""

from .carriers.carrier import Carrier
from .journal import FileJournal, NoJournal
from .meeting import PATIENCE, Beginning, Incomplete, begin_together
from .messages import CommandId, SlotId, SlotState
from .node import Node
from .outgoing import BusDelivery
from .owner import Owned
from .owners import Member, Recorded
from .watching import Unwelcome

__all__ = [
    "PATIENCE",
    "Beginning",
    "BusDelivery",
    "Carrier",
    "CommandId",
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
