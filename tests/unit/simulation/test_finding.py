"""What a robot has detected goes with its notifies, and decides choices and ways of those that get them."""

import json
from dataclasses import replace

import pytest

from mmrs_core.behaviour.program import BEHAVIOUR, Move
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.vehicles import Live, VehicleFactory, VehicleInput
from mmrs_core.errors import UnreadableError, UsageError
from mmrs_core.simulation.run import mixed, options_for, simulate
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, hold, notify, program, robot, robot_type, use
from mmrs_runtime.bus.messages import (
    LONGEST,
    LONGEST_NAME,
    MOST_FINDS,
    CommandId,
    Commit,
    request_in,
    written,
)
from mmrs_runtime.bus.outgoing import fitting
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.engine.decisions import standard_conditions
from mmrs_runtime.slots import LocalSlots, with_own

pytestmark = pytest.mark.real_time("parts of flights")

FLYER, RISE = ("urn:test", "Flyer"), ("urn:test", "Rise")


class Backend:
    """Knows what it has detected."""

    def __init__(self, **places):
        self.places = places

    def state(self, now):
        return type("State", (), {"detected": frozenset(self.places), "places": self.places})


@pytest.fixture
def bus():
    return LocalSlots(program(*(robot(name, [], slots=("s",)) for name in "abc")).executable)


def told(bus, sender, receiver, backend, number=0):
    finds = with_own(bus.finds(sender), backend.state(0.0))
    delivery = bus.prepare(CommandId("run", sender, "0", number), ((receiver, "s"),), True, finds)
    delivery.send(delivery.lamport)


def test_finds_go_on_with_the_notifies_of_those_who_were_told(bus):
    told(bus, "a", "b", Backend(float=(1.0, 2.0, -3.0)))
    told(bus, "b", "c", Backend(whale=(0.0, 0.0, 0.0)))
    assert bus.finds("c") == (("float", (1.0, 2.0, -3.0)), ("whale", (0.0, 0.0, 0.0)))
    assert not bus.finds("a")


def test_what_a_robot_sees_itself_goes_before_what_it_was_told(bus):
    told(bus, "a", "b", Backend(float=(1.0, 2.0, -3.0)))
    told(bus, "b", "c", Backend(float=(5.0, 5.0, -1.0)))
    assert bus.finds("c") == (("float", (5.0, 5.0, -1.0)),)


def test_no_more_goes_with_a_notify_than_a_message_holds():
    finds = fitting([(f"{n:04}" + "☃" * (LONGEST_NAME - 4), (1e6, 1e6, 1e6)) for n in range(MOST_FINDS)])
    sent = Commit(CommandId("run", "a", "1", 1), ("s" * LONGEST_NAME,) * 10, True, 1, finds)
    assert finds[-1][0].startswith("0099")
    assert len(written(sent)) < LONGEST
    assert request_in(written(sent)).finds == finds


def test_what_no_reader_would_take_is_left_out():
    long, nowhere = ("x" * (LONGEST_NAME + 1), None), ("float", (float("nan"), 0.0, 0.0))
    assert fitting([long, nowhere]) == (("float", None),)


def rising(height):
    return Move("rise", (RISE, (BEHAVIOUR, "Move")), {"altitude": height})


def search(height, condition="found:float"):
    """Return two robots: one photographs a place from a height, and notifies one that then chooses."""
    photo = (use("camera", "TakePicture"), notify("b.s"))
    return searched([rising(height), go("there", (10.0, 0.0, height), after=photo)], condition)


def passing(every, height=10.0):
    """Return two robots: one passes the place and takes photos from 20 m before it to 20 m behind it."""
    begin, end = (
        replace(use("camera", "TakePicture"), parameters=(("distance", far),)) for far in (every, "0")
    )
    there = go("there", (-10.0, 0.0, height))
    back = go("back", (30.0, 0.0, height), before=(begin,), after=(end, notify("b.s")))
    return searched([rising(height), there, back], "found:float")


def searched(moves, condition):
    looks = robot("a", moves)
    chooses = robot(
        "b",
        [rising(1.0), hold("yes"), hold("no")],
        waits={"rise": ("s",)},
        choices={"rise": (condition, "yes", "no")},
        jumps={"yes": "stop"},
    )
    return program(looks, chooses)


@pytest.mark.parametrize(("every", "decided"), [("20", "true"), ("40", "false")])
def test_each_photo_in_passing_shows_what_lies_below_it(chosen, every, decided):
    assert chosen(passing(every)) == [decided]


@pytest.fixture
def surroundings(tmp_path):
    path = tmp_path / "around.json"
    path.write_text(json.dumps({"things": [{"name": "float", "north": 4.0, "east": 10.0, "depth": 0.5}]}))
    return path


@pytest.fixture
def chosen(kinds, surroundings):
    """Return how a choice was decided in a simulated run."""

    def run(behaviour, **options):
        type = robot_type(metaclass=FLYER, devices={"camera": {"TakePicture": 1.0}})
        found = simulate(
            TargetInput(behaviour, {ROBOT_TYPE: type}, **kinds),
            SIMULATION,
            conditions=standard_conditions(["found:float", "detected:float"]),
            options=options or {"a:surroundings": str(surroundings)},
        )
        return [each.detail for each in found.records if each.label == "choose"]

    return run


@pytest.mark.parametrize(("height", "seen"), [(9.0, "true"), (7.0, "false")])
def test_what_a_photo_shows_decides_the_choice_of_another_robot(chosen, height, seen):
    assert chosen(search(height)) == [seen]


def test_what_others_have_detected_a_robot_has_not_detected_itself(chosen):
    assert chosen(search(9.0, "detected:float")) == ["false"]


def test_surroundings_that_are_none_are_refused(chosen, tmp_path):
    (tmp_path / "none.json").write_text('{"things": [{"name": "float"}]}')
    with pytest.raises(UnreadableError, match="no surroundings"):
        chosen(search(9.0), surroundings=str(tmp_path / "none.json"))
    with pytest.raises(UnreadableError, match="No such file"):
        chosen(search(9.0), surroundings=str(tmp_path / "nowhere.json"))


def test_options_of_robots_that_there_are_not_are_refused(chosen, surroundings):
    with pytest.raises(UsageError, match="no robot 'z'; there are a, b"):
        chosen(search(9.0), **{"z:surroundings": str(surroundings)})


def test_an_option_of_one_robot_goes_before_that_of_all():
    assert options_for("b", {"seed": "1", "b:seed": "2", "a:noise": "no"}) == {"seed": "2"}


def test_backends_of_one_run_go_by_one_time():
    real = replace(SIMULATION, name="real", simulated=False)
    assert mixed(SIMULATION, {"a": real, "b": real}, ("a", "b")).simulated is False
    with pytest.raises(UsageError, match="'simulation' simulated, 'real' real"):
        mixed(SIMULATION, {"a": real}, ("a", "b"))
    with pytest.raises(UsageError, match="backend of 'z': no such robot; there are a, b"):
        mixed(SIMULATION, {"z": real}, ("a", "b"))


def test_a_backend_hears_only_of_the_links_of_its_own_robots():
    heard = {}

    def factory(name):
        def connect(given):
            heard[given.robot.id] = dict(given.live.links)
            return Backend()

        return VehicleFactory(name, "", connect)

    radio, wire = factory("radio"), factory("wire")
    links = {"a": "udpin:127.0.0.1:14550", "b": "udpin:127.0.0.1:14560", "c": "can0@127.0.0.1:29600"}
    live = Live(RealClock(), lambda: None, print, "run", links=links)
    behaviour = program(*(robot(name, []) for name in "abc"))
    both = mixed(radio, {"c": wire}, "abc")
    for each in behaviour.robots:
        both.connect(VehicleInput(behaviour, {}, {}, {}, robot=each, type=robot_type(), live=live))
    assert {name: sorted(known) for name, known in heard.items()} == {
        "a": ["a", "b"],
        "b": ["a", "b"],
        "c": ["c"],
    }
