"""What a log says of a run of waypoints that is not left as it should be."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flight_crew import OVERHEAD, manned, robot_of

from mmrs_mavlink.program import GoTo, Run, Step, Then
from mmrs_runtime.faults import REFUSED, Refused
from mmrs_runtime.records.log import read


def test_a_run_whose_vehicle_cannot_be_stepped_at_its_end_has_not_ended(tmp_path, monkeypatch):
    plain = robot_of()
    out, stop = plain.step("out"), plain.step("stop")
    steps = (
        Step("start", plain.step("start").movement, then=Then("out")),
        replace(out, then=Then("back")),
        Step("back", GoTo(OVERHEAD, 5.0), then=Then("stop")),
        stop,
    )
    robot = replace(plain, steps=steps, runs=(Run(("out", "back"), (0.0, 0.0)),))
    with manned(tmp_path, robot) as made:

        def fly(first, last, reached):
            for seq in range(first, last + 1):
                reached(seq)
            raise Refused("the vehicle does not go into mode guided")

        monkeypatch.setattr(made.crew.vehicle, "fly", fly)
        with pytest.raises(Refused) as refused:
            made.crew.pilot.fly()
        assert refused.value.event == REFUSED
        steps = [(line.label, line.move) for line in read(made.log)]
        assert [move for move, _ in made.crew.pilot.track][-1] == "back"
    assert steps[-4:] == [("begin", "out"), ("end", "out"), ("take", "out"), ("begin", "back")]
