"""Notifies and notices in progress, while nobody answers."""

from random import Random

import pytest

from mmrs_runtime.bus.messages import REACH, Answer, CommandId, Commit, Prepare
from mmrs_runtime.bus.transactions import LONGEST_PAUSE, LONGEST_ROUND, Transaction


@pytest.mark.parametrize("sent", [False, True], ids=["asking", "sending"])
def test_an_owner_that_is_out_of_reach_for_hours_is_still_asked(sent):
    notify = Transaction(CommandId("run", "a", "1", 1), {"b": ("go",)}, True, lambda: 1, Random(1), REACH)
    if sent:
        (asked,) = notify.tick(0.0)
        notify.answered("b", asked.request.round, Answer("granted", 1), 0.0)
        notify.send(1, 0.0)
    for _ in range(4000):
        before = notify.due
        (message,) = notify.tick(before)
        assert 0.0 < notify.due - before < LONGEST_ROUND + 2 * LONGEST_PAUSE
    assert isinstance(message.request, Commit if sent else Prepare)
