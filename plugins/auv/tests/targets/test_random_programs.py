"""Whatever a behaviour does, its plans are sound: every step leads to one that is there, or to the end."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from imc_reader import read_packet
from mmrs_auv.targets.imc.target import IMC
from mmrs_auv.targets.moos.target import MOOS
from moos_reader import read

from mmrs_core.behaviour.program import Heading, Target, Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.testing.programs import feedback, move, robot_program
from mmrs_core.testing.small_programs import notify

RELAXED = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    deadline=None,
    max_examples=40,
)
NAMES = st.text(st.characters(codec="utf-8"), min_size=1, max_size=8)
SLOT = "go on"


@st.composite
def moves(draw):
    """Draw moves of all sorts, with names that nobody would give."""
    names = draw(
        st.lists(NAMES, min_size=1, max_size=6, unique=True).filter(lambda n: not {"start", "stop"} & set(n))
    )
    made = []
    for name in names:
        place = Target(draw(st.tuples(*[st.floats(-50.0, 50.0)] * 2, st.floats(-9.0, -2.0))))
        went = replace(
            move(name, "GoTo"), target=place, distance=draw(st.sampled_from([0.0, 3.0])), speed=1.0
        )
        held = move(name, "HoldPosition", duration=draw(st.floats(0.0, 99.0)))
        turned = replace(move(name, "HeadTo"), heading=Heading(place))
        lost = replace(went, target=replace(place, description="a } // buoy"))
        chosen = draw(st.sampled_from([went, went, held, turned, lost]))
        after = draw(st.sampled_from([(), (notify(("naiad", SLOT)),), (feedback(name),)]))
        made.append(replace(chosen, after=after))
    return made


@st.composite
def inputs(draw, given):
    """Draw a robot whose moves follow each other in any way, rings and choices included."""
    made = draw(moves())
    last = len(made) + 1
    anywhere = st.integers(1, last)
    changed = {}
    for index in draw(st.sets(st.integers(0, last - 1), max_size=3)):
        kind = draw(st.sampled_from(["waits", "chooses", "jumps"]))
        if kind == "waits":
            changed[index] = Transition(index, index + 1, waits=(SLOT,))
        elif kind == "chooses":
            to, otherwise = draw(anywhere), draw(anywhere)
            changed[index] = Transition(index, to, condition=draw(NAMES), otherwise=otherwise)
        else:
            changed[index] = Transition(index, draw(anywhere))
    robot = robot_program(
        "naiad", made, home=(0.0, 0.0, -2.0), type_name="Diver", slots=(SLOT,), transitions=changed
    )
    return given(robot)


def rendered(target, input):
    """Return the files of a target, or None where a robot does nothing that it expresses."""
    try:
        return {file.path: file.content for file in render(target, input, allow_lossy=True)}
    except UnsupportedError as error:
        if "does nothing" not in str(error):
            raise
        return None


@RELAXED
@given(data=st.data())
def test_every_manoeuvre_leads_to_one_that_is_there_or_to_the_end(data, given):
    files = rendered(IMC, data.draw(inputs(given)))
    if files is None:
        return
    plan = read_packet(files["naiad.imc"])
    ids = [each["maneuver_id"] for each in plan["maneuvers"]]
    assert len(set(ids)) == len(ids)
    assert plan["start_man_id"] == ids[0]
    assert [each["source_man"] for each in plan["transitions"]] == ids
    assert {each["dest_man"] for each in plan["transitions"]} <= {*ids, "_done_"}


@RELAXED
@given(data=st.data())
def test_every_step_leads_to_one_that_is_there_or_to_the_end(data, given):
    files = rendered(MOOS, data.draw(inputs(given)))
    variables, behaviours = read(files["naiad.bhv"].decode())
    turns = {
        condition.partition(" = ")[2]
        for _, each in behaviours
        for condition in each["condition"]
        if condition.startswith("MMRS_STEP = ")
    }
    flags = [flag.split(" = ", 1) for _, each in behaviours for flag in each.get("endflag", [])]
    led = {value for name, value in flags if name == "MMRS_STEP"}
    assert variables["MMRS_STEP"] in turns
    assert led <= turns
    assert turns - led <= {variables["MMRS_STEP"]}
