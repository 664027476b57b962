"""What a type of robot carries, and the figures that hold with it."""

from dataclasses import replace

import pytest

from mmrs_core.errors import InfeasibleError
from mmrs_core.testing.scenes import sample_type
from mmrs_core.transformation.kinds import capability_for

MEASURED = sample_type()
"""A type with figures for one kilogram that does not say how much it carries."""


def test_a_type_that_states_no_largest_payload_carries_nothing():
    assert capability_for(MEASURED, 0.0) == MEASURED.capabilities[0]
    with pytest.raises(InfeasibleError, match=r"states no maxPayload and carries none"):
        capability_for(MEASURED, 0.5)


def test_a_type_carries_up_to_its_largest_payload():
    strong = replace(MEASURED, max_payload=0.8)
    assert capability_for(strong, 0.8) == MEASURED.capabilities[0]
    with pytest.raises(InfeasibleError, match=r"at most 0\.8 kg, not the 0\.9 kg that it is to"):
        capability_for(strong, 0.9)


def test_a_payload_that_no_figures_hold_for_is_refused():
    with pytest.raises(InfeasibleError, match="no movement capability for a payload of 2 kg"):
        capability_for(replace(MEASURED, max_payload=5.0), 2.0)
