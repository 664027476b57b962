"""Robots that are out when their programs end."""

from __future__ import annotations

from functools import partial

import pytest


@pytest.fixture
def robot(in_the_air):
    """Return a function that gives a robot with policies, 22 metres north of its home and ten above it."""
    return partial(in_the_air, out=True)
