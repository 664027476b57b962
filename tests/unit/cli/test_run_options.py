"""The command line of ``mmrs run``: what makes no sense is wrong usage."""

from pathlib import Path

import pytest
import typer

from mmrs_core.cli.run_options import RunOptions, check_backends, default_backend, links_of, options_of_robots
from mmrs_core.cli.simulation import backends_of
from mmrs_core.errors import UsageError
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_mavlink.plugin.backend import MAVLINK

BACKENDS = {"mavlink": MAVLINK, "simulation": SIMULATION}
LOGS = Path("logs")
BOTH = ("alpha", "beta")
LINK = "udpin:127.0.0.1:14550"


def check(wanted, links, robots):
    check_backends(wanted, links, robots, BACKENDS)


@pytest.mark.parametrize(
    "options", [{"tries": "x"}, {"nosuch": "1"}, {"fence": "maybe"}, {"home-tolerance": "nan"}]
)
def test_an_option_of_the_backend_that_makes_no_sense_is_wrong_usage(options):
    (name,) = options
    with pytest.raises(typer.BadParameter, match=f"--backend-option '{name}'"):
        check(RunOptions(LOGS, "mavlink", options=options), {}, ("alpha",))


def test_a_key_of_the_wrong_length_is_wrong_usage_and_one_that_is_not_there_cannot_be_read(tmp_path):
    key = tmp_path / "short.key"
    key.write_bytes(b"abc")
    with pytest.raises(typer.BadParameter, match=r"--signing-key .*short\.key: holds 3 bytes instead of 32"):
        check(RunOptions(LOGS, "mavlink", options={"signing-key": str(key)}), {}, ("alpha",))
    with pytest.raises(FileNotFoundError):
        check(RunOptions(LOGS, "mavlink", options={"signing-key": str(tmp_path / "no")}), {}, ("alpha",))


def test_two_robots_with_one_system_at_one_link_are_wrong_usage():
    links = {"alpha": f"{LINK}@3", "beta": f"{LINK}@3"}
    with pytest.raises(typer.BadParameter, match="is given to 'alpha' and to 'beta'"):
        check(RunOptions(LOGS, "mavlink"), links, ("alpha", "beta"))


def test_two_robots_may_share_a_link():
    check(RunOptions(LOGS, "mavlink"), {"alpha": f"{LINK}@3", "beta": f"{LINK}@4"}, ("alpha", "beta"))


def test_one_robot_has_one_link():
    with pytest.raises(typer.BadParameter, match=r"'alpha' already has the connection udpin:"):
        links_of((f"alpha={LINK}", "alpha=udpin:127.0.0.1:14560"), BOTH, BOTH)


def test_names_of_robots_may_hold_what_stands_between_them_and_their_links():
    given = (f"a=b={LINK}", f"a={LINK}@2")
    both = ("a", "a=b")
    assert links_of(given, both, both) == {"a=b": LINK, "a": f"{LINK}@2"}


def test_the_links_of_the_whole_team_serve_whoever_runs_one_of_its_robots():
    team = (f"alpha={LINK}@1", f"beta={LINK}@2")
    assert links_of(team, ("beta",), BOTH) == {"beta": f"{LINK}@2"}
    with pytest.raises(typer.BadParameter, match=r"unknown robot 'gamma'; the robots are alpha, beta"):
        links_of((*team, f"gamma={LINK}"), ("beta",), BOTH)


def test_a_robot_may_have_a_backend_of_its_own():
    assert backends_of(["beta=can", "simulation"], "mavlink") == ("simulation", {"beta": "can"})
    assert backends_of(None, "mavlink") == ("mavlink", {})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["can", "simulation"], "all other robots have can already"),
        (["beta=can", "beta=simulation"], "'beta' has can already"),
    ],
)
def test_two_backends_for_one_robot_are_wrong_usage(given, said):
    with pytest.raises(typer.BadParameter, match=said):
        backends_of(given, "mavlink")


def test_links_and_options_of_other_backends_are_not_mavlinks():
    wanted = RunOptions(
        Path("logs"), "mavlink", own_backends={"beta": "can"}, options={"beta:detections": "29700"}
    )
    check(wanted, {"alpha": LINK, "beta": "can0@127.0.0.1:29600"}, BOTH)
    with pytest.raises(typer.BadParameter, match="--backend-option 'detections'"):
        check(RunOptions(LOGS, "mavlink", options={"alpha:detections": "1"}), {}, BOTH)


def test_the_key_to_sign_with_is_for_robots_on_mavlink():
    given = {"signing-key": "field.key", "patience": "9"}
    wanted = RunOptions(LOGS, "mavlink", own_backends={"beta": "can"}, options=given)
    assert options_of_robots(wanted, BOTH, BACKENDS) == {"patience": "9", "alpha:signing-key": "field.key"}
    assert options_of_robots(RunOptions(LOGS, "mavlink", options=given), BOTH, BACKENDS) == given


def test_a_run_uses_the_one_default_backend():
    assert default_backend(BACKENDS) == "mavlink"
    with pytest.raises(UsageError, match="no installed plug-in has a default; choose one of simulation"):
        default_backend({"simulation": SIMULATION})
    with pytest.raises(UsageError, match="the defaults are mavlink and other; choose one of mavlink, other"):
        default_backend({"other": MAVLINK, "mavlink": MAVLINK})
