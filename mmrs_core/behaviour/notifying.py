"""Which slots a notify sets: the one place that knows."""

from __future__ import annotations

from mmrs_core.behaviour.program import SlotId
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import container_of


def resolve(notify: bl.Notify, behaviour: bl.Behaviour) -> tuple[SlotId, ...]:
    """Return the (robot, slot) pairs that a notify sets, each once.

    A unicast sets its slot, a multicast its slots in their order, a broadcast the slot of that name
    in every robot that has one, the sender included, in the order of the robots.

    Raises:
        ValueError: if it leads to no slot of a robot, or is of a kind that nobody knows.
    """
    if isinstance(notify, bl.UnicastNotify):
        return (_slot_id(notify.slot),)
    if isinstance(notify, bl.MulticastNotify):
        if not notify.slots:
            raise ValueError("notifies no slot")
        return tuple(dict.fromkeys(_slot_id(slot) for slot in notify.slots))
    if isinstance(notify, bl.BroadcastNotify):
        name = _slot_id(notify.slot)[1]
        return tuple((robot.id, name) for robot in behaviour.robots if _has_slot(robot, name))
    raise ValueError("is a notify of a kind that nobody knows")


def _slot_id(slot: bl.Slot | None) -> SlotId:
    owner = container_of(slot) if slot is not None else None
    if slot is None or not isinstance(owner, bl.Robot):
        raise ValueError("notifies a slot that no robot has")
    return owner.id, slot.name


def _has_slot(robot: bl.Robot, name: str) -> bool:
    return any(slot.name == name for slot in robot.slots)
