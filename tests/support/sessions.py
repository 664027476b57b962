"""What is seen of a robot at work in this process."""

from __future__ import annotations

from mmrs_runtime.records.log import read


def phase(shared, robot="alpha"):
    """Return what a robot is about, in a word."""
    return shared.crews.status(robot)["phase"]


def labels(folder):
    """Return the labels of the steps in the log of alpha."""
    return [line.label for line in read(folder / "alpha.jsonl")]
