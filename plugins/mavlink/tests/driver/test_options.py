"""The command line of controllers: what makes no sense is refused before anything moves."""

from dataclasses import replace

import pytest
from flight_crew import robot_of

from mmrs_mavlink.driver import MavlinkDriver
from mmrs_runtime.controllers.options import options_of, parser_for

pytestmark = pytest.mark.real_time("parts of flights")


@pytest.fixture
def asked(tmp_path):
    """Return the options that a command line of two robots asks for."""

    def ask(*arguments: str):
        robots = [robot_of(id=id) for id in ("alpha", "beta")]
        driver = MavlinkDriver()
        return options_of(parser_for(robots, driver), robots, driver, ["--log", str(tmp_path), *arguments])

    return ask


@pytest.mark.parametrize(
    "option",
    [
        "--home-tolerance",
        "--acceptance",
        "--speedup",
        "--patience",
        "--answer-seconds",
        "--item-seconds",
        "--sync-patience",
    ],
)
@pytest.mark.parametrize("value", ["nan", "inf", "-1", "0", "near"])
def test_a_length_or_time_that_is_none_is_refused(asked, capsys, option, value):
    with pytest.raises(SystemExit) as exit:
        asked(f"{option}={value}")
    assert exit.value.code == 2
    assert f"argument {option}: {value}: must be a" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("option", "value"), [("--tries", "0"), ("--tries", "1.5"), ("--battery-patience", "nan")]
)
def test_a_number_that_is_none_is_refused(asked, capsys, option, value):
    with pytest.raises(SystemExit) as exit:
        asked(option, value)
    assert exit.value.code == 2
    assert f"argument {option}: {value}: must be a" in capsys.readouterr().err


def test_nobody_needs_to_wait_for_a_battery(asked):
    assert asked("--battery-patience", "0").battery_patience == 0.0


def test_the_links_of_the_whole_fleet_serve_the_controller_of_one_robot(tmp_path, capsys):
    robots, driver = [replace(robot_of(id="beta"), fleet=("alpha", "beta"))], MavlinkDriver()
    team = ("--connect", "alpha=udpin:127.0.0.1:14550@1", "--connect", "beta=udpin:127.0.0.1:14560@2")
    log, parser = ("--log", str(tmp_path)), parser_for(robots, driver)
    assert driver.settle(parser, robots, parser.parse_args([*log, *team])) == {
        "beta": "udpin:127.0.0.1:14560"
    }
    with pytest.raises(SystemExit):
        options_of(parser, robots, driver, [*log, "--connect", "gamma=udpin:127.0.0.1:14550"])
    assert "unknown robot 'gamma'; the robots are beta, alpha" in capsys.readouterr().err


def test_one_robot_has_one_link(asked, capsys):
    first, second = ("alpha=udpin:127.0.0.1:14550", "alpha=udpin:127.0.0.1:14560")
    with pytest.raises(SystemExit):
        asked("--connect", first, "--connect", second)
    assert (
        f"--connect {second}: 'alpha' already has the connection udpin:127.0.0.1:14550"
        in capsys.readouterr().err
    )
