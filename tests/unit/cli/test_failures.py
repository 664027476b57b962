"""Every way to end has its exit code and its words."""

import json

import pytest
import typer

from mmrs_core.cli.failures import ended_by
from mmrs_core.cli.settings import Settings
from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import (
    InfeasibleError,
    InternalError,
    InvalidModelError,
    LinkLostError,
    PluginError,
    UnreachableError,
    UnreadableError,
    UnsupportedError,
    UsageError,
)

FAULT = Diagnostic("MML001", Severity.ERROR, "mission has no team", Place("m.xmi", 3), "add one")


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (InvalidModelError("m.xmi: not valid", [FAULT]), 1),
        (UnsupportedError("target 'x': no"), 1),
        (PluginError("plug-in 'x': broken"), 1),
        (InternalError("a promise"), 1),
        (UsageError("target 'x': not known"), 2),
        (typer.BadParameter("no"), 2),
        (UnreadableError("m.xmi: missing"), 3),
        (PermissionError(13, "Permission denied", "out.xmi"), 3),
        (InfeasibleError("too far"), 4),
        (UnreachableError("no way"), 4),
        (LinkLostError("Alba: silent"), 5),
        (ZeroDivisionError("division by zero"), 1),
    ],
)
def test_the_exit_code_tells_the_kind_of_end(error, code):
    assert ended_by(error, Settings()) == code


def test_all_diagnostics_are_shown_with_their_hints(capsys):
    ended_by(InvalidModelError("m.xmi: not valid", [FAULT, FAULT]), Settings())
    err = capsys.readouterr().err
    assert err.count("m.xmi:3: error: mission has no team [MML001]") == 2
    assert "hint: add one" in err


@pytest.mark.parametrize(
    ("message", "reasons", "shown"),
    [
        ("no plan", ["12 kJ short", "too far"], "no plan\n  - 12 kJ short\n  - too far\n"),
        ("no plan: too far (2 reasons)", ["too far", "no wind"], "no plan\n  - too far\n  - no wind\n"),
        ("no plan: too far", ["too far"], "no plan: too far\n"),
        ("no plan", [], "no plan\n"),
    ],
)
def test_every_reason_of_an_infeasible_mission_is_shown_once(message, reasons, shown, capsys):
    ended_by(InfeasibleError(message, reasons), Settings())
    assert capsys.readouterr().err == f"mmrs: {shown}"


def test_a_refused_value_is_named_first(capsys):
    ended_by(typer.BadParameter("--on-stop fly: expected hold"), Settings())
    assert capsys.readouterr().err == "mmrs: --on-stop fly: expected hold\n"


def test_an_unexpected_error_is_one_line_and_how_to_report_it(capsys):
    ended_by(ZeroDivisionError("division by\nzero"), Settings())
    err = capsys.readouterr().err
    assert err.startswith("mmrs: internal error: ZeroDivisionError: division by zero\n")
    assert "Traceback" not in err
    assert "--debug" in err


def test_debug_shows_the_traceback(capsys):
    try:
        raise ZeroDivisionError("x")
    except ZeroDivisionError as error:
        ended_by(error, Settings(debug=True))
    assert "Traceback" in capsys.readouterr().err


def test_json_is_one_object_even_for_an_error(capsys):
    ended_by(InvalidModelError("m.xmi: not valid", [FAULT]), Settings(json=True))
    error = json.loads(capsys.readouterr().out)["error"]
    assert error["exit_code"] == 1
    assert error["diagnostics"][0]["code"] == "MML001"


def test_a_file_that_cannot_be_written_is_named(capsys):
    ended_by(PermissionError(13, "Permission denied", "out.xmi"), Settings())
    assert capsys.readouterr().err == "mmrs: out.xmi: permission denied\n"


def test_messages_and_their_details_stay_on_their_lines(capsys):
    ended_by(InfeasibleError("a\nmmrs: done", ["b\nmmrs: done"]), Settings())
    assert "\nmmrs: done" not in capsys.readouterr().err
