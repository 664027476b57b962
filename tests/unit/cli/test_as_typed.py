"""Values of arguments and options come as typer would give them."""

import os
import subprocess
import sys

import pytest
import typer

from mmrs_core.cli import run
from mmrs_core.cli.app import program_for
from mmrs_core.cli.running import take_as_typed
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.commands import CORE_NAMES


def commands_in(name, *, as_typed):
    """Return a command of the core and what is in it, with the parameters of each."""
    app = typer.main.get_command(program_for("mmrs", [name], Settings(only_core=True)).app)
    command = app.commands[name]
    inner = getattr(command, "commands", {})
    if as_typed:
        take_as_typed(app, [name, *inner])
    return [each.get_params(typer.Context(each)) for each in (command, *inner.values())]


def coerced(parameter, value):
    context = typer.Context(typer.core.TyperCommand("any"))
    try:
        return parameter.get_runtime_param().coerce(value, param=parameter, ctx=context)
    except typer.BadParameter as error:
        return error.format_message()


@pytest.mark.parametrize("name", sorted(CORE_NAMES))
def test_every_parameter_gets_what_typer_gives(name, tmp_path):
    both = (commands_in(name, as_typed=as_typed) for as_typed in (False, True))
    for theirs, ours in zip(*both, strict=True):
        for their, our in zip(theirs, ours, strict=True):
            assert their.name == our.name
            for text in ("field", "3", "", str(tmp_path)):
                value = (text, "x") if their.multiple or their.nargs == -1 else text
                assert coerced(our, value) == coerced(their, value)
            for value in (None, our.default):
                assert coerced(our, value) == coerced(their, value)


def test_a_file_that_may_not_be_read_is_refused(tmp_path, monkeypatch, capsys):
    (tmp_path / "mission.xmi").touch()
    monkeypatch.setattr(os, "access", lambda _, mode: mode == os.F_OK)
    assert run(["validate", str(tmp_path / "mission.xmi")]) == 2
    assert "is not readable" in capsys.readouterr().err


def test_pydantic_is_not_imported_for_paths():
    code = (
        "import sys; from mmrs_core.cli import run; run(['show', '/no']); sys.exit('pydantic' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=60).returncode == 0
