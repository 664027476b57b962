"""Energy, links, waits, photos and events of robots."""

from dataclasses import replace

import numpy as np
import pytest

from mmrs_core.pictures.flights.fixes import datum_of
from mmrs_core.pictures.flights.photos import shots_of
from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.pictures.report.assembly import link_of
from mmrs_core.pictures.report.energies import energy_of, used
from mmrs_core.pictures.report.events import MOST_TEXTS, events_of, readings_of, without_secrets
from mmrs_core.pictures.report.visits import move_reports, wait_reports
from mmrs_core.scene import Frame

PLACES = Locator(Frame("EPSG:4326", None, None))


def test_the_lowest_level_and_its_time_are_told(make):
    track = make.track([(i, 0, 0, 0) for i in range(4)], [1.0, 0.4, 0.3, 0.35])
    found = energy_of(make.flown("alpha", (), track), None, 0.2)
    assert (found.lowest, found.lowest_at, found.end) == (0.3, 2.0, 0.35)
    assert (found.planned, found.reserve) == (None, 0.2)


SLOWLY = np.concatenate([np.linspace(*each) for each in ((1.0, 0.22, 40), (0.22, 1.0, 200), (1.0, 0.6, 20))])


@pytest.mark.parametrize(
    ("levels", "expected", "within"),
    [
        ([0.9, 0.89, 0.9, 0.88, 0.89, 0.87], 0.03, 1e-6),
        ([1.0, 0.3, 0.99, 0.5], 0.7 + 0.49, 1e-6),
        (SLOWLY, 0.78 + 0.4, 1e-6),
        (SLOWLY + np.tile([0.0, 0.01, -0.01, 0.005], 65), 0.78 + 0.4, 0.05),
    ],
    ids=["wavering readings", "a replaced battery", "charged slowly", "charged slowly, wavering"],
)
def test_only_charges_begin_a_new_battery(levels, expected, within):
    assert used(np.array(levels)) == pytest.approx(expected, abs=within)


def test_a_battery_that_nobody_tells_is_not_known(make):
    found = energy_of(make.flown("alpha", (), make.track([(0, 0, 0, 0)])), None, 0.2)
    assert (found.used, found.lowest, found.end) == (None, None, None)


def test_the_plan_says_what_was_to_be_used(make, run):
    found = energy_of(make.flown("alpha"), run, 0.2)
    assert found.capacity == pytest.approx(200_000.0)
    assert 0.0 < found.planned < 0.5
    assert found.planned_lowest == pytest.approx(1.0 - found.planned)


def test_gaps_and_dropped_frames_of_a_link_are_told(make):
    track = make.track([(0, 0, 0, 0), (1, 0, 0, 0), (9, 0, 0, 0), (30, 0, 0, 0)], broken=[1, 2])
    start = make.entry(0.0, "start", link="udpin:10.0.0.7:14550", vehicle="copter", firmware="PX4")
    found = link_of(make.flown("alpha", (), track, (start,), counted={"unreadable": 4}))
    assert (found.gaps, found.silent, found.longest) == (2, 29.0, 21.0)
    assert (found.vehicle, found.by, found.dropped) == ("copter, PX4", "udp", {"unreadable": 4})


@pytest.mark.parametrize(
    ("link", "kind"), [("/dev/ttyUSB0,57600", "serial"), ("COM4,57600", "serial"), ("can", "can")]
)
def test_a_link_is_named_by_its_kind_without_its_path(make, link, kind):
    found = link_of(make.flown("alpha", (), make.track([]), (make.entry(0.0, "start", link=link),)))
    assert found.by == kind


def test_commands_that_were_repeated_or_refused_are_counted(make):
    commands = (
        make.entry(1.0, "command", result="ACCEPTED", tries=1, seconds=0.05),
        make.entry(2.0, "command", result="DENIED", tries=3, seconds=3.2),
    )
    found = link_of(make.flown("alpha", (), make.track([]), commands))
    assert (found.commands, found.repeated, found.refused, found.slowest) == (2, 1, 1, 3.2)


def test_a_robot_without_a_black_box_has_no_link(make):
    assert link_of(make.flown("alpha", make.records("alpha", (0.0, "begin", "a")))) is None


def test_a_wait_tells_for_whom(behaviour, as_run, run):
    (wait,) = wait_reports(behaviour, as_run(), run)
    assert (wait.robot, wait.move, wait.slots, wait.setters) == ("beta", "b1", ("go",), ("alpha",))
    assert wait.seconds == pytest.approx(wait.planned)
    assert wait.until == pytest.approx(wait.since + wait.seconds)


def test_a_wait_that_nobody_ended_lasts_as_long_as_anything_is_known(behaviour, as_run, run):
    beta = as_run().robots["beta"].records
    stuck = beta[: next(i for i, r in enumerate(beta) if r.label == "take" and r.move == "b1")]
    (wait,) = wait_reports(behaviour, as_run(alpha={"records": ()}, beta={"records": stuck}), run)
    assert (wait.until, wait.setters) == (None, ("unknown",))
    assert wait.since + wait.seconds == pytest.approx(as_run().robots["beta"].track.times[-1])


def test_every_move_is_told_with_its_time_in_the_plan(behaviour, as_run, run):
    moves = [move for move in move_reports(behaviour, as_run(), run) if move.robot == "alpha"]
    assert [move.move for move in moves] == ["up", "a1", "a2", "a3", "a4", "back", "down"]
    assert all(move.flown == pytest.approx(move.planned) for move in moves)


@pytest.fixture
def shots(behaviour, as_run, place):
    def found(*entries, **more):
        flown = replace(as_run().robots["alpha"], entries=entries, **more)
        kind = place.types["Quad"]
        datum = datum_of(behaviour.robots[0], behaviour, kind)
        return shots_of(behaviour.robots[0], flown, datum, kind)

    return found


@pytest.fixture
def ordered_at(as_run):
    return next(record.time for record in as_run().robots["alpha"].records if record.label == "act")


def test_a_photo_that_was_confirmed_is_where_the_camera_says(shots, make, ordered_at):
    place = {"north": 1.0, "east": 29.0, "height": 20.0}
    (shot,) = shots(make.entry(ordered_at + 0.4, "photo", index=7, place=place))
    assert (shot.state, shot.index, shot.at, shot.task) == ("taken", 7, (29.0, 1.0, 20.0), "photos")


def test_a_photo_whose_device_says_when_it_is_done_is_taken(shots, make, ordered_at):
    (shot,) = shots(make.entry(0.0, "start", link="can", confirms=True))
    assert (shot.state, shot.time) == ("taken", ordered_at)


def test_a_photo_that_nobody_confirmed_is_where_the_robot_was(shots, ordered_at):
    (shot,) = shots()
    assert (shot.state, shot.time) == ("not confirmed", ordered_at)
    assert shot.at == pytest.approx((30.0, 0.0, 20.0), abs=0.1)


def test_a_confirmation_of_another_time_is_another_photo(shots, make, ordered_at):
    early = make.entry(ordered_at - 60.0, "photo", index=0, place=None)
    assert [shot.state for shot in shots(early)] == ["taken", "not confirmed"]


def test_a_camera_that_knows_no_place_does_not_put_photos_into_the_sea(shots, make, ordered_at):
    place = {"latitude": 0.0, "longitude": 0.0, "height": 0.0}
    (shot,) = shots(make.entry(ordered_at, "photo", index=1, place=place))
    assert shot.at == pytest.approx((30.0, 0.0, 20.0), abs=0.1)


def test_a_simulation_takes_no_photos(shots):
    assert [shot.state for shot in shots(simulated=True)] == ["simulated"]


def test_faults_decisions_orders_and_warnings_are_told_by_time(make):
    entries = (
        make.entry(1.0, "text", severity="WARNING", text="wind is strong"),
        make.entry(1.5, "text", severity="INFO", text="EKF3 active"),
        make.entry(2.0, "decision", what="LINK_LOST", why="nothing heard for 10 s", response="RETURN"),
        make.entry(4.0, "order", order="hold", confirmed=True, seconds=0.25),
        make.entry(5.0, "order", order="land", confirmed=False),
        make.entry(6.0, "order", order="answer", question="again?", says="no", confirmed=True),
    )
    records = make.records("alpha", (3.0, "fault", "a2", "LINK_LOST"))
    told = [(e.kind, e.what, e.why) for e in events_of(make.flown("alpha", records, entries=entries))]
    assert told == [
        ("text", "wind is strong", "warning"),
        ("decision", "LINK_LOST", "nothing heard for 10 s; response: RETURN"),
        ("fault", "LINK_LOST", "program ended at move a2"),
        ("order", "hold", "confirmed after 0.25 s"),
        ("order", "land", "not confirmed"),
        ("order", "answer 'again?': no", "confirmed"),
    ]


def test_a_response_that_failed_is_a_fault(make):
    failed = make.entry(4.0, "decision", what="MOTORS_OFF", why="RETURN failed", response="NOTHING")
    records = make.records("alpha", (1.0, "begin", "a2", ""))
    (event,) = events_of(make.flown("alpha", records, entries=(failed,)))
    assert (event.kind, event.what, event.why) == ("fault", "MOTORS_OFF", "RETURN failed")


@pytest.mark.parametrize("logged", ["MOTORS_OFF", "TAKEN_OVER"])
def test_a_fault_counts_once_and_a_pilot_is_none(make, logged):
    records = make.records("alpha", (3.0, "fault", "a2", logged))
    entries = (make.entry(3.0, "decision", what=logged, why="seen", response="NOTHING"),)
    kinds = [event.kind for event in events_of(make.flown("alpha", records, entries=entries))]
    assert kinds.count("fault") == (logged == "MOTORS_OFF")


def test_a_fault_that_was_made_on_purpose_says_so(make):
    entry = make.entry(1.0, "injected", fault="gps-lost", state="begins")
    (event,) = events_of(make.flown("alpha", entries=(entry,)))
    assert (event.kind, event.what, event.why) == ("injected", "gps-lost", "injected: begins")


@pytest.mark.parametrize("end", ["ORDERED", "STOPPED", "TAKEN_OVER"])
def test_an_end_that_people_wanted_is_no_fault(make, end):
    (event,) = events_of(make.flown("alpha", make.records("alpha", (3.0, "fault", "a2", end))))
    assert (event.kind, event.what) == ("order", end)


def test_a_flood_of_warnings_is_told_in_short(make):
    texts = tuple(make.entry(float(i), "text", severity="ERROR", text="again") for i in range(500))
    events = events_of(make.flown("alpha", entries=texts))
    assert len(events) == MOST_TEXTS + 1
    assert events[-1].what == "450 more warnings of the vehicle"


def test_measurements_and_reports_are_told_with_their_places(make, behaviour, place):
    datum = datum_of(behaviour.robots[0], behaviour, place.types["Quad"])
    entries = (
        make.entry(1.0, "measured", name="CO2", content={"device": "gas", "result": 412.5}, place=None),
        make.entry(2.0, "reported", name="state", content={"task": "photos"},
                   place={"north": 2.0, "east": 1.0, "height": 3.0}),
    )  # fmt: skip
    first, second = readings_of(make.flown("alpha", entries=entries), datum, PLACES.of)
    assert (first.name, first.content, first.where) == ("CO2", "device gas, result 412.5", None)
    assert (second.content, second.where.position) == ("task photos", (1.0, 2.0, 3.0))


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("/home/ann/logs/a.jsonl: cannot be written", "a.jsonl: cannot be written"),
        ("~/keys/radio.key is not readable", "radio.key is not readable"),
        (r"C:\Users\Ann\a.jsonl is full", "a.jsonl is full"),
        ("token 0123456789abcdef0123456789abcdef", "token …"),
        ("speed is 5 m/s, 3/4 of 6.7 m/s", "speed is 5 m/s, 3/4 of 6.7 m/s"),
        ("the fence/rally upload failed", "the fence/rally upload failed"),
    ],
)
def test_words_keep_what_is_of_the_flight_and_lose_what_is_of_the_machine(words, expected):
    assert without_secrets(words) == expected
