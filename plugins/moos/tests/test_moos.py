from dataclasses import replace
from math import dist

import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from marine_programs import MANY_PROGRAMS, inputs, rendered
from mmrs_moos.target import MOOS
from mmrs_multicopter.testing import robot_program
from moos_reader import Helm, read, run

from mmrs_core.behaviour.program import MoveTarget, Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import feedback, move
from mmrs_core.testing.small_programs import notify

RELAXED = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=6)
HOME = {"home": (0.0, 0.0, -2.0), "type_name": "Diver"}


def written(input, lossy=False):
    files = render(MOOS, input, allow_lossy=lossy)
    return {file.path.removesuffix(".bhv"): file.content.decode() for file in files[:-1]}


def sailed(input, *answers, robot="naiad", lossy=False):
    """Return the helm of a robot at the end of its way."""
    helms = {name: Helm(text) for name, text in written(input, lossy).items()}
    assert run(helms, answers=answers)
    return helms[robot]


def passes(helm, *places):
    """Return whether a helm passes places (east, north, depth), in this order."""
    points = iter(helm.passed)
    return all(any(dist(point, place) <= 0.5 + 1e-6 for point in points) for place in places)


def test_a_journey_passes_its_places_in_order(given, dive):
    helm = sailed(given(dive("a", 30.0, 0.0, 5.0), dive("b", 30.0, 20.0, 5.0), dive("c", 0.0, 20.0, 1.0)))
    assert passes(helm, (30.0, 0.0, 5.0), (30.0, 20.0, 5.0), (0.0, 20.0, 1.0))
    assert not passes(helm, (30.0, 20.0, 5.0), (30.0, 0.0, 5.0))


def test_nothing_moves_before_it_is_deployed(given, dive):
    (text,) = written(given(dive("a", 30.0, 0.0, 5.0))).values()
    helm = Helm(text)
    for _ in range(50):
        helm.step()
    assert set(helm.passed) == {(0.0, 0.0, 0.0)}


def test_a_sloping_way_keeps_near_to_its_straight_line(given, dive):
    helm = sailed(given(dive("a", 60.0, 0.0, 12.0)))
    line = shapely.LineString([(0.0, 0.0), (60.0, 12.0)])
    off = [line.distance(shapely.Point(east, depth)) for east, _, depth in helm.passed]
    assert max(off) <= 1.0


def test_a_dive_on_the_spot_waits_for_its_depth(given, dive):
    helm = sailed(given(dive("a", 0.0, 0.0, 20.0), dive("b", 5.0, 0.0, 20.0)))
    assert passes(helm, (0.0, 0.0, 20.0), (5.0, 0.0, 20.0))


def test_a_hold_of_next_to_nothing_still_ends(given, dive):
    (text,) = written(given(dive("a", 9.0, 0.0, 2.0), move("h", "HoldPosition", duration=1e-4))).values()
    durations = [float(each["duration"][0]) for kind, each in read(text)[1] if kind == "BHV_Timer"]
    assert min(durations) > 0.0


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"speed": 1e-4}, "its speed of 0 m/s is not from 0.01 to 100"),
        ({"target": MoveTarget((9.0, 0.0, -20_000.0))}, "no sea is deeper than 11,000 m"),
    ],
)
def test_speeds_and_depths_that_mean_nothing_are_refused(given, dive, changes, why):
    with pytest.raises(UnsupportedError, match=why):
        render(MOOS, given(dive("a", 9.0, 0.0, 5.0, **changes)))
    assert render(MOOS, given(dive("a", 9.0, 0.0, 5.0, **changes)), allow_lossy=True)


def test_a_hold_lasts_as_long_as_asked_for(given, dive):
    helm = sailed(given(dive("a", 9.0, 0.0, 2.0), move("h", "HoldPosition", duration=30.0)))
    times = {value: time for time, name, value in helm.posted if name == "MMRS_STEP"}
    begun = times["s_h_holds"]
    assert min(time for time in times.values() if time > begun) - begun == pytest.approx(30.0, abs=0.5)


def test_a_robot_stops_short_of_a_target(given, dive):
    helm = sailed(given(dive("a", 100.0, 0.0, 0.0, distance=25.0)))
    assert helm.place == pytest.approx((75.0, 0.0), abs=0.01)


def pair(given, dive):
    tells = replace(dive("a", 40.0, 0.0, 3.0), after=(notify(("two", "go on")),))
    first = robot_program("one", [tells], **HOME)
    second = robot_program(
        "two",
        [dive("b", 0.0, 10.0, 3.0), dive("c", 0.0, 20.0, 3.0)],
        slots=("go on",),
        transitions={1: Transition(1, 2, waits=("go on",))},
        **HOME,
    )
    return given(first, second)


def test_a_robot_waits_until_another_tells_it_to_go_on(given, dive):
    helms = {name: Helm(text) for name, text in written(pair(given, dive)).items()}
    assert run(helms)
    told = next(time for time, name, _ in helms["two"].posted if name.startswith("MMRS_SLOT_"))
    arrived = next(time for time, name, _ in helms["one"].posted if name == "NODE_MESSAGE_LOCAL")
    left = next(time for time, _, value in helms["two"].posted if value == "s_c")
    assert arrived <= told + 0.25 <= left + 0.25
    assert arrived > 20.0


def test_who_is_told_nothing_waits_for_ever(given, dive):
    helm = Helm(written(pair(given, dive))["two"])
    assert not run({"two": helm}, seconds=600.0)
    assert helm.place == pytest.approx((0.0, 10.0), abs=2.0)


@pytest.mark.parametrize(("answer", "place"), [("true", (9.0, 0.0)), ("false", (0.0, 9.0))])
def test_a_choice_goes_by_a_variable_of_the_users(given, dive, answer, place):
    moves = [dive("a", 9.0, 9.0, 2.0), dive("b", 9.0, 0.0, 2.0), dive("c", 0.0, 9.0, 2.0)]
    chooses = {1: Transition(1, 2, condition="clear water?", otherwise=3), 2: Transition(2, 4)}
    input = given(*moves, transitions=chooses)
    text = written(input)["naiad"]
    variable = next(line.split()[2] for line in text.splitlines() if "condition = MMRS_IF_" in line)
    helm = sailed(input, (variable, answer))
    assert helm.place == pytest.approx(place)
    assert any(variable in ask for file in render(MOOS, input) for ask in file.asks)
    assert not run({"naiad": Helm(text)}, seconds=300.0)


def test_actions_post_what_their_devices_say(given, dive, does, swimmer):
    wired = swimmer(4.0, moos__post__Record="SONAR=on; RANGE=50", moos__post__Stop="SONAR=off")
    helm = sailed(given(dive("a", 20.0, 0.0, 2.0, before=(does(),), after=(does("Stop"),)), type=wired))
    posted = [(time, name, value) for time, name, value in helm.posted if name in ("SONAR", "RANGE")]
    assert [(name, value) for _, name, value in posted] == [
        ("SONAR", "on"),
        ("RANGE", "50"),
        ("SONAR", "off"),
    ]
    gone = next(time for time, _, value in helm.posted if "_goes_" in value)
    assert gone - posted[0][0] >= 4.0


def test_feedback_is_posted_for_people(given, dive):
    helm = sailed(given(dive("a", 5.0, 0.0, 2.0, after=(feedback("arrived", ("at", "a")),))))
    assert ("MMRS_FEEDBACK", "arrived,at=a") in [(name, value) for _, name, value in helm.posted]
    with pytest.raises(UnsupportedError, match="feedback 'a } b' is not plain text"):
        render(MOOS, given(dive("a", 5.0, 0.0, 2.0, after=(feedback("a } b"),))))


def test_moves_that_come_round_again_are_refused(given, dive):
    moves = [dive("a", 9.0, 0.0, 5.0), dive("b", 9.0, 9.0, 5.0)]
    with pytest.raises(UnsupportedError, match="'a' comes round again"):
        render(MOOS, given(*moves, transitions={2: Transition(2, 1)}))


def test_a_slope_that_begins_where_arms_of_a_choice_meet_is_refused(given, dive):
    moves = [dive("a", 9.0, 0.0, 5.0), dive("b", 9.0, 90.0, 5.0), dive("c", 50.0, 0.0, 20.0)]
    chooses = {1: Transition(1, 2, condition="calm", otherwise=3), 2: Transition(2, 3)}
    with pytest.raises(UnsupportedError, match="move 'c': slopes, and begins in two places"):
        render(MOOS, given(*moves, transitions=chooses))
    level = [*moves[:2], dive("c", 50.0, 0.0, 5.0)]
    assert render(MOOS, given(*level, transitions=chooses))


@pytest.mark.parametrize("name", ["}", "a // b", "x\nBehavior = BHV_Timer", "12", "true", "Straße", "$(P)"])
def test_names_mean_nothing_to_the_helm(given, dive, name):
    def kinds(named):
        waits = {"slots": (named,), "transitions": {1: Transition(1, 2, waits=(named,))}}
        (text,) = written(given(dive(named, 9.0, 0.0, 2.0), dive("b", 9.0, 9.0, 2.0), **waits)).values()
        return [kind for kind, _ in read(text)[1]]

    assert kinds(name) == kinds("plain")


@pytest.mark.parametrize("said", ["SONAR", "=on", "1A=on", "A=b}", "A=$(X)", "A=// x", ""])
def test_posts_that_are_no_variables_and_values_are_refused(given, dive, does, swimmer, said):
    wired = swimmer(moos__post__Record=said)
    with pytest.raises(UnsupportedError, match="action 'Record'"):
        render(MOOS, given(dive("a", 9.0, 0.0, 2.0, after=(does(),)), type=wired))


@RELAXED
@given(data=st.data())
def test_any_journey_passes_its_places(data, given, dive):
    place = st.tuples(st.floats(-30.0, 30.0), st.floats(-30.0, 30.0), st.floats(0.0, 6.0))
    places = data.draw(st.lists(place, min_size=1, max_size=3))
    helm = sailed(given(*(dive(f"m{i}", *each) for i, each in enumerate(places))))
    assert passes(helm, *places)


def test_a_local_behaviour_is_expressed(given, dive):
    helm = sailed(given(dive("a", 9.0, 0.0, 5.0), frame=Frame("EPSG:4326", None, None, surface=-2.0)))
    assert passes(helm, (9.0, 0.0, 5.0))


def test_what_a_helm_cannot_do_is_told_with_its_move(given, dive):
    lost = dive("a", 9.0, 0.0, 5.0, target=MoveTarget((9.0, 0.0, -5.0), "a buoy", 1.0))
    with pytest.raises(UnsupportedError, match="move 'a': object 'a buoy'"):
        render(MOOS, given(lost))


@MANY_PROGRAMS
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
