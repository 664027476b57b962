"""Files may be named in the ways that people write them."""

import pytest
import typer

from mmrs_core.cli.app import program_for
from mmrs_core.cli.parameters import behaviour_file, robot_files
from mmrs_core.cli.running import flags_of, spread
from mmrs_core.cli.settings import Settings, taken_from
from mmrs_core.errors import UnreadableError

FLAGS = frozenset({"--json"})


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        (["m", "--robots", "a", "b"], ["m", "--robots", "a", "--robots", "b"]),
        (["m", "--robots", "a", "--robots", "b"], ["m", "--robots", "a", "--robots", "b"]),
        (["--robots", "a", "m"], ["--robots", "a", "m"]),
        (["--robots", "a", "b", "m"], ["--robots", "a", "--robots", "b", "m"]),
        (["--json", "m", "--robots", "a", "b"], ["--json", "m", "--robots", "a", "--robots", "b"]),
        (["--seed", "3", "--robots", "a", "m"], ["--seed", "3", "--robots", "a", "m"]),
        (["m", "--robots", "a", "b", "--json"], ["m", "--robots", "a", "--robots", "b", "--json"]),
        (["m", "--robots"], ["m", "--robots"]),
        (["m", "--robots=a"], ["m", "--robots=a"]),
    ],
)
def test_several_robot_types_may_follow_one_option(written, meant):
    assert spread(written, FLAGS) == meant


def test_a_folder_stands_for_the_robot_types_in_it(tmp_path):
    for name in ("b.xmi", "a.xmi", "notes.txt"):
        (tmp_path / name).touch()
    assert [path.name for path in robot_files([tmp_path])] == ["a.xmi", "b.xmi"]


def test_a_folder_without_robot_types_is_an_error(tmp_path):
    with pytest.raises(UnreadableError, match="no robot type"):
        robot_files([tmp_path])


def test_a_folder_stands_for_its_behaviour(tmp_path):
    (tmp_path / "behaviour.xmi").touch()
    assert behaviour_file(tmp_path) == tmp_path / "behaviour.xmi"


def test_global_options_may_stand_anywhere():
    settings, rest = taken_from(["plan", "--debug", "field", "--no-plugins", "--json"])
    assert settings == Settings(only_core=True, debug=True, json=True)
    assert rest == ["plan", "field", "--json"]


def test_what_follows_two_dashes_is_no_option():
    settings, rest = taken_from(["plan", "--", "--debug"])
    assert not settings.debug
    assert rest == ["plan", "--", "--debug"]


@pytest.mark.parametrize(
    ("command", "flag"), [("validate", "--fix"), ("validate", "--json"), ("convert", "--force")]
)
def test_a_flag_takes_no_file_away_from_the_robots(command, flag):
    """What takes no value is asked of the commands themselves."""
    own = frozenset(flags_of(typer.main.get_command(program_for("mmrs", [command], Settings()).app)))
    assert flag in own
    assert "--robots" not in own
