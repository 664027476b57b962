"""The bus: slots of robots in one process or in many, and notifies that set them exactly once.

A slot belongs to its robot. A notify is a command to the owner: one message where its slots are never
reset, else two, so that the logs, merged by logical time, tell what happened. To follow one, read in order:

``node.py``       one process's end of the bus; `Node.prepare` begins a notify, `Node.serve` answers one
``outgoing.py``   what one process sends until all have answered
``errands.py``    the steps of one notify, with pauses and tries
``words.py``      what is said, and how it is written
``carriers/over_zenoh.py``   how that reaches other processes
``owners.py``     what is heard of it there, and who answers
``owner.py``      the owner of a robot's slots, which applies it once
``slot.py``       what it does to a slot
``journal.py``    what is on the disk before it is answered

Beside these, ``watching.py`` knows who is there, ``threads.py`` repeats what is due, ``meeting.py`` has
robots begin together, ``program_bus.py`` makes all of that for a program, and ``gateway`` lets programs
without Zenoh take part.
"""

from .carriers.carrier import Carrier
from .journal import FileJournal, NoJournal
from .meeting import PATIENCE, Beginning, Incomplete, begin_together
from .node import Node
from .outgoing import Delivery
from .owner import Owned
from .owners import Member, Recorded
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
