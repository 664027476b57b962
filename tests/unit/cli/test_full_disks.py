"""What cannot be written to the end is named: a full disk says of itself only that it is full."""

from __future__ import annotations

import errno
import os
from contextlib import suppress

import pytest

from mmrs_core.behaviour.log import LogWriter
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.languages.writing import replace_file

FULL = "/dev/full"
STEP = StepRecord("run-0", "alpha", 0, 1, 0.0, "begin", "start")


@pytest.fixture
def full(monkeypatch):
    """Have everything that is opened by number be a full disk."""
    if not os.path.exists(FULL):  # noqa: PTH110  # a device, no file of ours
        pytest.skip("this system has no full disk to write to")
    opened = os.fdopen

    def instead(number, *more, **options):
        os.dup2(os.open(FULL, os.O_WRONLY), number)
        return opened(number, *more, **options)

    monkeypatch.setattr(os, "fdopen", instead)


def test_a_file_that_is_replaced_is_named(full, tmp_path):
    with pytest.raises(OSError, match=r"model\.xmi") as raised:
        replace_file(tmp_path / "model.xmi", b"x")
    assert raised.value.errno == errno.ENOSPC
    assert list(tmp_path.iterdir()) == []


def test_a_log_is_named(tmp_path):
    (tmp_path / "alpha.jsonl").symlink_to(FULL)
    writer = LogWriter(tmp_path)
    with pytest.raises(OSError, match=r"alpha\.jsonl"):
        writer.write(STEP)
    with suppress(OSError):
        writer.close()
