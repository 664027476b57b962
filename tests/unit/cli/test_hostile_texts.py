"""Numbers longer than Python reads, and nesting deeper than it goes, are refused in plain words."""

import pytest

from mmrs_core.behaviour.box_files import black_boxes
from mmrs_core.behaviour.log import read_log
from mmrs_core.cli import run
from mmrs_core.errors import InvalidModelError, UnreadableError, UsageError
from mmrs_core.generation.manifest import read_manifest
from mmrs_core.simulation.surroundings import sights_in
from mmrs_mavlink.links.ports import address_of, split_system
from mmrs_mavlink.plugin.backend.options import link_options
from mmrs_runtime.injection.spec import injections

LONG, DEEP = "9" * 5000, "[" * 200_000


@pytest.mark.parametrize(
    ("read", "text"),
    [
        (split_system, f"udpin:127.0.0.1:14550@{LONG}"),
        (address_of, f"udpin:127.0.0.1:{LONG}"),
        (address_of, f"/dev/ttyUSB0,{LONG}"),
        (lambda text: injections([text], {}), f"seed={LONG}"),
        (lambda text: link_options({"tries": text}), LONG),
    ],
)
def test_a_number_that_is_too_long_is_none(read, text):
    with pytest.raises((ValueError, UsageError), match="9999") as refused:
        read(text)
    assert "limit" not in str(refused.value)


def test_a_log_with_a_number_that_is_too_long_is_refused_with_its_line(tmp_path):
    (tmp_path / "a.jsonl").write_text(f'{{"seq":{LONG}}}\n')
    with pytest.raises(InvalidModelError) as refused:
        read_log(tmp_path / "a.jsonl")
    assert refused.value.diagnostics[0].message == "a whole number of 5000 digits: longer than any of a step"


def test_a_line_with_too_long_a_number_is_no_place_to_explain(capsys):
    assert run(["explain", f"robot.py:{LONG}"]) == 2
    assert "expected FILE:LINE" in capsys.readouterr().err


def test_a_part_of_a_black_box_with_a_huge_number_takes_no_memory(tmp_path):
    (tmp_path / f"Ann.blackbox.1{'0' * 100}.ndjson").write_text("")
    (box,) = black_boxes([tmp_path])
    assert box.missing[0].startswith("Ann.blackbox: parts 1 to 99999")


def test_files_that_nest_too_deeply_are_refused(tmp_path):
    file = tmp_path / "deep.json"
    file.write_text(DEEP)
    with pytest.raises(UnreadableError, match="is not a manifest"):
        read_manifest(file)
    with pytest.raises(UnreadableError, match="no surroundings"):
        sights_in(file)
