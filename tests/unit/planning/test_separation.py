import numpy as np
import pytest
from plain_scenes import photo, road, robot, scene, visit

from mmrs_core.planning.planner import plan
from mmrs_core.planning.separation import first_encounter, stacked_altitudes
from mmrs_core.planning.timeline import track_of


def test_a_track_stands_still_for_actions_and_holds():
    work = road((0.0, 100.0, 20.0), (100.0, 100.0, 20.0), actions=(photo(50.0),), hold=30.0)
    whole = scene([robot()], {"a": work})
    found = plan(whole)
    track = track_of(found.robots[0].steps, whole.robots[0])
    still = (track.places[:, 0] == track.places[:, 1]).all(axis=1)
    durations = (track.times[:, 1] - track.times[:, 0])[still]
    assert sorted(durations.round(6).tolist()) == [1.0, 30.0]


def test_a_track_is_without_gaps_from_climb_to_touch_down():
    whole = scene([robot()], {"a": visit((100.0, 0.0, 20.0)), "b": visit((0.0, 100.0, 40.0))})
    found = plan(whole)
    track = track_of(found.robots[0].steps, whole.robots[0])
    assert np.allclose(track.times[1:, 0], track.times[:-1, 1])
    assert np.allclose(track.places[1:, 0], track.places[:-1, 1])
    assert track.times[-1, 1] == pytest.approx(found.makespan - 5.0)


def test_robots_at_home_meet_nobody():
    team = (robot("r1"), robot("r2", (1.0, 0.0, 0.0)))
    whole = scene(team, {"a": visit((100.0, 0.0, 20.0))})
    assert first_encounter(whole, plan(whole), 5.0) is None


def test_an_encounter_is_told_with_time_and_distance():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    works = {
        "a": {"r1": visit((25.0, -100.0, 20.0), (25.0, 100.0, 20.0))},
        "b": {"r2": visit((20.0, 100.0, 20.0), (20.0, -100.0, 20.0))},
    }
    whole = scene(team, works)
    found = first_encounter(whole, plan(whole), 10.0)
    assert (found.first, found.second) == ("r1", "r2")
    assert found.distance < 10.0


def test_altitudes_are_stacked_below_the_ceiling():
    team = tuple(robot(f"r{k}") for k in range(3))
    whole = scene(team, {"a": visit((9.0, 9.0, 100.0))}, minimum_separation=15.0)
    heights = stacked_altitudes(whole)
    assert sorted(set(heights.values())) == pytest.approx([100.0, 115.1])


def test_nothing_is_stacked_where_robots_need_not_keep_apart():
    assert stacked_altitudes(scene((robot("r1"), robot("r2")), {"a": visit((9.0, 9.0, 9.0))})) == {}
