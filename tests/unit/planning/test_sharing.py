"""What is known of shares of a task before they are laid out, and schedules that are given up early."""

import numpy as np
import pytest
from plain_scenes import DRONE, box, field_work, robot, scene, with_kinematics

from mmrs_core.planning.capacities import Capacity
from mmrs_core.planning.jobs import jobs_of
from mmrs_core.planning.obstacles import Obstacles
from mmrs_core.planning.pacing import paced, paced_between
from mmrs_core.planning.runs import PortionRun
from mmrs_core.planning.schedule import Decisions, Schedule, Shortfall, schedule
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import Ready
from mmrs_core.planning.team import Team

FIELD = ((0.0, 50.0), (300.0, 50.0), (300.0, 200.0), (0.0, 200.0))
WALLS = (box("wall", 40.0, 20.0, 260.0, 30.0), box("low", 100.0, 220.0, 180.0, 300.0, high=12.0))


def field(count, *, areas=(), **features):
    """Return the scene of a field that robots may share."""
    robots = [
        with_kinematics(robot(f"r{k}", (15.0 * k, 0.0, 0.0), kinematics=DRONE), **features)
        for k in range(count)
    ]
    work = field_work(scene(robots, {}, areas=areas), FIELD)
    return scene(robots, {"a": work}, areas=areas)


@pytest.mark.parametrize("walls", [(), WALLS])
@pytest.mark.parametrize("features", [{}, {"endurance": 200.0}, {"endurance": 200.0, "recharge": None}])
def test_no_robot_does_more_work_by_a_time_than_its_capacity(walls, features):
    team = Team(field(2, areas=walls, **features))
    for name, pilot in team.pilots.items():
        material = team.forwards("a", name)
        for ready in (Ready(), Ready(time=50.0, signals=("go",)), Ready(earliest=80.0)):
            capacity = Capacity(pilot, material, pilot.start(), ready)
            for begin in range(0, len(material), 7):
                run = PortionRun(pilot, material, pilot.start(), begin, ready, record=False)
                for time in np.linspace(20.0, 1500.0, 38).tolist():
                    last = run.until(time)
                    if last >= begin:
                        assert material.seconds(begin, last) <= capacity.until(time)


def test_a_capacity_is_not_much_more_than_a_robot_can_do_of_work_that_takes_long():
    team = Team(field(1))
    pilot, material = team.pilots["r0"], team.forwards("a", "r0")
    run = PortionRun(pilot, material, pilot.start(), 0, Ready(), record=False)
    whole = run.back(len(material) - 1)
    capacity = Capacity(pilot, material, pilot.start(), Ready()).until(whole)
    assert material.seconds(0, len(material) - 1) <= capacity < 1.1 * material.seconds(0, len(material) - 1)


def test_a_schedule_that_ends_beyond_a_limit_is_given_up_and_found_when_it_is_asked_for_again():
    whole = field(2)
    jobs, decisions = jobs_of(whole), Decisions(("a",))
    makespan = schedule(Team(whole), jobs, decisions).makespan
    team = Team(whole)
    assert schedule(team, jobs, decisions, limit=0.9 * makespan) == Shortfall("a", 1)
    found = schedule(team, jobs, decisions, limit=makespan + 1e-3)
    assert isinstance(found, Schedule)
    assert found.makespan == makespan
    assert schedule(team, jobs, decisions).makespan == makespan


def test_a_schedule_is_given_up_before_work_for_which_no_time_is_left():
    first, second = field(1), field(1)
    works = {"a": first.works["a", "r0"], "b": second.works["a", "r0"]}
    whole = scene(first.robots, works)
    jobs, decisions = jobs_of(whole), Decisions(("a", "b"))
    makespan = schedule(Team(whole), jobs, decisions).makespan
    assert schedule(Team(whole), jobs, decisions, limit=0.7 * makespan) == Shortfall("a", 2)


def test_one_leg_is_blocked_by_what_blocks_it_among_many():
    rng = np.random.default_rng(0)
    corners = rng.uniform(0.0, 300.0, (12, 2))
    areas = [
        box(f"area {k}", *at, *(at + rng.uniform(5.0, 40.0, 2)), high=float(rng.uniform(5.0, 60.0)))
        for k, at in enumerate(corners.tolist())
    ]
    obstacles = Obstacles(areas, 3.0)
    legs = rng.uniform((0.0, 0.0, 0.0), (300.0, 300.0, 70.0), (400, 2, 3))
    legs[::4, 1, :2] = legs[::4, 0, :2]
    together = obstacles.blocking(legs)
    assert 0 < together.any(axis=1).sum() < len(legs)
    assert all((obstacles.blocking(leg[None]) == row).all() for leg, row in zip(legs, together, strict=True))


def test_parts_are_paced_for_all_bounds_as_for_each():
    team = Team(field(1, areas=WALLS))
    pilot, material = team.pilots["r0"], team.forwards("a", "r0")
    parts = [part for portion in material.portions for part in portion]
    apart = [paced(parts, Pilot(pilot.travel), bound) for bound in (-1, 0, 1)]
    assert len(apart[1]) == len(parts) > 10
    assert apart == list(paced_between(parts, Pilot(pilot.travel)))


def test_candidates_for_shares_serve_the_next_schedule():
    whole = field(2)
    team, jobs = Team(whole), jobs_of(whole)
    schedule(team, jobs, Decisions(("a",), {"a": 1}))
    known = dict(team.candidates)
    schedule(team, jobs, Decisions(("a",), {"a": 2}))
    assert [each.pilot.robot.name for each in known.values()] == ["r0", "r1"]
    assert team.candidates == known
