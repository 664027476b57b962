"""Everything that may fail: thrust is zero at the bus within the declared time, and the vehicle surfaces."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from sample_vessels import heavy_sheet, pool_sheet
from vessel_rig import Rig

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.control import failsafe
from auv_vessel.hosting import WireFault
from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import EMERGENCIES

pytestmark = pytest.mark.long

CURRENT = Surroundings(current=(0.2, -0.1), bottom=20.0)


FLOATS = replace(pool_sheet(), weight_in_water=-1.7)
SINKS = replace(heavy_sheet(), drop_weight=7.0)


def diving(sheet: Sheet, seed: int = 1) -> Rig:
    """Return a vehicle that is on its way two metres below the surface, with thrust on."""
    rig = Rig(replace(sheet, home=(0.0, 0.0, 2.0)), CURRENT, seed)
    rig.craft.go_to(60.0, 0.0, 2.0, heading=0.0)
    rig.run(3.0)
    assert max(map(abs, rig.commands)) > 1.0
    assert abs(rig.vehicle.truth.depth - 2.0) < 0.25
    return rig


def kill(name: str) -> Callable[[Rig], None]:
    return lambda rig: rig.bus.kill(name)


def cut(rig: Rig) -> None:
    rig.bus.disturb(WireFault(loss=1.0))


def corrupt(rig: Rig) -> None:
    rig.bus.disturb(WireFault(corruption=1.0, seed=4))


def freeze(*names: str) -> Callable[[Rig], None]:
    def at(rig: Rig) -> None:
        rig.vehicle.faults.frozen |= set(names)

    return at


def hush(*names: str) -> Callable[[Rig], None]:
    def at(rig: Rig) -> None:
        rig.vehicle.faults.silent |= set(names)

    return at


def leak(rig: Rig) -> None:
    rig.vehicle.faults.leak = True


def order(rig: Rig) -> None:
    rig.craft.emergency()


OTHERS = ("Pressure", "Attitude", "Rates")
UNTRUSTED = failsafe.STALE + 0.3 + failsafe.MARGIN
"""Seconds until movement, which takes a state for trusted for 0.3 s, asks for no thrust."""

CAUSES = [
    ("movement killed", kill("Movement"), failsafe.COMMANDS_SILENT + failsafe.MARGIN, "COMMANDS_SILENT"),
    ("sensor controller killed", kill("Sensors"), 0.3 + failsafe.MARGIN, "SENSORS_SILENT"),
    ("pressure silent", hush("Pressure"), UNTRUSTED, "SENSORS_SILENT"),
    ("compass silent", hush("Attitude"), UNTRUSTED, "SENSORS_SILENT"),
    (
        "all instruments silent",
        hush("Pressure", "Attitude", "Rates", "GroundSpeed"),
        UNTRUSTED,
        "SENSORS_SILENT",
    ),
    ("pressure frozen", freeze("Pressure"), failsafe.FROZEN + UNTRUSTED, "SENSORS_SILENT"),
    ("compass frozen", freeze("Attitude"), failsafe.FROZEN + UNTRUSTED, "SENSORS_SILENT"),
    ("leak detector silent", hush("Health"), failsafe.HEALTH_SILENT + failsafe.MARGIN, "SENSORS_SILENT"),
    ("leak", leak, failsafe.LEAK_SAID * 0.2 + failsafe.MARGIN, "LEAK"),
    ("ordered", order, 0.2 + failsafe.MARGIN, "ORDERED"),
]


FAST = (
    ("movement killed", "floats"), ("sensor controller killed", "sinks"), ("pressure silent", "floats"),
    ("pressure frozen", "sinks"), ("leak detector silent", "floats"), ("leak", "floats"),
    ("ordered", "sinks"),
)  # fmt: skip
TABLE = [
    pytest.param(sheet, *each[1:], id=f"{each[0]}, {word}", marks=marks)
    for each in CAUSES
    for sheet, word in ((FLOATS, "floats"), (SINKS, "sinks"))
    for marks in [() if (each[0], word) in FAST else pytest.mark.thorough]
]


@pytest.mark.parametrize(("sheet", "cause", "within", "reason"), TABLE)
def test_thrust_is_zero_in_time_and_the_vehicle_surfaces(
    sheet: Sheet, cause: Callable[[Rig], None], within: float, reason: str
) -> None:
    rig = diving(sheet)
    begin = rig.bus.now
    cause(rig)
    rig.until(lambda: rig.afloat, 60.0, 0.5)
    assert rig.pushed["command"] - begin <= within + 1e-6
    assert rig.emergencies[0][1] == reason
    assert rig.vehicle.released
    rig.run(6.0)
    assert rig.afloat


@pytest.mark.parametrize(
    ("cause", "sheet"),
    [
        pytest.param(cut, SINKS, id="cut, sinks"),
        pytest.param(corrupt, FLOATS, id="corrupt, floats"),
        pytest.param(kill("Actuators"), FLOATS, id="actuators killed, floats"),
        pytest.param(cut, FLOATS, id="cut, floats", marks=pytest.mark.thorough),
        pytest.param(corrupt, SINKS, id="corrupt, sinks", marks=pytest.mark.thorough),
        pytest.param(kill("Actuators"), SINKS, id="actuators killed, sinks", marks=pytest.mark.thorough),
    ],
)
def test_drives_stop_by_themselves_when_no_command_reaches_them(
    sheet: Sheet, cause: Callable[[Rig], None]
) -> None:
    rig = diving(sheet)
    begin = rig.bus.now
    cause(rig)
    rig.until(lambda: rig.afloat, 60.0, 0.5)
    assert rig.pushed["status"] - begin <= sheet.watchdog + failsafe.MARGIN + 0.1


def test_a_weight_is_let_go_of_when_the_actuator_controller_is_gone() -> None:
    rig = diving(SINKS)
    begin = rig.bus.now
    rig.bus.kill("Actuators")
    rig.until(lambda: rig.vehicle.released, 5.0, 0.05)
    assert rig.bus.now - begin <= failsafe.ACTUATORS_GONE + 0.5 + failsafe.MARGIN


def test_an_emergency_that_is_lost_once_is_said_again() -> None:
    rig = diving(FLOATS)
    rig.bus.disturb(
        WireFault(loss=1.0, ids=frozenset(EMERGENCIES.values()), begin=rig.bus.now, end=rig.bus.now + 1.5)
    )
    rig.vehicle.faults.leak = True
    rig.run(3.0)
    assert rig.vehicle.drives[0].stopped


def test_thrust_goes_on_after_a_short_silence_and_nothing_is_given_up() -> None:
    rig = diving(FLOATS)
    rig.bus.kill("Movement")
    rig.run(1.0)
    assert max(map(abs, rig.commands)) == 0.0
    rig.bus.revive("Movement")
    rig.run(1.0)
    assert max(map(abs, rig.commands)) > 1.0
    assert rig.emergencies == []


def test_a_decision_centre_that_died_leaves_a_vehicle_that_holds_and_then_surfaces() -> None:
    rig = diving(FLOATS)
    rig.bus.kill("Decision")
    rig.run(3.0)
    place = rig.vehicle.truth
    rig.run(6.0)
    later = rig.vehicle.truth
    assert abs(later.north - place.north) + abs(later.east - place.east) < 0.5
    assert abs(later.depth - 2.0) < 0.1
    rig.until(lambda: rig.afloat, 30.0)
    assert rig.emergencies == []


@pytest.mark.thorough
def test_a_decision_centre_that_is_heard_again_has_its_goal_pursued() -> None:
    rig = diving(FLOATS)
    rig.bus.kill("Decision")
    rig.run(13.5)
    assert rig.vehicle.truth.depth < 1.9
    rig.bus.revive("Decision")
    rig.until(lambda: rig.vehicle.truth.depth > 1.9, 30.0)
    assert rig.state.progress == "ACTIVE"


@pytest.mark.parametrize(
    "sheet", [pytest.param(FLOATS, id="floats", marks=pytest.mark.thorough), pytest.param(SINKS, id="sinks")]
)
def test_a_vehicle_that_came_up_without_its_decision_centre_stays_idle_for_who_swims_to_it(
    sheet: Sheet,
) -> None:
    rig = diving(sheet)
    rig.bus.kill("Decision")
    rig.until(lambda: bool(rig.emergencies), 60.0)
    rig.run(failsafe.MARGIN)
    up = rig.bus.now
    assert rig.vehicle.truth.depth < 0.7
    rig.run(20.0)
    assert rig.pushed["command"] < up
    assert rig.pushed["status"] < up + 0.2
    assert rig.afloat
    assert rig.vehicle.released is (sheet is SINKS)
    rig.bus.revive("Decision")
    rig.run(5.0)
    assert rig.pushed["command"] < up
    assert rig.state.emergency == "COMMANDS_SILENT"


def test_too_deep_a_dive_is_given_up() -> None:
    sheet = pool_sheet()
    rig = Rig(sheet, Surroundings(bottom=200.0))
    rig.run(2.0)
    rig.craft.go_to(0.0, 0.0, 5.0)
    rig.run(10.0)
    rig.actuators._too_deep = failsafe.deepest(2.0) * sheet.water_density * 9.80665
    begin = rig.bus.now
    rig.run(2.0)
    assert rig.emergencies[0][1] == "TOO_DEEP"
    assert rig.pushed["command"] - begin <= failsafe.DEEP_FOR + failsafe.MARGIN + 0.1


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.thorough)])
def test_a_dead_thruster_is_made_up_for_where_others_can(seed: int) -> None:
    rig = diving(SINKS, seed)
    rig.vehicle.faults.dead |= {(3 * seed + 1) % 8}
    rig.craft.go_to(rig.state.north + 3.0, 1.0, 3.0, heading=40.0)
    rig.reach()
    truth = rig.vehicle.truth
    assert abs(truth.depth - 3.0) < 0.15
    assert rig.emergencies == []


def test_one_upright_thruster_of_two_takes_it_down_without_turning_it_over() -> None:
    rig = diving(pool_sheet())
    rig.vehicle.faults.dead |= {4}
    rig.craft.go_to(rig.state.north + 2.0, 0.0, 3.0, heading=0.0)
    most = 0.0
    while rig.state.progress != "REACHED":
        rig.run(0.1)
        most = max(most, abs(rig.vehicle.truth.roll))
        assert rig.bus.now < 60.0, rig.where()
    assert 5.0 < most < 30.0
    assert rig.emergencies == []


@pytest.mark.parametrize(
    "name", ["GroundSpeed", *(pytest.param(each, marks=pytest.mark.thorough) for each in OTHERS)]
)
def test_an_instrument_with_much_noise_does_not_end_the_dive(name: str) -> None:
    rig = diving(pool_sheet())
    rig.vehicle.faults.noisy[name] = 20.0
    rig.craft.go_to(rig.state.north + 2.0, 0.0, 2.5, heading=20.0)
    rig.reach(60.0)
    assert rig.emergencies == []
    assert abs(rig.vehicle.truth.depth - 2.5) < 0.2


def test_a_thruster_that_gives_nothing_though_its_drive_says_it_runs_counts_as_dead() -> None:
    rig = diving(SINKS)
    rig.vehicle.drives[4]._most = 0.0
    rig.craft.surface()
    rig.run(2.0)
    assert rig.actuators.thrusts[4] == 0.0
    assert sum(rig.actuators._watch.working) == 7


def test_a_frozen_log_costs_certainty_and_not_the_dive() -> None:
    rig = diving(FLOATS)
    before = rig.state.uncertainty
    rig.vehicle.faults.frozen |= {"GroundSpeed"}
    rig.run(15.0)
    assert rig.emergencies == []
    assert rig.state.uncertainty > before + 0.2


def test_frozen_gyroscopes_leave_a_vehicle_that_keeps_its_heading() -> None:
    rig = diving(FLOATS)
    rig.vehicle.faults.frozen |= {"Rates"}
    rig.run(5.0)
    rig.craft.turn(120.0)
    rig.reach(60.0)
    assert abs(rig.vehicle.truth.heading - 120.0) < 8.0
    assert rig.emergencies == []


def test_a_bus_that_loses_and_corrupts_some_frames_does_not_end_the_dive() -> None:
    rig = diving(FLOATS)
    rig.bus.disturb(WireFault(loss=0.1, corruption=0.1, seed=7))
    rig.craft.go_to(rig.state.north + 3.0, 0.0, 2.5, heading=90.0)
    rig.reach()
    assert rig.emergencies == []
    assert abs(rig.vehicle.truth.depth - 2.5) < 0.15


def test_nothing_is_pushed_before_a_state_was_trusted() -> None:
    rig = Rig(pool_sheet())
    rig.vehicle.faults.silent |= {"Attitude"}
    rig.craft.go_to(5.0, 0.0, 2.0)
    rig.run(10.0)
    assert rig.pushed["command"] < 0.0
    assert rig.emergencies == []


def test_wrenches_said_again_by_whoever_kept_them_do_not_go_on_for_ever() -> None:
    rig = diving(FLOATS)
    movement, kept = rig.movement, []
    for _ in range(4):
        kept += movement.tick(rig.bus.now)[:2]
    rig.bus.kill("Movement")
    begin = rig.bus.now
    while rig.bus.now - begin < failsafe.MOVEMENT_GONE + 2.0:
        for frame in kept[:2]:
            rig.bus.post(frame)
        kept = kept[2:] + kept[:2]
        rig.run(0.05)
    assert rig.emergencies[0][1] == "COMMANDS_SILENT"
    assert rig.pushed["command"] - begin <= failsafe.MOVEMENT_GONE + failsafe.MARGIN


def test_declared_times_are_those_of_the_manual() -> None:
    """The times that documentation tells are those that are tested here."""
    manual = Path(__file__).parents[2] / "README.md"
    told = {float(each) for each in re.findall(r"\| ([0-9.]+) s \|", manual.read_text(encoding="utf-8"))}
    assert {
        failsafe.COMMANDS_SILENT,
        failsafe.COMMANDS_GONE,
        failsafe.STATE_SILENT,
        failsafe.STATE_UNTRUSTED,
        failsafe.STALE,
        failsafe.HEALTH_SILENT,
        failsafe.STALE + failsafe.FROZEN,
    } <= told


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["Pressure", "Attitude"])
def test_an_instrument_that_never_moved_is_found_out_by_the_others(name: str) -> None:
    rig = Rig(replace(FLOATS, home=(0.0, 0.0, 2.0)), CURRENT)
    rig.vehicle.faults.frozen |= {name}
    rig.run(1.0)
    rig.craft.go_to(0.0, 0.0, 4.0, heading=120.0)
    rig.until(lambda: rig.state.emergency is not None, 12.0)
    assert rig.emergencies[0][1] == "SENSORS_SILENT"
    rig.until(lambda: rig.afloat, 60.0, 0.5)


@pytest.mark.parametrize("sheet", [FLOATS, SINKS], ids=["floats", "sinks"])
def test_a_vehicle_without_any_thruster_that_lifts_it_gives_up_and_comes_up(sheet: Sheet) -> None:
    rig = diving(sheet)
    upright = {number for number, each in enumerate(sheet.thrusters) if abs(each.direction[2]) > 0.5}
    rig.vehicle.faults.dead |= upright
    rig.run(failsafe.UNSERVED + 0.2 + failsafe.MARGIN)
    assert rig.state.emergency == "THRUSTER_FAULT"
    assert rig.commands == [0.0] * len(sheet.thrusters)
    rig.until(lambda: rig.afloat, 60.0)


def test_a_vehicle_with_one_thruster_left_that_lifts_it_goes_on() -> None:
    rig = diving(FLOATS)
    rig.vehicle.faults.dead.add(4)
    rig.run(5.0)
    assert rig.state.emergency is None
